#pragma once

/// @file What acts on bodies from outside, as a scene states it. A load is a struct, one of LoadSpec.

#include <optional>
#include <variant>

#include "engine/geometry/shapes.hpp"
#include "engine/quantities/time_table.hpp"

namespace mpmfast {

/// The nodal columns that a load reads beside masses and velocities.
struct LoadNeeds {
  bool surface = false;       ///< Σ_p V_p G_pi = ∫ N_i n dS
  bool displacement = false;  ///< of the material at a node since the start
};

/// A pressure p on the surface of a body: the traction −p n, n the outward normal.
struct PressureSpec {
  static constexpr const char* kDescription = "pressure on surfaces";
  int body = 0;                ///< index into Scene::bodies
  TimeTable value{{0}, {0}};   ///< p, Pa
  std::optional<Shape> where;  ///< holds the loaded part of the surface at the start; none: all of it
  std::optional<Vec3> along;   ///< unit vector d: the traction is −p (n·d) d
  LoadNeeds needs() const { return {true, where.has_value()}; }
};

using LoadSpec = std::variant<PressureSpec>;

}  // namespace mpmfast
