#pragma once

/// @file Friction of penalty contact (K24 Eq. 29, 32): a tangential spring that stretches with the slip, and
/// returns to the limit of the contact law.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/constants.hpp"
#include "engine/state/archive.hpp"
#include "kernels/contact/laws.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast::penalty {

/// Tangential spring between a point of integration and a patch.
template <int Dim>
struct TangentialSpring {
  int patch = -1;                       ///< −1: none
  bool slides = false;                  ///< the limit was reached in the last step
  Vec<Dim> stretch = Vec<Dim>::Zero();  ///< slip since the spring was unloaded, less what returned, m
};

/// Force of a tangential spring.
template <int Dim>
struct TangentialForce {
  Vec<Dim> force;     ///< on the point of integration, N
  double dissipated;  ///< in this step, J
  double stored;      ///< in the spring, J
};

/// Largest tangential force of a contact, N; infinite of `stick`.
/// @param normal  normal force, N
/// @param speed   of the slip, m/s
/// @param slides  the contact slid in the last step, so that the static coefficient does not count
double friction_limit(const AnyLaw& law, double normal, double speed, bool slides);

/// Stretches a spring by the slip of a step, after turning it with the surface.
/// @param slip            tangential, of the point over the closest point, m
/// @param exit_direction  unit normal of the contact
template <int Dim>
void stretch_spring(TangentialSpring<Dim>& spring, const Vec<Dim>& slip, const Vec<Dim>& exit_direction);

/// Return mapping: reduces the stretch to the limit. The spring's force does the dissipated work on the
/// reduction.
/// @param stiffness  N/m
/// @param limit      N
template <int Dim>
TangentialForce<Dim> return_to_limit(TangentialSpring<Dim>& spring, double stiffness, double limit);

/// Springs of a point of integration in the step that stored them.
template <int Dim>
struct PointSprings {
  std::uint64_t step{};
  std::array<TangentialSpring<Dim>, kMaxSprings> springs;

  /// The spring to a patch, if the point was in contact with it in the step before; else a new one.
  TangentialSpring<Dim> restore(int patch, std::uint64_t now) const;
};

/// Tangential springs from step to step, by point of integration.
template <int Dim>
class FrictionHistory {
 public:
  explicit FrictionHistory(std::size_t points) : points_(points) {}

  PointSprings<Dim>& operator[](std::size_t point) { return points_[point]; }
  void visit(Archive& archive);
  std::size_t bytes() const;

 private:
  std::vector<PointSprings<Dim>> points_;
};

extern template struct PointSprings<2>;
extern template struct PointSprings<3>;
extern template class FrictionHistory<2>;
extern template class FrictionHistory<3>;

}  // namespace mpmfast::penalty
