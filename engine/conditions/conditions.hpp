#pragma once

/// @file Velocity conditions on nodes: walls, pistons, symmetry planes, prescribed velocities (NN §2.3.2,
/// §2.5).

#include <array>
#include <optional>
#include <vector>

#include "engine/conditions/surface_walls.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// Each condition prescribes v·n = u on its nodes: a wall on the nodes at and beyond its plane, a box on
/// those inside. Where several act on a node, they are turned to orthonormal directions one after the other:
/// a parallel one adds its velocity, an oblique one keeps what is new of it, so that every prescribed
/// component is met to round-off. What depends on those before it (a third direction in 2-D) is dropped: the
/// first hold.
///
/// A wall takes the nodes at and beyond its plane alone. Nodes beyond it carry little mass and would
/// otherwise be thrown by the full force of the particles at the wall; held at the wall's velocity, they
/// cannot. `at: plane` instead: where the plane cuts a cell, on the rows around it, from the last one inside,
/// the velocity follows the straight line through u at the plane that takes the least impulses. To hold the
/// rows beyond it strains the cut cell as if all of it were filled, and a body is pressed by up to a cell
/// less than its wall moved.
template <int Dim>
class Conditions {
 public:
  explicit Conditions(const Scene& scene);

  /// The speeds of the step from t to t + dt, and the nodes that they act on.
  void prepare(const State<Dim>& state, double t, double dt);
  /// After a sort: slots have new numbers.
  void invalidate_nodes() {
    stale_ = true;
    walls_.invalidate_nodes();
  }

  /// The state that persists from step to step.
  void visit(Archive& archive) { walls_.visit(archive); }

  /// Puts the prescribed components into the nodal velocities that the strain is taken from: `velocity`, or
  /// `re_extrapolated`.
  void impose_velocity(State<Dim>& state, Nodal velocities = Nodal::velocity);
  /// f ← f − (f·e)e + s ((m u − p·e)/Δt) e before the momentum update (NN Eq. 2.7 to 2.11), and p takes the
  /// rest of m u − p·e.
  /// @param share  s: less than all of it where particles are given nothing but forces (FLIP)
  void react(State<Dim>& state, double dt, double share);
  /// After the second contact correction: momentum and force together.
  void enforce(State<Dim>& state, double dt);

  /// Puts the prescribed components into the velocities of an order of FMPM (Nodal::star). Walls `at:
  /// surface` act once a step, and not here.
  /// @param last  particles take this order: the impulses are reactions
  void hold_order(State<Dim>& state, double dt, bool last);

  /// What conditions prescribe of a slot's velocity: which combination of theirs (−1: none), and axes, a bit
  /// each.
  struct Constraint {
    int combination = -1;
    unsigned axes{};
    bool any() const { return combination >= 0 || axes != 0; }
  };
  Constraint constraint(int slot) const {
    return {combination_at_.empty() ? -1 : combination_at_[static_cast<std::size_t>(slot)],
            walls_.constrained_axes(slot)};
  }
  /// Where the plane of some wall is held (`at: plane`), adds the slots of which a component is prescribed.
  void list_held_slots(std::vector<int>& slots) const {
    if (cuts_.empty()) return;
    for (const Constrained& node : nodes_) slots.push_back(node.slot);
  }
  /// Gives the nodes of a line about a plane the least share of pressed mass that one of them has: the plane
  /// moves with its wall where they all move with the same mean of velocities that do.
  void share_compression_weight(State<Dim>& state) const;
  /// The part of x along what is left free.
  Vec<Dim> free_part(const Constraint& constraint, Vec<Dim> x) const {
    if (constraint.combination >= 0) {
      const Combination& c = combinations_[static_cast<std::size_t>(constraint.combination)];
      for (int k = 0; k < c.count; ++k) x -= x.dot(c.direction[k]) * c.direction[k];
    }
    for (int d = 0; d < Dim; ++d)
      if (constraint.axes >> d & 1) x[d] = 0;
    return x;
  }

  /// A velocity with the components that conditions on nodes prescribe, m/s.
  Vec<Dim> with_prescribed(const Constraint& constraint, Vec<Dim> v) const {
    if (constraint.combination < 0) return v;
    const Combination& c = combinations_[static_cast<std::size_t>(constraint.combination)];
    for (int k = 0; k < c.count; ++k) v += (c.speed[k] - v.dot(c.direction[k])) * c.direction[k];
    return v;
  }

  /// Force of each boundary on the material in this step, N.
  const std::vector<Vec<Dim>>& force() const { return ledger_.force; }
  /// Work that the boundaries did on the material in this step, J.
  double work() const { return ledger_.work; }
  /// Work that friction at the boundaries took in this step, J.
  double friction_work() const { return ledger_.friction_work; }
  /// Largest prescribed speed ever, m/s.
  double fastest() const { return fastest_; }
  bool empty() const { return scene_->boundaries.empty(); }

 private:
  /// Conditions that meet on a node, by orthonormal direction.
  struct Combination {
    std::vector<int> members;  ///< indices into directions_
    int count = 0;             ///< orthonormal directions
    Vec<Dim> direction[Dim];
    double speed[Dim];
    bool moves[Dim];        ///< at some time
    Mat<Dim> share;         ///< prescribed directions by orthonormal ones, lower triangle
    Vec<Dim> pushing[Dim];  ///< the prescribed directions
    int boundary[Dim];      ///< which boundary a direction's reaction is entered for
  };
  /// One prescribed component: v·n = u on the nodes of a boundary.
  struct Component {
    int boundary;
    Vec<Dim> direction;
    bool moving;  ///< u is the boundary's speed; else zero
  };
  struct Constrained {
    int slot, combination;
  };
  /// A prescribed component on the nodes of a field around a wall's plane, from the last one inside outwards;
  /// −1: the field has none there.
  static constexpr int kRows = 4;  ///< as far out as a basis reaches
  struct Cut {
    std::array<int, kRows> slot;
    int component;  ///< index into components_
  };

  bool covers(std::size_t boundary, const NodeIndex<Dim>& node) const;
  void components_at(const NodeIndex<Dim>& node, std::vector<int>& members) const;
  std::optional<std::array<NodeIndex<Dim>, kRows>> around_plane(int component,
                                                                const NodeIndex<Dim>& node) const;
  bool meet_on(const State<Dim>& state, const std::array<NodeIndex<Dim>, kRows>& rows) const;
  bool alone_along(int component, const std::vector<int>& members) const;
  int combination_of(const std::vector<int>& members);
  void list_nodes(const State<Dim>& state);
  void orthonormalise(Combination& c) const;
  template <class Change>
  void apply(State<Dim>& state, double dt, Change change);
  template <class Velocity, class Push>
  void apply_cuts(const State<Dim>& state, Velocity velocity, Push push) const;
  void record_impulse(int component, double impulse, double dt);
  void take_shares(const State<Dim>& state, double share);

  const Scene* scene_;
  std::vector<Component> components_;
  std::vector<Combination> combinations_;
  std::vector<Constrained> nodes_;
  std::vector<std::array<double, Dim>> reactions_;  ///< theirs, along the directions of each, N
  std::vector<int> combination_at_;                 ///< by slot; −1: free
  std::vector<Cut> cuts_;
  std::vector<double> speed_;  ///< by boundary, this step
  std::vector<bool> moves_;    ///< by boundary: at some time
  bool gives_back_ = false;    ///< in this step particles keep their velocities and give back v′
  std::vector<int> row_;       ///< by wall: first (upper) or last (lower) row of nodes at or beyond it
  std::vector<double> cut_;    ///< by wall: cells from the last row inside to the plane; 1: it lies on a row
  BoundaryLedger<Dim> ledger_;
  double fastest_ = 0;
  bool stale_ = true;
  SurfaceWalls<Dim> walls_;
};

extern template class Conditions<2>;
extern template class Conditions<3>;

}  // namespace mpmfast
