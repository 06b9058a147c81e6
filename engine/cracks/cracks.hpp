#pragma once

/// @file Cracks: surfaces inside bodies, as lines of points that move with them. On nodes near a crack, the
/// particles on its two sides have velocity fields of their own (NN section 1.1).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/constants.hpp"
#include "engine/cracks/crack_line.hpp"
#include "engine/cracks/crack_sides.hpp"
#include "engine/cracks/cracked_nodes.hpp"
#include "engine/cracks/crossings.hpp"
#include "engine/cracks/line_motion.hpp"
#include "engine/cracks/segments.hpp"
#include "engine/cracks/visibility.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

struct TipLoad;

struct CrackCounters {
  std::uint64_t groupings = 0;  ///< of the particles by their crack sides
  std::uint64_t third = 0;      ///< crossings of a third crack of a node, which are ignored
};

/// How far the sides of particles are out of date.
struct ClassificationAge {
  double since_last = HUGE_VAL;  ///< largest displacement since the last classification, m
  double since_start = 0;        ///< largest displacement since the start of the run, m

  void add(double displacement) { since_last += displacement, since_start += displacement; }
  /// Particles do not change sides, and a classification covers the nodes that they reach until the next one.
  /// Only ends of cracks, bends and normals follow the displacement late.
  bool due(double cell) const {
    using namespace crack_constants;
    return since_last >=
           std::min(kReclassify * cell, std::max(kFirstReclassify * cell, kReclassifyGrowth * since_start));
  }
};

/// All cracks of a scene.
template <int Dim>
class Cracks {
 public:
  using Parting = CrackContact<Dim>;

  Cracks(const Scene& scene, const Plan& plan);

  bool active() const { return !lines_.empty(); }
  const std::vector<CrackLine<Dim>>& lines() const { return lines_; }
  const CrackCounters& counters() const { return counters_; }

  /// The particles have moved by this at most, m.
  void add_displacement(double displacement) { age_.add(displacement); }
  bool classification_due(double cell) const { return age_.due(cell); }
  /// Finds the crack sides of all particles. @return whether they differ from the sides of their groups
  SideChange classify(const State<Dim>& state, const Supports<Dim>& supports);
  /// Groups the particles by the sides found last, and numbers the slots anew.
  void group(State<Dim>& state);
  /// Marks the tiles that reach cracked nodes, or soon will (ParticleTile::cracked). Only these project what
  /// contact between crack sides needs.
  void mark_tiles(State<Dim>& state, const Supports<Dim>& supports) const;

  /// Are two fields sides of one body?
  bool same_body(const State<Dim>& state, int a, int b) const {
    return active() && element(state.field_base, a) == element(state.field_base, b);
  }
  /// The crack between two fields of same_body at a node.
  /// @param a,b    fields, a < b
  /// @param alone  the node has no other fields
  Parting parting(const State<Dim>& state, const NodeIndex<Dim>& node, int a, int b, bool alone) const;

  /// Moves the lines with the bodies.
  void move(const State<Dim>& state, double dt);

  /// Has a crack a growth rule?
  bool grows(int crack) const { return element(scene_->cracks, crack).growth.active; }
  /// Is any end due for a growth check?
  bool growth_due(double time) const;
  /// Lets the ends that are due grow, where their loads suffice. Stresses must be current.
  /// @param load_of  (crack, end) → TipLoad
  void grow(const State<Dim>& state, const std::function<TipLoad(int, bool)>& load_of);
  /// Are the sides of a crack at a node new, since an end grew past it in the last step?
  bool is_fresh(const State<Dim>& state, int crack, const NodeIndex<Dim>& node) const;

  /// Reads or writes the state that persists from step to step.
  void visit(Archive& archive);

 private:
  void find_all_crossings(const State<Dim>& state, const Supports<Dim>& supports);

  const Scene* scene_;
  SideFields fields_;
  std::vector<CrackLine<Dim>> lines_;
  CrackSegments<Dim> segments_;
  std::vector<CrossingWorkspace<Dim>> search_;              ///< of each thread
  std::vector<std::vector<CrackCrossing<Dim>>> crossings_;  ///< by tile
  CrackedNodes<Dim> nodes_;
  std::vector<std::vector<ParticleSides<Dim>>>
      sides_;                                  ///< by tile, of the particles with another side than 0
  std::array<SideVelocities<Dim>, 2> motion_;  ///< workspace
  CrackCounters counters_;
  ClassificationAge age_;
};

extern template class Cracks<2>;
extern template class Cracks<3>;

}  // namespace mpmfast
