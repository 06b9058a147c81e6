#pragma once

/// @file What drives a crack at its tip: J by its domain form over a disk about it, and its share in each
/// mode by how the sides are apart behind the tip (NN's own code does so too).
///
/// With q = 1 near the tip, falling smoothly to 0 at the rim, and x₁ along the crack, out of it,
///
///   J = ∫ (σ_ij u_i,₁ − W δ_1j) q,_j dA
///
/// where nothing moves in the disk and the sides rub on nothing. Both jumps grow as √r behind a tip, so that
/// K_I : K_II = δ_n : δ_t however far one looks, and a crack that is pressed closed has none of mode I.

#include <cmath>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// A piece of the plane near a tip, in axes along the crack and to the left of it.
struct TipSample {
  Vec<2> place;   ///< from the tip, m
  double area;    ///< m²
  Vec<2> moved;   ///< u, m
  Mat<2> slope;   ///< u_i,j
  Mat<2> stress;  ///< Cauchy, Pa
  double energy;  ///< W by the volume now, J/m³
};

class TipIntegrals {
 public:
  /// @param radius   of the disk, m
  /// @param modulus  E′: of the plane, Pa; 0: unknown, no stress intensities
  TipIntegrals(double radius, double modulus) : radius_(radius), modulus_(modulus) {}

  void add(const TipSample& one) {
    const double r = one.place.norm(), inner = kInner * radius_;
    if (r >= radius_) return;
    see_opening(one);
    if (r <= inner) return;
    const double share = (r - inner) / (radius_ - inner), steep = 6 * share * (1 - share) / (radius_ - inner);
    const Vec<2> fall = -one.area * steep / r * one.place;  // ∇q dA
    release_ += one.slope.col(0).dot(one.stress * fall) - one.energy * fall[0];
  }

  double release() const { return release_; }  ///< J, J/m²
  /// δ_t and δ_n, the left side less the right, m; zero where none was seen.
  Vec<2> opening() const {
    if (!(area_[0] > 0) || !(area_[1] > 0)) return Vec<2>::Zero();
    return face_[1] / area_[1] - face_[0] / area_[0];
  }
  /// K_II and K_I, Pa √m
  Vec<2> intensities() const {
    const Vec<2> apart = opening();
    const double length = apart.norm();
    if (!(length > 0) || !(release_ > 0)) return Vec<2>::Zero();
    return std::sqrt(modulus_ * release_) / length * apart;
  }

 private:
  /// Displacements are led to the sides along their slopes.
  void see_opening(const TipSample& one) {
    constexpr double kFrom = 0.25, kTo = 0.7, kBeside = 0.18;  // of the radius
    const double behind = -one.place[0] / radius_, beside = std::abs(one.place[1]) / radius_;
    if (behind < kFrom || behind > kTo || beside > kBeside) return;
    const bool left = one.place[1] > 0;
    face_[left] += one.area * (one.moved - one.place[1] * one.slope.col(1));
    area_[left] += one.area;
  }

  static constexpr double kInner = 0.4;  ///< of the radius: q is 1 within
  double radius_, modulus_;
  double release_ = 0;
  Vec<2> face_[2] = {Vec<2>::Zero(), Vec<2>::Zero()};  ///< right, left: Σ u dA
  double area_[2] = {0, 0};
};

}  // namespace mpmfast
