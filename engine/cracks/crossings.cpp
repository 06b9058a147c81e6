#include "engine/cracks/crossings.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "engine/cracks/element.hpp"

namespace mpmfast {

namespace {

template <int Dim>
Point2 in_plane(const Vec<Dim>& x) {
  return {x[0], x[1]};
}

/// The box of the window of a tile, with one cell around it.
template <int Dim>
CrackBox<Dim> box_of_window(const GridView<Dim>& grid, const ParticleTile<Dim>& tile) {
  CrackBox<Dim> box;
  for (int d = 0; d < Dim; ++d) {
    box[0][d] = grid.origin[d] + (tile.window[d] - 1) * grid.cell;
    box[1][d] = grid.origin[d] + (tile.window[d] + kWindowSide) * grid.cell;
  }
  return box;
}

/// Counts one crossing of a line. Two in opposite directions cancel.
/// @param own  where the crossings of the particle begin in `out`
template <int Dim>
void count_crossing(const CrackCrossing<Dim>& crossing, std::size_t own,
                    std::vector<CrackCrossing<Dim>>& out) {
  const auto known =
      std::find_if(out.begin() + static_cast<std::ptrdiff_t>(own), out.end(),
                   [&](const auto& one) { return one.node == crossing.node && one.crack == crossing.crack; });
  if (known == out.end())
    out.push_back(crossing);
  else if ((known->direction += crossing.direction) == 0)
    out.erase(known);
}

/// Finds the crossings of one particle with the segments whose boxes it reaches.
template <int Dim>
void find_crossings_of(std::uint32_t particle, const NodeRange<Dim>& nodes,
                       const CrossingWorkspace<Dim>& workspace, std::vector<CrackCrossing<Dim>>& out) {
  const LineCrossings& lines = workspace.lines;
  const std::size_t own = out.size();
  const CrackSegment<Dim>* before = nullptr;
  LineCrossings::Bits left_of_from = 0, left_of_to = 0;
  for (const int k : workspace.reached) {
    const CrackSegment<Dim>* segment = element(workspace.near, k);
    const Point2 from = in_plane<Dim>(segment->from), to = in_plane<Dim>(segment->to);
    const bool continues = before && segment == before + 1 && before->crack == segment->crack;
    left_of_from = continues ? left_of_to : lines.point_is_left(from);
    left_of_to = lines.point_is_left(to);
    before = segment;
    if (left_of_from == left_of_to) continue;
    const auto [other_side, left] = lines.ends(from, to);
    for (auto crossed = (left_of_from ^ left_of_to) & other_side; crossed != 0; crossed &= crossed - 1) {
      const int line = std::countr_zero(crossed), direction = left >> line & 1 ? 1 : -1;
      count_crossing<Dim>({particle, nodes.node(line), segment->crack, direction, segment->normal}, own, out);
    }
  }
}

}  // namespace

template <int Dim>
void find_crossings(const State<Dim>& state, const Supports<Dim>& supports, const ParticleTile<Dim>& tile,
                    const CrackSegments<Dim>& segments, CrossingWorkspace<Dim>& workspace,
                    std::vector<CrackCrossing<Dim>>& out) {
  const double cell = state.grid.cell;
  segments.find(tile.field, box_of_window(state.grid, tile), workspace.near);
  if (workspace.near.empty()) return;
  workspace.boxes.build(workspace.near);
  for_each_particle(state.tiling.runs, tile, [&](std::uint32_t p) {
    const Vec<Dim> x = state.particles.vector(Quantity::position, p);
    const NodeRange<Dim> nodes = nodes_ahead(supports, p, cell);
    const auto coordinate = [&](int d, int k) { return state.grid.origin[d] + (nodes.first[d] + k) * cell; };
    Point2 low, high;
    for (int d = 0; d < 2; ++d) {
      element(low, d) = std::min(coordinate(d, 0), x[d]);
      element(high, d) = std::max(coordinate(d, nodes.count[d] - 1), x[d]);
    }
    workspace.boxes.find(low, high, workspace.reached);
    if (workspace.reached.empty()) return;
    workspace.lines.start(in_plane<Dim>(x));
    for (int k = 0; k < nodes.size(); ++k)
      workspace.lines.add(
          {coordinate(0, k % nodes.count[0]), coordinate(1, k / nodes.count[0] % nodes.count[1])});
    find_crossings_of(p, nodes, workspace, out);
  });
}

template void find_crossings(const State<2>&, const Supports<2>&, const ParticleTile<2>&,
                             const CrackSegments<2>&, CrossingWorkspace<2>&, std::vector<CrackCrossing<2>>&);
template void find_crossings(const State<3>&, const Supports<3>&, const ParticleTile<3>&,
                             const CrackSegments<3>&, CrossingWorkspace<3>&, std::vector<CrackCrossing<3>>&);

}  // namespace mpmfast
