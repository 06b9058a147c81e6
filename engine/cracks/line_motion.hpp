#pragma once

/// @file Motion of crack lines: each side of a point moves with the nodal velocities of its crack side, the
/// point itself with their mean (NN section 1.1).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/cracks/crack_line.hpp"
#include "engine/cracks/crack_sides.hpp"
#include "engine/cracks/cracked_nodes.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Velocities of the points of one side of a line, m/s.
template <int Dim>
struct SideVelocities {
  std::vector<Vec<Dim>> velocity;
  std::vector<std::uint8_t> known;  ///< material was found at the point
};

/// Velocity of the material on one side of a crack, between the nodes of a cell: v = Σ w_i v_i / Σ w_i over
/// the nodes where the side has mass, with v_i = Σ p / Σ m over the fields of the side.
/// @param side  0: left, 1: right
/// @return nothing where the side has hardly any mass at the nodes of the cell
template <int Dim>
std::optional<Vec<Dim>> side_velocity(const State<Dim>& state, const CrackedNodes<Dim>& nodes,
                                      const SideFields& fields, const CrackLine<Dim>& line, int crack,
                                      int side, const Vec<Dim>& x);

/// Gives points outside of the body the velocity of the nearest point inside.
template <int Dim>
void extend_velocities(SideVelocities<Dim>& side);

/// Moves both sides of a line and its points. Where one side is unknown it moves with the other.
/// @param workspace  of the left and of the right side
template <int Dim>
void move_line(const State<Dim>& state, const CrackedNodes<Dim>& nodes, const SideFields& fields, int crack,
               double dt, CrackLine<Dim>& line, std::array<SideVelocities<Dim>, 2>& workspace);

}  // namespace mpmfast
