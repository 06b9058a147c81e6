// Each law's whole answer to a step, stress, history and bound of its waves, against the formulae of its
// documentation in matrices, with roots that are found by halving intervals.

#include "kernels/materials/drucker_prager.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/metal.hpp"
#include "kernels/materials/neo_hookean.hpp"
#include "tests/unit/material_sample.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using Draw = std::mt19937_64;

double drawn_between(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

/// Where a function that falls from `low` to `high` vanishes.
template <class F>
double root(const F& f, double low, double high) {
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

template <int Dim>
Mat<3> in_space(const Mat<Dim>& m, double zz) {
  Mat<3> out = Mat<3>::Identity() * zz;
  out.topLeftCorner<Dim, Dim>() = m;
  return out;
}

template <int Dim>
Mat<3> matrix(const double (&c)[kSymmetric<Dim>]) {
  Mat<3> out = Vec<3>(c[0], c[1], c[2]).asDiagonal();
  out(0, 1) = out(1, 0) = c[3];
  if constexpr (Dim == 3) {
    out(1, 2) = out(2, 1) = c[4];
    out(0, 2) = out(2, 0) = c[5];
  }
  return out;
}

Mat<3> deviator_of(const Mat<3>& m) { return m - m.trace() / 3 * Mat<3>::Identity(); }

/// The smaller eigenvalue of a tensor in the plane.
double smaller_root(const Mat<3>& b) {
  return root([&](double x) { return (b(0, 0) - x) * (b(1, 1) - x) - b(0, 1) * b(1, 0); }, 0,
              0.5 * (b(0, 0) + b(1, 1)));
}

/// A bound from below of the stretches squared in the plane, or in space.
template <int Dim>
double smallest(const Mat<3>& b) {
  if constexpr (Dim == 2) return smaller_root(b);
  double by_volume = 0;
  for (int k = 0; k < 4; ++k) by_volume = 4 * b.determinant() / std::pow(b.trace() - by_volume, 2);
  return std::max(by_volume, b.trace() / 3 - 2 * deviator_of(b).norm() / std::sqrt(6.0));
}

template <int Dim>
double largest(const Mat<3>& b) {
  if constexpr (Dim == 2) return b(0, 0) + b(1, 1) - smaller_root(b);
  return b.trace() / 3 + 2 * deviator_of(b).norm() / std::sqrt(6.0);
}

bool near(double a, double b, double scale, double tolerance = 1e-11) {
  return std::abs(a - b) <= tolerance * (scale + std::abs(b));
}

/// A random step of a random state.
template <int Dim>
struct Strained {
  double a[Dim * Dim], f[Dim * Dim], before, now, expansion, dt;
  MaterialState<Dim, double> state;
  Mat<3> increment, deformation, elastic;  ///< I + a, F after it, and the elastic B before it

  /// @param isochoric  the elastic strain has the volume 1
  Strained(Draw& draw, double size, bool isochoric) {
    Mat<Dim> old = Mat<Dim>::Identity() + random_matrix<Dim>(draw, 0.3);
    const Mat<Dim> step = random_matrix<Dim>(draw, size);
    const Mat<Dim> next = (Mat<Dim>::Identity() + step) * old;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        a[Dim * i + j] = step(i, j);
        f[Dim * i + j] = next(i, j);
      }
    increment = in_space<Dim>(Mat<Dim>::Identity() + step, 1);
    deformation = in_space<Dim>(next, 1);
    before = old.determinant();
    now = next.determinant();
    dt = drawn_between(draw, 1e-6, 1e-3);
    expansion = step.trace() / dt;
    const Mat<3> part = in_space<Dim>(Mat<Dim>::Identity() + random_matrix<Dim>(draw, 0.12),
                                      1 + drawn_between(draw, -0.1, 0.1));
    elastic = part * part.transpose();
    if (isochoric) elastic /= std::cbrt(elastic.determinant());
    state = resting_state<Dim, double>(drawn_between(draw, 250, 900));
    state.dissipated = drawn_between(draw, 0, 1e7);
    state.internal_energy = drawn_between(draw, 0, 1e9);
    state.plastic_strain = drawn_between(draw, 0, 0.3);
    state.volume_ratio = now;
    for (int i = 0; i < 3; ++i) state.elastic_strain[i] = elastic(i, i);
    state.elastic_strain[3] = elastic(0, 1);
    if constexpr (Dim == 3) {
      state.elastic_strain[4] = elastic(1, 2);
      state.elastic_strain[5] = elastic(0, 2);
    }
  }
  StrainStep<Dim, double> strain() const { return {a, f, before, now, expansion, dt}; }
};

/// The mean m with det(s d + m I) = 1, of the largest root.
double mean_of(const Mat<3>& d, double s) {
  return root([&](double m) { return 1 - (s * d + m * Mat<3>::Identity()).determinant(); },
              std::sqrt(s * s * d.squaredNorm() / 6), 100);
}

/// Shear that is returned by x: the isochoric strain that is left, and the work by its rate at the end.
struct Returned {
  Mat<3> b;
  double work;
};
Returned returned(const Mat<3>& trial, double shear, double x) {
  const Mat<3> d = deviator_of(trial);
  const double q = std::sqrt(1.5) * shear * d.norm(), s = x > 0 ? 1 - shear * trial.trace() * x / q : 1;
  const Mat<3> left = s * d + mean_of(d, s) * Mat<3>::Identity(), inverse = left.inverse();
  // d det = det tr(b^-1 db) is zero along the return.
  const double rate = -(inverse * d).trace() / inverse.trace();
  return {left, 1.5 * shear * (1 - s) * rate};
}

/// What the volume answers: J (p + q), its stiffness, and the speed of its viscosity.
struct Answer {
  double pressure, stiffness, viscous;
};

template <int Dim>
Answer answer(const ElasticVolume& law, const Strained<Dim>& s, MaterialState<Dim, double>&, double, double,
              double, double) {
  return {law.bulk / 2 * (1 - s.now * s.now), law.bulk / 2 * (1 + s.now * s.now), 0};
}

double cold_pressure(const GruneisenVolume& law, double eta) {
  if (eta <= 0) return law.bulk * eta;
  const double pole = 0.95 / law.slope;
  const auto curve = [&](double e) {
    return law.bulk * e * (1 - law.gamma * e / 2) / std::pow(1 - law.slope * e, 2);
  };
  if (eta <= pole) return curve(eta);
  const double h = 1e-5 * pole;  // its tangent from there on
  return curve(pole) +
         (eta - pole) *
             (8 * (curve(pole + h) - curve(pole - h)) - curve(pole + 2 * h) + curve(pole - 2 * h)) / (12 * h);
}

double cold_slope(const GruneisenVolume& law, double eta) {
  const double e = std::min(eta, 0.95 / law.slope);
  if (e <= 0) return law.bulk;
  const double h = 1e-4 * std::min(e, 1.0);
  const auto p = [&](double x) {
    return law.bulk * x * (1 - law.gamma * x / 2) / std::pow(1 - law.slope * x, 2);
  };
  return (8 * (p(e + h) - p(e - h)) - p(e + 2 * h) + p(e - 2 * h)) / (12 * h);
}

template <int Dim>
Answer answer(const GruneisenVolume& law, const Strained<Dim>& s, MaterialState<Dim, double>& state,
              double density, double capacity, double work, double heat) {
  const double change = s.now - s.before,
               old_pressure = cold_pressure(law, 1 - s.before) + law.gamma * state.internal_energy;
  const double speed2 =
      std::max(0.0, s.before * s.before * (cold_slope(law, 1 - s.before) + law.gamma * old_pressure)) /
      density;
  const double rate = std::max(0.0, -s.expansion);
  const double q = density / s.now * law.cell * rate *
                   (law.linear_viscosity * std::sqrt(speed2) + law.quadratic_viscosity * law.cell * rate);
  // The energy that is what it was, plus the work of the mean of both pressures: linear in itself.
  const double cold = cold_pressure(law, 1 - s.now);
  const auto missing = [&](double energy) {
    const double mean = 0.5 * (old_pressure + cold + law.gamma * energy) + q;
    return state.internal_energy + work - mean * change - energy;
  };
  const double at_zero = missing(0), slope = missing(1e9) - at_zero, energy = -at_zero / slope * 1e9;
  state.internal_energy = energy;
  state.dissipated += -q * change;
  state.temperature = state.temperature * std::exp(-law.gamma * change) + (heat - q * change) / capacity;
  const double p = cold + law.gamma * energy;
  return {s.now * (p + q), std::max(0.0, s.now * s.now * (cold_slope(law, 1 - s.now) + law.gamma * p)),
          law.linear_viscosity * std::sqrt(speed2) + 2 * law.quadratic_viscosity * law.cell * rate};
}

double strength(const LinearHardening& law, double strain, double, double) {
  return law.yield + law.hardening * strain;
}
double strength(const JohnsonCook& law, double strain, double rate, double temperature) {
  const double t = std::clamp((temperature - law.reference) / (law.melt - law.reference), 0.0, 1.0);
  return (law.yield + law.hardening * std::pow(strain, law.exponent)) *
         (1 + law.rate_factor * std::log(std::max(rate / law.reference_rate, 1.0))) *
         (1 - (t > 0 ? std::pow(t, law.softening) : 0));
}

template <int Dim, class Volume, class Yield>
int check_metal(const Metal<Volume, Yield>& law, double size) {
  Draw draw(71 + Dim);
  int flowing = 0;
  for (int k = 0; k < 120; ++k) {
    CAPTURE(k);
    Strained<Dim> s(draw, size, true);
    MaterialState<Dim, double> wanted = s.state, got = s.state;
    const double capacity = law.density * law.heat_capacity;
    Mat<3> b;
    double work = 0;
    if constexpr (Yield::kPlastic) {
      const Mat<3> trial =
          s.increment * s.elastic * s.increment.transpose() / std::pow(s.now / s.before, 2.0 / 3);
      const double q = std::sqrt(1.5) * law.shear * deviator_of(trial).norm(),
                   slope = law.shear * trial.trace();
      const auto over = [&](double x) {
        return q - slope * x - strength(law.yield, s.state.plastic_strain + x, x / s.dt, s.state.temperature);
      };
      const double x = over(0) > 0 ? root(over, 0, q / slope) : 0;
      flowing += x > 0;
      const Returned end = returned(trial, law.shear, x);
      b = end.b;
      work = end.work;
      wanted.plastic_strain += x;
      wanted.dissipated += work;
      for (int i = 0; i < Dim; ++i)
        for (int j = i; j < Dim; ++j) wanted.elastic_strain[symmetric_index<Dim>(i, j)] = b(i, j);
      wanted.elastic_strain[2] = b(2, 2);
      if (Yield::kThermal && !Volume::kHeats) wanted.temperature += law.heat_share * work / capacity;
    } else {
      b = s.deformation * s.deformation.transpose() / std::pow(s.now, 2.0 / 3);
    }
    const Answer volume = answer(law.volume, s, wanted, law.density, capacity, work, law.heat_share * work);
    const Mat<3> tau = law.shear * deviator_of(b) - volume.pressure * Mat<3>::Identity();
    const double stiff = volume.stiffness + law.shear * (b.trace() * 5 / 9 - smallest<Dim>(b) / 3);
    const double speed = volume.viscous + std::sqrt(volume.viscous * volume.viscous + stiff / law.density);
    double stress[kSymmetric<Dim>], c2;
    law.template advance<Dim>(s.strain(), got, stress, c2);
    const double modulus = law.volume.bulk;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) REQUIRE(near(matrix<Dim>(stress)(i, j), tau(i, j), modulus));
    REQUIRE(near(c2, speed * speed, 0, 1e-9));
    REQUIRE(near(got.plastic_strain, wanted.plastic_strain, 1));
    REQUIRE(near(got.dissipated, wanted.dissipated, modulus * 0.01));
    REQUIRE(near(got.internal_energy, wanted.internal_energy, modulus));
    REQUIRE(near(got.temperature, wanted.temperature, 300));
    for (int c = 0; c < kSymmetric<Dim>; ++c)
      REQUIRE(near(got.elastic_strain[c], wanted.elastic_strain[c], 1));
    const double j = s.now, stored = law.template energy<Dim>(s.f, got);
    const double of_volume = Volume::kHeats ? got.internal_energy - got.dissipated
                                            : law.volume.bulk / 2 * ((j * j - 1) / 2 - std::log(j));
    REQUIRE(near(stored, law.shear / 2 * (b.trace() - 3) + of_volume, modulus));
  }
  return flowing;
}

constexpr GruneisenVolume kShock{140e9, 2, 1.49, 0.3, 1.7, 1e-4};
constexpr LinearHardening kHardens{400e6, 1e9};
constexpr JohnsonCook kCooks{90e6, 292e6, 0.31, 0.025, 10, 1.09, 293, 1356};

}  // namespace

TEST_CASE_TEMPLATE(
    "a metal answers a step as its formulae say, in stress, history, heat and bound of its waves", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  for (const double size : {0.002, 0.08}) {
    CAPTURE(size);
    check_metal<Dim>(MieGruneisen{8900, 46e9, kShock, {}, 380}, size);
    CHECK(check_metal<Dim>(ElasticPlastic{7800, 80e9, {160e9}, kHardens, 470, 0.7}, size) > 100);
    CHECK(check_metal<Dim>(MieGruneisenPlastic{7800, 80e9, kShock, kHardens, 470, 0.7}, size) > 100);
    CHECK(check_metal<Dim>(ElasticJohnsonCook{8960, 46e9, {140e9}, kCooks, 383, 0.8}, size) > 100);
    CHECK(check_metal<Dim>(MieGruneisenJohnsonCook{8960, 46e9, kShock, kCooks, 383, 0.8}, size) > 100);
  }
  // Steps within the yield surface as well.
  const LinearHardening strong{30e9, 1e9};
  const int flowing = check_metal<Dim>(ElasticPlastic{7800, 80e9, {160e9}, strong, 470, 0.7}, 0.05);
  CHECK(flowing > 10);
  CHECK(flowing < 110);
}

namespace {

template <int Dim>
void check_soil(DruckerPrager law, Draw& draw, double size, std::array<int, 3>& kinds) {
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    Strained<Dim> s(draw, size, false);
    MaterialState<Dim, double> got = s.state;
    const Mat<3> all = s.increment * s.elastic * s.increment.transpose();
    double volume = std::sqrt(all.determinant());
    const Mat<3> trial = all / std::cbrt(all.determinant());
    const auto of_cone = [&](double angle) {
      const double sine = std::sin(angle);
      return law.cone == DruckerPrager::Cone::compression ? 6 * sine / (3 - sine)
             : law.cone == DruckerPrager::Cone::extension ? 6 * sine / (3 + sine)
                                                          : std::sqrt(3.0) * sine;
    };
    const double m = of_cone(law.friction_angle), eta = of_cone(law.dilation_angle),
                 cohesion = m * law.cohesion / std::tan(law.friction_angle);
    const auto pressure = [&](double j) { return std::max(law.bulk / 2 * (1 - j * j), -law.tension); };
    const double q = std::sqrt(1.5) * law.shear * deviator_of(trial).norm(),
                 slope = law.shear * trial.trace();
    const auto over = [&](double x) {
      return q - slope * x - std::max(0.0, m * pressure(volume * std::exp(-eta * x)) + cohesion);
    };
    const double x = over(0) > 0 ? root(over, 0, q / slope) : 0;
    const Returned end = returned(trial, law.shear, x);
    volume *= std::exp(-eta * x);
    const double p = pressure(volume);
    ++kinds[x == 0 ? 0 : p > -law.tension ? 1 : 2];
    double stress[kSymmetric<Dim>], c2;
    law.template advance<Dim>(s.strain(), got, stress, c2);
    const Mat<3> tau = law.shear * deviator_of(end.b) - p * Mat<3>::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        REQUIRE(near(matrix<Dim>(stress)(i, j), tau(i, j), law.bulk));
        REQUIRE(near(matrix<Dim>(got.elastic_strain)(i, j), end.b(i, j) * std::pow(volume, 2.0 / 3), 1));
      }
    REQUIRE(near(got.plastic_strain, s.state.plastic_strain + x, 1));
    REQUIRE(near(got.dissipated, s.state.dissipated + end.work - eta * p * x, law.bulk));
    const double closed = std::min(volume, std::sqrt(1 + 2 * law.tension / law.bulk));
    REQUIRE(near(
        c2 * law.density,
        law.bulk / 2 * (closed * closed + 1) + law.shear * (end.b.trace() * 5 / 9 - smallest<Dim>(end.b) / 3),
        0, 1e-9));
    const double stored = law.shear / 2 * (end.b.trace() - 3) +
                          law.bulk / 2 * ((closed * closed - 1) / 2 - std::log(closed)) +
                          law.tension * std::log(volume / closed);
    REQUIRE(near(law.template energy<Dim>(s.f, got), stored, law.bulk));
  }
}

}  // namespace

TEST_CASE_TEMPLATE("soil answers a step as its formulae say, within the cone, on it and beyond its tip", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  constexpr double kDegree = 0.017453292519943295;
  Draw draw(81);
  std::array<int, 3> kinds{};
  for (const auto cone :
       {DruckerPrager::Cone::compression, DruckerPrager::Cone::extension, DruckerPrager::Cone::plane_strain})
    for (const double dilation : {0.0, 12.0})
      for (const double cohesion : {0.0, 8e6}) {
        DruckerPrager law{1600, 60e6, 30e6, 32 * kDegree, dilation * kDegree, cohesion, 0, 0, cone};
        law.tension = 0.7 * law.apex();
        CHECK(law.apex() == doctest::Approx(cohesion / std::tan(32 * kDegree)));
        check_soil<Dim>(law, draw, 0.02, kinds);
        check_soil<Dim>(law, draw, 0.15, kinds);
      }
  for (const int n : kinds) CHECK(n > 50);
}

TEST_CASE_TEMPLATE("elastic laws have the stress, the energy and the bound of waves of their formulae", D,
                   TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(82);
  const NeoHookean solid{1000, 2450e6, 940e6};
  const LinearElastic linear{1000, 2500e6, 0.33};
  const LogarithmicNeoHookean rubber{1010, 104.4e6, 26.1e6};
  for (int k = 0; k < 200; ++k) {
    CAPTURE(k);
    const Strained<Dim> s(draw, k % 2 ? 0.2 : 0.001, false);
    const Mat<3> f = s.deformation, b = f * f.transpose(), one = Mat<3>::Identity();
    const double j = f.determinant();
    double tau[kSymmetric<Dim>], c2;
    const auto check = [&](const auto& law, const Mat<3>& wanted, double speed2, double energy,
                           double modulus) {
      law.template stress<Dim>(s.f, tau, c2);
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l) REQUIRE(near(matrix<Dim>(tau)(i, l), wanted(i, l), modulus, 1e-13));
      REQUIRE(near(c2, speed2, 0));
      REQUIRE(near(law.template energy<Dim>(s.f), energy, modulus, 1e-13));
    };
    const double g = solid.shear / std::pow(j, 2.0 / 3);
    check(solid, g * deviator_of(b) + solid.bulk / 2 * (j * j - 1) * one,
          (solid.bulk / 2 * (j * j + 1) + g * (b.trace() * 5 / 9 - smallest<Dim>(b) / 3)) / 1000,
          g / 2 * b.trace() - 1.5 * solid.shear + solid.bulk / 2 * ((j * j - 1) / 2 - std::log(j)),
          solid.bulk);
    const double lambda = 2500e6 * 0.33 / 1.33 / 0.34, mu = 2500e6 / 2.66;
    const Mat<3> e = 0.5 * (f + f.transpose()) - one;
    check(linear, lambda * e.trace() * one + 2 * mu * e, (lambda + 2 * mu) / 1000,
          lambda / 2 * e.trace() * e.trace() + mu * e.squaredNorm(), lambda);
    const double log_j = std::log(j), l = rubber.lambda, m = rubber.shear;
    check(rubber, m * (b - one) + l * log_j * one,
          (m * largest<Dim>(b) + std::max(0.0, m + l * (1 - log_j))) / 1010,
          m / 2 * (b.trace() - 3) - m * log_j + l / 2 * log_j * log_j, l);
  }
}
