#pragma once

/// @file The springs and bonds between the surfaces of a contact pair (NN chapter 5,
/// kernels/contact/bond.hpp).

#include "kernels/contact/interface.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// The displacement jump u_b − u_a of a pair, as springs see it.
template <int Dim>
struct DisplacementJump {
  Vec<Dim> value = Vec<Dim>::Zero();         ///< at the start of the step, then at its end, m
  Vec<Dim> normal = Vec<Dim>::Zero();        ///< of the surface on which a known jump was last seen
  Vec<Dim> extrapolated = Vec<Dim>::Zero();  ///< from the displacements of particles, at the start, m
  bool known = false;                        ///< `value` is that of the end of the last step
  bool integrated = false;                   ///< `extrapolated` is the known jump itself
};

/// What acts on the two fields of a pair beside its own springs.
template <int Dim>
struct SpringEnds {
  int a = -1, b = -1;                    ///< which of the node's fields
  double inverse_a{}, inverse_b{};       ///< of their masses, 1/kg; 0 for a rigid one
  Vec<Dim> rate = Vec<Dim>::Zero();      ///< v_b − v_a at the start, m/s
  Vec<Dim> external = Vec<Dim>::Zero();  ///< its change by all other forces, m/s²
};

/// The springs that join a pair at a node.
template <int Dim>
struct InterfaceSpring {
  DisplacementJump<Dim> jump;
  SpringEnds<Dim> ends;
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< as PairGeometry::normal, also where walls hold a part of it
  bool acts = false;                   ///< springs join the two here
  double own_area{}, mean_area{};  ///< surface at the node: of the lighter side, and the mean of both, m²
  double area{};                   ///< that the springs have, m²
  Springs stiffness{};             ///< of straight springs, or of an undamaged bond, N/m
  Vec<Dim> impulse = Vec<Dim>::Zero();   ///< Δp_a, N s
  Vec<Dim> friction = Vec<Dim>::Zero();  ///< the part of it by friction of compressed springs
  double friction_work{};                ///< J, of this step
};

/// A bond that breaks, and the material point that it was found at.
template <int Dim>
struct Bond {
  double damage = 1;                   ///< D in [0, 1]; 1: broken
  Vec<Dim> offset = Vec<Dim>::Zero();  ///< of the material point from the node, cells
  double damage_before = -1;           ///< at the end of the last step; negative: no bond was here
  Vec<Dim> offset_before = Vec<Dim>::Zero();
  double area{};        ///< of the surface at the node, also where it is broken, m²
  double least_area{};  ///< with a smaller area the bond follows those of the nodes around, m²
  double lost{};        ///< energy dissipated in this step, J

  bool is_broken() const { return damage >= 1; }
  bool follows() const { return area < least_area; }
};

}  // namespace mpmfast
