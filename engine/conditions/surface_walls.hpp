#pragma once

/// @file Walls that act where bodies end (`at: surface`): contact of particles with planes of the grid's
/// axes.

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "engine/conditions/boundary_ledger.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// A wall meets each velocity field in the columns of nodes that cross its plane. The gap of a column is that
/// of the particles around it, d = min ((X_p − plane)·n − R_p), n inwards (N20 Eq. 24 with a plane for one of
/// the surfaces). Which columns touch is decided once a step, and the same ones are held wherever conditions
/// act: strains then miss no work that the particles do.
///
/// What is held is the plane. On the rows around it, from the last or last but one inside outwards, the
/// velocity becomes a straight line through the wall's at the plane, or through that which closes the gap by
/// the end of the step; P takes off what is not on the line (projection of least Σ m Δv²). Per step FLIP's
/// particles gain Σ f·½(v_s + v')Δt, v_s the velocities that they bring and v' those that they take back, and
/// store what strains make of v_s and v'. With both strained as (1 − P)v and the reaction −P(f Δt), what the
/// particles gain and store is the wall's work to round-off. To react to −P v_s too (NN Eq. 2.7) takes ½ m
/// v_s² of it in every step; to leave it out for good leaves an approach in the particles that the grid never
/// sees. A small share of it ends that within as many steps as its inverse; other updates need all of it.
///
/// Friction that slides is a force. What sticks is held along the wall as it is across it, in v' and while it
/// lasts in the next step's v_s: the friction of a body at rest would work on slips that particles happen to
/// bring (tools/manual/theory.md, "The energy of a contact").
template <int Dim>
class SurfaceWalls {
 public:
  /// Whether another condition prescribes the velocity of a node along an axis.
  using Prescribed = std::function<bool(const NodeIndex<Dim>&, int axis)>;

  static constexpr int kInside = 2;      ///< rows of a column on the inner side of the plane, at most
  static constexpr int kRowsBeyond = 3;  ///< and at or beyond it: as far out as a basis reaches
  static constexpr int kRows = kInside + kRowsBeyond;

  explicit SurfaceWalls(const Scene& scene);
  bool empty() const { return walls_.empty(); }
  void invalidate_nodes() { stale_ = true; }
  /// The state that persists from step to step: the columns that stick.
  void visit(Archive& archive);

  /// Planes, columns and gaps of the step from t to t + dt, after the projection of masses.
  void prepare(const State<Dim>& state, double t, double dt, const Prescribed& prescribed);
  /// Which columns touch, from the momenta as they are: the same ones are held wherever walls act.
  void decide(const State<Dim>& state);
  /// Axes along which a wall holds the slot in this step, a bit each.
  unsigned constrained_axes(int slot) const {
    return constrained_.empty() ? 0 : constrained_[static_cast<std::size_t>(slot)];
  }
  /// Puts nodal velocities on the lines of the columns that touch: `velocity`, before forces, or
  /// `re_extrapolated`, after them, with what friction takes of both.
  void impose_velocity(State<Dim>& state, Nodal velocities, BoundaryLedger<Dim>& ledger);
  /// Before the momentum update: reactions to the forces.
  void react(State<Dim>& state, double dt, BoundaryLedger<Dim>& ledger);
  /// After the second contact correction: what it pushes into walls, and friction.
  void enforce(State<Dim>& state, double dt, BoundaryLedger<Dim>& ledger);

 private:
  static constexpr int kAcross = kWindowNodes<Dim> / kWindowSide;

  struct Wall {
    int boundary, axis, out;  ///< out: sign of the way out along the axis
    double friction;          ///< infinite: it holds
    bool moves;               ///< at some time
    double plane{};           ///< cells from the grid's origin
    double speed{};           ///< m/s along the axis
    int row{};                ///< first one at or beyond the plane
    double cut = 1;           ///< cells from the last row inside to the plane
  };
  /// Least gaps of the particles whose domains lie over a column, of those less than a cell beside it, and of
  /// those further off whose functions may reach it.
  struct Gaps {
    double over = std::numeric_limits<double>::infinity(), beside = over, around = over;
    double& of(bool is_over, bool is_beside) { return is_over ? over : is_beside ? beside : around; }
    void take(const Gaps& other) {
      over = std::min(over, other.over);
      beside = std::min(beside, other.beside);
      around = std::min(around, other.around);
    }
    /// A round body touches where its particles are over a column; what is beside one counts where it would
    /// come through between two columns, and beyond the edge of a body.
    double least(double slack) const {
      return std::isfinite(over) ? std::min(over, beside + slack) : std::min(beside, around);
    }
  };
  /// Nodes of one field across a plane, from the last row inside outwards; −1: none, or not the wall's.
  struct Column {
    std::array<int, kRows> slot;
    int wall;
    unsigned sideways;  ///< bit of each axis along which the wall has friction
    double gap;         ///< m; infinite where no particle is near
    Gaps gaps;          ///< cells
    double target;      ///< m/s along the axis, at the plane
    double pushed;      ///< N s so far in this step, inwards
    bool touches;
    bool stuck;         ///< along the wall, at the end of the last friction
    int friction;       ///< the first of its axes in frictions_
    std::uint64_t key;  ///< of the wall, the line across it and the field
  };
  /// A tile of particles near a wall, and the columns of its window.
  struct Near {
    int tile, wall;
    std::array<int, kAcross> column;
    std::array<Gaps, kAcross> gap;  ///< cells
  };
  /// What straightens a column: the impulse of each of its rows, N s.
  struct Change {
    double row[kRows] = {};
    double sum = 0;
  };

  /// Friction of a column along an axis, by row: what holds it before forces and its impulse, N s; the
  /// velocity that the strain before forces sees, m/s.
  struct Friction {
    std::array<double, kRows> first, impulse, held;
  };

  void list(const State<Dim>& state, const Prescribed& prescribed);
  void keep_stuck();
  void list_column(const State<Dim>& state, int wall, const NodeIndex<Dim>& node, int field,
                   const Prescribed& prescribed);
  void list_near(const State<Dim>& state);
  void measure(const State<Dim>& state, Near& near) const;
  void find_gaps(const State<Dim>& state);
  template <class Velocity>
  Change straighten(const State<Dim>& state, const Column& column, double target, Velocity velocity) const;
  Change of_momentum(const State<Dim>& state, const Column& column, double target, int axis) const;
  void add(State<Dim>& state, Nodal q, const Column& column, int axis, const Change& change,
           double factor) const;
  void take(const State<Dim>& state, const Column& column, const Change& start,
            BoundaryLedger<Dim>& ledger) const;
  void take_touch(const State<Dim>& state, const Column& column, const Change& both,
                  BoundaryLedger<Dim>& ledger) const;
  void push(State<Dim>& state, double dt, Column& column, const Change& change, double factor,
            BoundaryLedger<Dim>& ledger) const;
  void hold_slip(State<Dim>& state, const Column& column);
  void apply_friction(State<Dim>& state, double dt, Column& column, BoundaryLedger<Dim>& ledger);
  void release(const State<Dim>& state, double dt, Column& column, BoundaryLedger<Dim>& ledger);
  double friction_work(const State<Dim>& state, const Column& column, int axis,
                       const Friction& friction) const;
  /// Calls f(axis, Friction) for every axis along which the wall has friction on the column.
  template <class F>
  void for_each_sideways(const Column& column, F f) {
    for (int d = 0, k = column.friction; d < Dim; ++d)
      if (column.sideways >> d & 1) f(d, frictions_[static_cast<std::size_t>(k++)]);
  }
  void straighten_velocity(State<Dim>& state, Nodal velocities, const Column& column, double target,
                           int axis) const;
  double target_approach(const Column& column) const;

  const Scene* scene_;
  double share_;  ///< of −P v_s that particles take as a force
  bool whole_;    ///< strains see what particles take back: the friction work is found from it
  bool holds_;    ///< what sticks
  double dt_{};   ///< of this step
  bool stale_ = true;
  std::vector<Wall> walls_;
  std::vector<Column> columns_;
  std::vector<std::pair<int, int>> at_;    ///< slot of a column's row at the plane, its index; in order
  std::vector<int> first_;                 ///< by wall, into at_
  std::vector<std::uint8_t> constrained_;  ///< by slot: see constrained_axes
  std::vector<Near> near_;
  std::vector<Friction> frictions_;
  std::vector<std::uint64_t>
      stuck_;  ///< keys of columns, in order: while the list is made anew, and from a checkpoint
};

extern template class SurfaceWalls<2>;
extern template class SurfaceWalls<3>;

}  // namespace mpmfast
