/// The work of walls `at: surface` that move: force times the displacement of what it acts on
/// (BoundaryLedger).

#include "engine/conditions/surface_walls.hpp"

namespace mpmfast {

/// The share of what straightens the velocities as a step begins that particles take (BoundaryLedger).
template <int Dim>
void SurfaceWalls<Dim>::take(const State<Dim>& state, const Column& column, const Change& start,
                             BoundaryLedger<Dim>& ledger) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  if (!wall.moves) return;
  const double *mass = state.nodes.column(Nodal::mass),
               *momentum = state.nodes.column(Nodal::momentum, wall.axis);
  for (std::size_t k = 0; k < kRows; ++k)
    if (const int slot = column.slot[k]; start.row[k] != 0)
      ledger.taken.push_back(
          {slot, Vec<Dim>::Unit(wall.axis), share_ * start.row[k], momentum[slot] / mass[slot], wall.speed});
}

/// Of a column that forces bring to the wall the first strain of the step is not held: material moves with
/// v_s, then with the target.
template <int Dim>
void SurfaceWalls<Dim>::take_touch(const State<Dim>& state, const Column& column, const Change& both,
                                   BoundaryLedger<Dim>& ledger) const {
  const Wall& wall = walls_[static_cast<std::size_t>(column.wall)];
  const double *mass = state.nodes.column(Nodal::mass),
               *momentum = state.nodes.column(Nodal::momentum, wall.axis);
  const Change start = of_momentum(state, column, column.target, wall.axis);
  for (std::size_t k = 0; k < kRows; ++k) {
    const int slot = column.slot[k];
    if (slot < 0 || !(mass[slot] > 0)) continue;
    const double v = momentum[slot] / mass[slot];
    ledger.taken.push_back({slot, Vec<Dim>::Unit(wall.axis), start.row[k], v, wall.speed});
    ledger.work += (both.row[k] - start.row[k]) * (0.5 * (v + column.target) - wall.speed);
  }
}

// Here: the members that this file defines.
template void SurfaceWalls<2>::take(const State<2>&, const Column&, const Change&, BoundaryLedger<2>&) const;
template void SurfaceWalls<3>::take(const State<3>&, const Column&, const Change&, BoundaryLedger<3>&) const;
template void SurfaceWalls<2>::take_touch(const State<2>&, const Column&, const Change&,
                                          BoundaryLedger<2>&) const;
template void SurfaceWalls<3>::take_touch(const State<3>&, const Column&, const Change&,
                                          BoundaryLedger<3>&) const;

}  // namespace mpmfast
