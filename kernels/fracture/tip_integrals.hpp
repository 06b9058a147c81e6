#pragma once

/// @file What drives a crack at its tip: J by its domain form over a disk about it, and its share in each
/// mode by how the sides are apart behind the tip (NN's own code does so too).
///
/// With q the direction of the crack, as long as 1 near the tip and falling smoothly to 0 at the rim,
///
///   J = ∫ [(σ_ij u_i,k − (W + T) δ_jk) q_k,j + ρ (a_i u_i,k − v_i v_i,k) q_k] dA − ∫ t_i [u_i],k q_k ds,
///
/// T = ρ v²/2, v best from that of the material at the tip (J is the same for whoever flies along, sums over
/// particles are not), a what stresses accelerate, t the traction on one side and [u] what that is ahead of
/// the other (Nakamura, Shih and Freund 1985). On each circle about the tip q is the direction that the crack
/// has where it crosses that: so it lies along the sides of a crack that bends, and these add nothing else.
///
/// Both jumps grow as √r behind a tip, so that K_I : K_II = δ_n : δ_t however far one looks, and a crack that
/// is pressed closed has none of mode I.

#include <cmath>

#include "kernels/dimension.hpp"
#include "kernels/fracture/tip_path.hpp"
#include "kernels/fracture/tip_sample.hpp"

namespace mpmfast {

class TipIntegrals {
 public:
  /// @param radius   of the disk, m
  /// @param modulus  E′: of the plane, Pa; 0: unknown, no stress intensities
  /// @param reach    back along the crack that it is straight, m: no farther is asked how its sides are apart
  /// @param beside   so far beside the crack its sides are looked for at least, m
  TipIntegrals(const TipPath& path, double radius, double modulus, double reach = HUGE_VAL, double beside = 0)
      : path_(&path),
        radius_(radius),
        modulus_(modulus),
        reach_(std::min(kReach * radius, reach)),
        beside_(std::max(kBeside * radius, beside)) {}

  void add(const TipSample& one) {
    const double r = one.place.norm();
    if (r >= radius_) return;
    see_opening(one);
    const Vec<2> along = path_->along(r);
    const auto [weight, fall] = plateau(r);
    const Vec<2> pull =
        one.slope.transpose() * one.acceleration - one.velocity_slope.transpose() * one.velocity;
    release_ += one.area * one.density * weight * pull.dot(along);
    if (!(r > 0)) return;
    const Mat<2> gradient = (fall * along + weight * path_->bend(r)) * (one.place / r).transpose();  // q_k,j
    const double kinetic = 0.5 * one.density * one.velocity.squaredNorm();
    release_ += one.area * ((one.slope.transpose() * one.stress).cwiseProduct(gradient).sum() -
                            (one.energy + kinetic) * gradient.trace());
  }

  void add(const TipTraction& one) {
    const double r = one.place.norm();
    if (r < radius_) release_ -= plateau(r).first * one.force.dot(one.slope * path_->along(r));
  }

  double release() const { return release_; }  ///< J, J/m²
  /// δ_t and δ_n, the left side less the right, m; zero where none was seen.
  Vec<2> opening() const {
    if (!(area_[0] > 0) || !(area_[1] > 0)) return Vec<2>::Zero();
    return face_[1] / area_[1] - face_[0] / area_[0];
  }
  /// K_II and K_I, Pa √m; all of mode I where no sides were seen
  Vec<2> intensities() const {
    const Vec<2> apart = opening();
    const double length = apart.norm();
    if (!(release_ > 0)) return Vec<2>::Zero();
    if (!(area_[0] > 0) || !(area_[1] > 0)) return {0, std::sqrt(modulus_ * release_)};
    if (!(length > 0)) return Vec<2>::Zero();
    return std::sqrt(modulus_ * release_) / length * apart;
  }

 private:
  /// |q| and d|q|/dr
  std::pair<double, double> plateau(double r) const {
    const double inner = kInner * radius_;
    if (r <= inner) return {1, 0};
    const double width = radius_ - inner, share = (r - inner) / width;
    return {1 - share * share * (3 - 2 * share), -6 * share * (1 - share) / width};
  }

  /// Displacements are led to the sides along their slopes.
  void see_opening(const TipSample& one) {
    const TipPath::Beside at = path_->beside(one.place);
    if (at.behind < kFrom * reach_ || at.behind > reach_ || std::abs(at.offset) > beside_) return;
    const bool left = at.offset > 0;
    face_[left] += one.area * (one.moved - at.offset * (one.slope * at.left));
    area_[left] += one.area;
  }

  static constexpr double kInner = 0.4;                  ///< of the radius: |q| is 1 within
  static constexpr double kReach = 0.7, kBeside = 0.18;  ///< of the radius: where the sides are looked at
  static constexpr double kFrom = 0.25 / kReach;         ///< of the reach
  const TipPath* path_;
  double radius_, modulus_, reach_, beside_;
  double release_ = 0;
  Vec<2> face_[2] = {Vec<2>::Zero(), Vec<2>::Zero()};  ///< right, left: Σ u dA
  double area_[2] = {0, 0};
};

}  // namespace mpmfast
