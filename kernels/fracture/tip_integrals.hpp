#pragma once

/// @file Energy release rate J at a crack tip by its domain form over a disk, and its share in each mode by
/// the opening behind the tip.
///
/// The weight q has the direction of the crack; |q| is 1 near the tip and falls smoothly to 0 at the rim.
/// Then
///
///   J = ∫ [(σ_ij u_i,k − (W + T) δ_jk) q_k,j + ρ (a_i u_i,k − v_i v_i,k) q_k] dA − ∫ t_i [u_i],k q_k ds
///
/// with the kinetic energy density T = ρ v²/2, the acceleration a by stresses, the traction t on one crack
/// side and the jump [u] of the displacement from the other side to it (Nakamura, Shih and Freund 1985). On
/// each circle around the tip q has the direction of the crack where the crack crosses the circle. Thus q is
/// tangent to the sides of a crack that bends, and these contribute no other terms.
///
/// J does not depend on a uniform velocity of the frame, but sums over particles do. Velocities are therefore
/// given relative to the mean velocity of the samples.
///
/// Behind a tip both components of the opening δ grow as √r, so K_I : K_II = δ_n : δ_t at any distance. A
/// crack that is pressed closed has no mode I.

#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/dimension.hpp"
#include "kernels/fracture/tip_path.hpp"
#include "kernels/fracture/tip_sample.hpp"

namespace mpmfast {

class TipIntegrals {
 public:
  /// @param radius   of the disk, m
  /// @param modulus  E′ of the plane, Pa; 0: unknown, no stress intensities
  /// @param straight length of the crack behind the tip within which its opening may be measured, m
  /// @param width    distance from the crack within which its sides are measured, at least, m
  TipIntegrals(const TipPath& path, double radius, double modulus, double straight = HUGE_VAL,
               double width = 0)
      : path_(&path),
        radius_(radius),
        modulus_(modulus),
        length_(std::min(fracture_constants::kOpeningLength * radius, straight)),
        width_(std::max(fracture_constants::kOpeningWidth * radius, width)) {}

  void add(const TipSample& one) {
    const double r = one.position.norm();
    if (r >= radius_) return;
    add_side(one);
    const Vec<2> direction = path_->direction(r);
    const auto [weight, slope] = weight_at(r);
    const Vec<2> inertia =
        one.gradient.transpose() * one.acceleration - one.velocity_gradient.transpose() * one.velocity;
    release_rate_ += one.area * one.density * weight * inertia.dot(direction);
    if (!(r > 0)) return;
    const Mat<2> q_gradient =
        (slope * direction + weight * path_->direction_slope(r)) * (one.position / r).transpose();  // q_k,j
    const double kinetic = 0.5 * one.density * one.velocity.squaredNorm();
    release_rate_ += one.area * ((one.gradient.transpose() * one.stress).cwiseProduct(q_gradient).sum() -
                                 (one.energy + kinetic) * q_gradient.trace());
  }

  void add(const TipTraction& one) {
    const double r = one.position.norm();
    if (r < radius_)
      release_rate_ -= weight_at(r).first * one.force.dot(one.gradient_jump * path_->direction(r));
  }

  /// J, J/m²
  double energy_release_rate() const { return release_rate_; }
  /// δ_t and δ_n: displacement of the left side less that of the right, m; zero where a side has no samples
  Vec<2> opening() const {
    if (!(area_[0] > 0) || !(area_[1] > 0)) return Vec<2>::Zero();
    return side_[1] / area_[1] - side_[0] / area_[0];
  }
  /// K_II and K_I, Pa √m, with K_I² + K_II² = E′ J; mode I alone where a side has no samples
  Vec<2> stress_intensities() const {
    const Vec<2> jump = opening();
    const double length = jump.norm();
    if (!(release_rate_ > 0)) return Vec<2>::Zero();
    if (!(area_[0] > 0) || !(area_[1] > 0)) return {0, std::sqrt(modulus_ * release_rate_)};
    if (!(length > 0)) return Vec<2>::Zero();
    return std::sqrt(modulus_ * release_rate_) / length * jump;
  }

 private:
  /// |q| and d|q|/dr: a cubic from 1 at the plateau to 0 at the rim
  std::pair<double, double> weight_at(double r) const {
    const double inner = fracture_constants::kPlateau * radius_;
    if (r <= inner) return {1, 0};
    const double width = radius_ - inner, share = (r - inner) / width;
    return {1 - share * share * (3 - 2 * share), -6 * share * (1 - share) / width};
  }

  /// Adds the displacement of a sample to its crack side, extrapolated to the crack by its gradient.
  void add_side(const TipSample& one) {
    const TipPath::Projection on = path_->project(one.position);
    if (on.behind < fracture_constants::kOpeningStart * length_ || on.behind > length_ ||
        std::abs(on.offset) > width_)
      return;
    const bool left = on.offset > 0;
    side_[left] += one.area * (one.displacement - on.offset * (one.gradient * on.left));
    area_[left] += one.area;
  }

  const TipPath* path_;
  double radius_, modulus_, length_, width_;
  double release_rate_ = 0;
  Vec<2> side_[2] = {Vec<2>::Zero(), Vec<2>::Zero()};  ///< right, left: Σ u dA
  double area_[2] = {0, 0};
};

}  // namespace mpmfast
