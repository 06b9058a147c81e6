#pragma once

/// @file A scene turned in its grid, particles and all: what a method owes to the grid's directions shows
/// when the lattice of the particles turns with the bodies, so that the two scenes differ in nothing else.

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "tests/support.hpp"

namespace mpmfast::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// Turns the unstressed particles of a new step by an angle about a point: positions, velocities, F (F = R is
/// no stress to a neo-Hookean material) and the domains of lcpdi. Domains of ugimp stay along the axes.
inline void turn(Step<2>& step, double angle, const Vec<2>& centre) {
  const Mat<2> rotation = Eigen::Rotation2Dd(angle).toRotationMatrix();
  auto& particles = step.state().particles;
  const auto turn_vector = [&](Quantity q, std::size_t p, const Vec<2>& about) {
    const Vec<2> turned = about + rotation * (particles.vector(q, p) - about);
    for (int d = 0; d < 2; ++d) particles.column(q, d)[p] = turned[d];
  };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    turn_vector(Quantity::position, p, centre);
    turn_vector(Quantity::velocity, p, Vec<2>::Zero());
    for (Quantity q : {Quantity::deformation_gradient, Quantity::domain_edges}) {
      if (!particles.has(q)) continue;
      Mat<2> tensor;
      for (int e = 0; e < 4; ++e) tensor(e / 2, e % 2) = particles.column(q, e)[p];
      tensor = rotation * tensor;
      for (int e = 0; e < 4; ++e) particles.column(q, e)[p] = tensor(e / 2, e % 2);
    }
  }
}

/// Motion of one body as a whole.
struct BodyMotion {
  double mass = 0;                   ///< kg
  Vec<2> centre = Vec<2>::Zero();    ///< of mass, m
  Vec<2> velocity = Vec<2>::Zero();  ///< m/s
  double spin = 0;                   ///< angular momentum about the centre, kg m²/s
};

inline BodyMotion body_motion(const Particles<2>& particles, int body) {
  BodyMotion motion;
  const auto each = [&](auto visit) {
    for (std::size_t p = 0; p < particles.size(); ++p)
      if (particles.body()[p] == body)
        visit(particles.column(Quantity::mass)[p], particles.vector(Quantity::position, p),
              particles.vector(Quantity::velocity, p));
  };
  each([&](double m, const Vec<2>& x, const Vec<2>& v) {
    motion.mass += m;
    motion.centre += m * x;
    motion.velocity += m * v;
  });
  motion.centre /= motion.mass;
  motion.velocity /= motion.mass;
  each([&](double m, const Vec<2>& x, const Vec<2>& v) {
    const Vec<2> r = x - motion.centre, u = v - motion.velocity;
    motion.spin += m * (r[0] * u[1] - r[1] * u[0]);
  });
  return motion;
}

}  // namespace mpmfast::test
