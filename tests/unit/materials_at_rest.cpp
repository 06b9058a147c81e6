// Moduli of laws where nothing is deformed, and the waves along a surface that follow from them.

#include <doctest/doctest.h>

#include <cmath>

#include "kernels/materials/at_rest.hpp"
#include "kernels/materials/laws.hpp"

namespace mpmfast {
namespace {

constexpr double kYoung = 7e10, kDensity = 2500;

/// Rayleigh's equation: (2 − x)² = 4 √((1 − x)(1 − x s)), x = (c/c_s)², s = (c_s/c_p)².
double rayleigh(double poisson) {
  const double s = (1 - 2 * poisson) / (2 * (1 - poisson));
  double low = 0.3, high = 1;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    ((2 - x) * (2 - x) < 4 * std::sqrt((1 - x) * (1 - x * s)) ? low : high) = x;
  }
  return std::sqrt(low);
}

TEST_CASE("waves run along a surface as fast as Rayleigh's equation says, in plane strain and plane stress") {
  for (double poisson : {0.0, 0.1, 0.25, 0.33, 0.45}) {
    CAPTURE(poisson);
    const LinearElastic law{kDensity, kYoung, poisson};
    const double shear_wave = std::sqrt(kYoung / (2 * (1 + poisson)) / kDensity);
    // In plane stress the plane has the waves of plane strain with ν/(1 + ν). Viktorov's fit is within 0.5 %.
    CHECK(rayleigh_speed(law, false) == doctest::Approx(shear_wave * rayleigh(poisson)).epsilon(5e-3));
    CHECK(rayleigh_speed(law, true) ==
          doctest::Approx(shear_wave * rayleigh(poisson / (1 + poisson))).epsilon(5e-3));
  }
}

TEST_CASE("the modulus of a plane is Young's in plane stress, and that over 1 - nu^2 in plane strain") {
  const LinearElastic law{kDensity, kYoung, 0.3};
  CHECK(plane_modulus(law, true) == doctest::Approx(kYoung).epsilon(1e-12));
  CHECK(plane_modulus(law, false) == doctest::Approx(kYoung / (1 - 0.09)).epsilon(1e-12));
}

TEST_CASE("what holds no shear has no modulus of a plane and no waves along its surface") {
  MieGruneisen fluid;
  fluid.density = 1000;
  fluid.volume.bulk = 2e9;
  for (bool plane_stress : {false, true}) {
    CHECK(rayleigh_speed(fluid, plane_stress) == 0);
    CHECK(plane_modulus(fluid, plane_stress) == 0);
    CHECK(rayleigh_speed(Rigid{}, plane_stress) == 0);
    CHECK(plane_modulus(Rigid{}, plane_stress) == 0);
  }
}

}  // namespace
}  // namespace mpmfast
