#pragma once

/// @file What a scene needs, and nothing else: columns, velocity fields, passes. The only place that decides.

#include <string>
#include <vector>

#include "engine/plan/pair_table.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/nodes.hpp"
#include "engine/state/particles.hpp"
#include "kernels/transfer/update_rule.hpp"

namespace mpmfast {

struct Plan {
  int dimension = 2;
  PlaneKind plane_kind = PlaneKind::plane_strain;
  BasisKind basis{};
  ParticleUpdate update{};
  PositionUpdate position{};
  double occupation = 0;           ///< C_c of extended splines; 0: they are not extended
  int order = 1;                   ///< m of XPIC(m) and FMPM(m)
  std::uint64_t filter_every = 1;  ///< steps from one filter of XPIC and FMPM to the next
  bool full_mass = false;          ///< FMPM: the series filters v⁺ instead of v and what it changes by
  double strain_first = 1;  ///< share of the strain that is advanced before the forces; the rest comes last
  bool re_extrapolate = false;  ///< the strain that comes last is taken from the particles' new momenta
  double wall_share = 1;  ///< of what walls take from velocities as a step begins: FLIP's particles take it
  int deformation_terms = 2;
  bool contact = false;  ///< on nodes: more than one velocity field, and a law that acts
  bool surface = false;  ///< contact acts at points of the surface, not on nodes
  bool penalty = false;  ///< the same between surfaces that are followed
  bool own_filter = false;
  bool paired = false;                  ///< XPIC carries Δv* beside v*
  bool first_correction_stays = false;  ///< particles keep its impulse: PIC, and XPIC without the Δv terms
  double first_share = 0;               ///< of its impulse: FLIP's particles take it too, as a force
  bool first_correction = true;   ///< contact is corrected before the strain too, not only after the momenta
  bool one_set = false;           ///< which pairs touch is decided once a step, for both corrections and v′
  bool contact_geometry = false;  ///< some law asks for normals and separations
  bool keeps_fits = false;        ///< normals outlast a step
  bool interface_springs = false;  ///< some pair is joined by springs
  bool cracks_alone = false;       ///< contact is that of the sides of cracks: only what reaches them has any
  bool displacements = false;     ///< are projected with their slopes: for the jumps of interfaces and cracks
  bool exact_fields = false;      ///< some pair is tied for good, or by springs
  bool geometry = false;          ///< volume gradients and mean positions are projected
  double split_edge = 0;          ///< cells, of a domain's edges at which its particle is split; 0: none is
  std::vector<bool> body_splits;  ///< as Scene::bodies; empty: no particle is split
  bool heat = false;              ///< temperatures are conducted
  bool gravity = false;           ///< or an acceleration of some body
  bool force_with_mass =
      false;  ///< no strain comes first: forces follow from stresses known as a step begins
  std::vector<std::string> fields;  ///< names of the velocity fields
  std::vector<int> body_field;      ///< as Scene::bodies
  std::vector<bool> field_rigid;
  std::vector<Vec3> field_acceleration;  ///< m/s², gravity and the bodies' own; zero of rigid ones
  /// By field: its sides behind cracks, fields of their own from this number on; −1: none crosses it.
  std::vector<int> first_side;
  std::vector<int> sides;  ///< how many of them: 1, or 3 where two cracks may meet on a node
  PairTable pairs;         ///< laws of their own between fields; empty: one law for all
  std::vector<Quantity> particle_columns;
  std::vector<Nodal> nodal_columns;
  std::vector<std::string> passes;  ///< of a step, in order

  /// Do particles move with v′, and with v⁺ as far as they are pressed? `position: grid` stays as published.
  bool moves_as_strained() const {
    return re_extrapolate && position == PositionUpdate::grid_end &&
           (update == ParticleUpdate::flip || update == ParticleUpdate::xpic);
  }
};

Plan make_plan(const Scene& scene);
PairTable make_pair_table(const Scene& scene, const std::vector<int>& body_field, int fields);

}  // namespace mpmfast
