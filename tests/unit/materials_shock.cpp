/// The Mie–Grüneisen equation of state and artificial viscosity.

#include <algorithm>
#include "material_sample.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

constexpr GruneisenVolume kNickelVolume{188e9, 2, 1.44, 0, 0, 0.25e-3};
constexpr MieGruneisen kNickel{8870, 0, kNickelVolume, {}, 444, 0.9, 293};

}  // namespace

// U_s = c0 + S1 u_p and the jump conditions give p = K η/(1 − S1 η)² at U = ½ p η/ρ0.
TEST_CASE("Mie-Grueneisen: the state on the Hugoniot has the pressure of U_s = c0 + S1 u_p") {
  for (const double eta : {0.02, 0.1, 0.2, 0.3}) {
    const double p = 188e9 * eta / std::pow(1 - 1.44 * eta, 2);
    double cold, slope;
    kNickelVolume.cold(eta, cold, slope);
    CHECK(cold + 2 * 0.5 * p * eta == doctest::Approx(p).epsilon(1e-13));
    double above, below, unused;
    kNickelVolume.cold(eta + 1e-5, above, unused);
    kNickelVolume.cold(eta - 1e-5, below, unused);
    CHECK(slope == doctest::Approx((above - below) / 2e-5).epsilon(1e-7));
  }
}

// Along an isentrope dU = −p dJ; the trapezoidal rule leaves an error of the square of the step. In and out
// again must end where it began.
TEST_CASE("Mie-Grueneisen: compression without viscosity is reversible and pressure is -dU/dJ") {
  Sample<3, MieGruneisen> nickel(kNickel);
  const Mat<3> l = -Vec<3>(1, 0, 0).asDiagonal().toDenseMatrix();
  double gap = 0;
  for (int k = 0; k < 400; ++k) {
    const double before = nickel.energy(), j = nickel.volume(), p = -nickel.tau[0] / j;
    nickel.strain(l, 1e-3);
    const double p_new = -nickel.tau[0] / nickel.volume();
    gap = std::max(gap, std::abs(nickel.energy() - before + 0.5 * (p + p_new) * (nickel.volume() - j)));
  }
  CHECK(gap < 1e-12 * nickel.energy());
  CHECK(nickel.volume() < 0.7);
  CHECK(nickel.state.dissipated == 0);
  CHECK(nickel.state.temperature ==
        doctest::Approx(293 * std::exp(2 * (1 - nickel.volume()))).epsilon(1e-10));
  for (int k = 0; k < 400; ++k) nickel.strain(-l, 1e-3);
  CHECK(nickel.volume() == doctest::Approx(1).epsilon(1e-6));
  CHECK(std::abs(nickel.energy()) < 1e-4 * 188e9 * 0.01);
}

TEST_CASE("artificial viscosity acts in compression only: q, its heat and its bound of the step") {
  MieGruneisen law = kNickel;
  law.volume.linear_viscosity = 0.4;
  law.volume.quadratic_viscosity = 4;
  Sample<2, MieGruneisen> closing(law), opening(law), plain(kNickel);
  const double rate = 1e6, dt = 1e-9;
  Mat<2> l = Mat<2>::Zero();
  l(0, 0) = -rate;
  closing.strain(l, dt);
  plain.strain(l, dt);
  opening.strain(-l, dt);
  const double c = std::sqrt(188e9 / 8870), span = 0.25e-3 * rate;
  const double q = 8870 / closing.volume() * span * (0.4 * c + 4 * span);
  // The heat of this step adds γ0 q |ΔJ|, 0.2 % of q.
  CHECK(plain.tau[0] - closing.tau[0] == doctest::Approx(closing.volume() * q).epsilon(0.003));
  CHECK(closing.state.dissipated == doctest::Approx(q * (1 - closing.volume())).epsilon(1e-9));
  CHECK(opening.state.dissipated == 0);
  const double viscous = 0.4 * c + 2 * 4 * span;
  CHECK(std::sqrt(closing.c2) ==
        doctest::Approx(viscous + std::sqrt(viscous * viscous + plain.c2)).epsilon(0.003));
  CHECK(closing.state.temperature - plain.state.temperature ==
        doctest::Approx(closing.state.dissipated / (kNickel.density * kNickel.heat_capacity)).epsilon(1e-6));
}
