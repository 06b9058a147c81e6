/// Which columns of nodes a wall `at: surface` has, and how far bodies are from its plane in each.

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/conditions/surface_walls.hpp"
#include "engine/constants.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// Of a wall, a line of nodes across it and a field: the same while the wall moves.
template <int Dim>
std::uint64_t key_of(int wall, int axis, const NodeIndex<Dim>& node, int field) {
  constexpr int kBits = 20, kMargin = 64;  // rows beyond the grid's origin have negative numbers
  auto key = static_cast<std::uint64_t>(wall);
  for (int d = 0; d < Dim; ++d)
    if (d != axis) key = key << kBits | static_cast<std::uint64_t>(node[d] + kMargin);
  return key << 16 | static_cast<std::uint64_t>(field);
}

constexpr double kReach = 2;  ///< cells: the widest basis function reaches so far

}  // namespace

template <int Dim>
void SurfaceWalls<Dim>::list(const State<Dim>& state, const Prescribed& prescribed) {
  keep_stuck();
  columns_.clear();
  frictions_.clear();
  at_.clear();
  first_.clear();
  const auto& tiling = state.tiling;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    first_.push_back(static_cast<int>(at_.size()));
    for (const auto& block : tiling.node_blocks) {
      const int layer = wall.row - block.first_node[wall.axis];
      if (layer < 0 || layer >= kTileSide) continue;
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const NodeIndex<Dim> node = tiling.node(block, local);
        if (node[wall.axis] != wall.row) continue;
        for (int n = block.begin; n < block.end; ++n) {
          const int field = tiling.node_tiles[static_cast<std::size_t>(n)].field;
          if (state.field_rigid[static_cast<std::size_t>(field)]) continue;
          at_.emplace_back(n * kTileNodes<Dim> + local, static_cast<int>(columns_.size()));
          list_column(state, static_cast<int>(w), node, field, prescribed);
        }
      }
    }
    std::sort(at_.begin() + first_.back(), at_.end());
  }
  first_.push_back(static_cast<int>(at_.size()));
  stuck_.clear();
  list_near(state);
}

/// Rows that another condition prescribes are left to it. The last row inside may belong to one column only:
/// where another wall is as near as two cells, the rows beyond the plane are held as they are.
template <int Dim>
void SurfaceWalls<Dim>::list_column(const State<Dim>& state, int w, const NodeIndex<Dim>& node, int field,
                                    const Prescribed& prescribed) {
  using constants::conditions::kThinLayer;
  const Wall& wall = walls_[static_cast<std::size_t>(w)];
  const auto at_other = [&](const NodeIndex<Dim>& n, int axis, int margin) {
    return std::any_of(walls_.begin(), walls_.end(), [&](const Wall& other) {
      return &other != &wall && other.axis == axis && other.out * (n[axis] - other.row) >= -margin;
    });
  };
  Column& column = columns_.emplace_back();
  column.wall = w;
  column.gap = std::numeric_limits<double>::infinity();
  column.sideways = 0;
  column.touches = column.stuck = false;
  column.friction = 0;
  column.key = key_of<Dim>(w, wall.axis, node, field);
  NodeIndex<Dim> row = node;
  for (int k = 0; k < kRows; ++k) {
    row[wall.axis] = wall.row + wall.out * (k - kInside);
    const bool free = k >= kInside - (wall.cut < kThinLayer ? 2 : 1) && !prescribed(row, wall.axis) &&
                      !(k < kInside && at_other(row, wall.axis, 1));
    column.slot[static_cast<std::size_t>(k)] = free ? state.tiling.slot(row, field) : -1;
  }
  if (!(wall.friction > 0)) return;
  const auto on_line_of_other = [&](int axis) {
    return at_other(node, axis, 1) || std::any_of(walls_.begin(), walls_.end(), [&](const Wall& other) {
             return other.axis == axis && other.cut < kThinLayer &&
                    other.out * (node[axis] - other.row) >= -2;
           });
  };
  column.friction = static_cast<int>(frictions_.size());
  for (int d = 0; d < Dim; ++d)
    if (d != wall.axis && !prescribed(node, d) && !on_line_of_other(d)) {
      column.sideways |= 1u << d;
      frictions_.emplace_back();
    }
  column.stuck = std::binary_search(stuck_.begin(), stuck_.end(), column.key);
}

template <int Dim>
void SurfaceWalls<Dim>::list_near(const State<Dim>& state) {
  near_.clear();
  const auto& tiles = state.tiling.tiles;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Wall& wall = walls_[w];
    const auto begin = at_.begin() + first_[w], end = at_.begin() + first_[w + 1];
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      const ParticleTile<Dim>& tile = tiles[t];
      const int layer = wall.row - tile.window[wall.axis];
      if (layer < 0 || layer >= kWindowSide || state.field_rigid[static_cast<std::size_t>(tile.field)])
        continue;
      Near near{static_cast<int>(t), static_cast<int>(w), {}, {}};
      for (int k = 0; k < kAcross; ++k) {
        int corner = 0, local = 0, rest = k, window = 0;
        for (int d = 0, bit = 1, stride = 1, across = 1; d < Dim;
             ++d, bit *= 2, stride *= kTileSide, across *= kWindowSide) {
          const int offset = d == wall.axis ? layer : rest % kWindowSide;
          if (d != wall.axis) rest /= kWindowSide;
          corner += offset >= kTileSide ? bit : 0;
          local += offset % kTileSide * stride;
          window += offset * across;
        }
        const int slot = tile.node_slot ? tile.node_slot[window] : tile.slot[corner] + local;
        const auto found = std::lower_bound(begin, end, std::pair(slot, 0));
        near.column[static_cast<std::size_t>(k)] = found != end && found->first == slot ? found->second : -1;
      }
      near_.push_back(near);
    }
  }
}

/// The gaps of the columns that the particles of one tile are near to.
template <int Dim>
void SurfaceWalls<Dim>::measure(const State<Dim>& state, Near& near) const {
  const Wall& wall = walls_[static_cast<std::size_t>(near.wall)];
  const ParticleTile<Dim>& tile = state.tiling.tiles[static_cast<std::size_t>(near.tile)];
  const auto& particles = state.particles;
  const double inverse = state.grid.inverse_cell;
  const double* position[Dim];
  const double* deformation[Dim * Dim];
  const bool split = particles.has(Quantity::domain_share);
  const double* share[Dim];
  for (int d = 0; d < Dim; ++d) {
    position[d] = particles.column(Quantity::position, d);
    share[d] = split ? particles.column(Quantity::domain_share, d) : nullptr;
  }
  for (int e = 0; e < Dim * Dim; ++e) deformation[e] = particles.column(Quantity::deformation_gradient, e);
  near.gap.fill({});
  for (int r = tile.run_begin; r < tile.run_end; ++r) {
    const ParticleRun<Dim>& run = state.tiling.runs[static_cast<std::size_t>(r)];
    if (run.on_surface) continue;  // what is inside has the domains
    const BodyView<Dim>& body = state.bodies[static_cast<std::size_t>(run.body)];
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      const double inside =
          wall.out * (wall.plane - (position[wall.axis][p] - state.grid.origin[wall.axis]) * inverse);
      if (inside > 2 * constants::conditions::kFarGap || inside < -kRowsBeyond) continue;
      const auto extent = [&](int axis) {
        double sum = 0;
        for (int d = 0; d < Dim; ++d)
          sum += std::abs(deformation[axis * Dim + d][p]) * body.half_size[d] * (split ? share[d][p] : 1);
        return sum * inverse;
      };
      const double gap = inside - extent(wall.axis);
      if (!(gap < constants::conditions::kFarGap)) continue;
      int low[Dim], high[Dim];
      double xi[Dim], width[Dim];
      for (int d = 0; d < Dim; ++d) {
        if (d == wall.axis) continue;
        xi[d] = (position[d][p] - state.grid.origin[d]) * inverse - tile.window[d];
        width[d] = constants::conditions::kDomainWidening * extent(d);
        low[d] = std::max(0, static_cast<int>(std::floor(xi[d] - kReach)) + 1);
        high[d] = std::min(kWindowSide - 1, static_cast<int>(std::ceil(xi[d] + kReach)) - 1);
      }
      const int first = wall.axis == 0 ? 1 : 0, second = wall.axis == 2 ? 1 : 2;
      if constexpr (Dim == 2) {
        for (int i = low[first]; i <= high[first]; ++i) {
          const double t = std::abs(i - xi[first]);
          auto& least = near.gap[static_cast<std::size_t>(i)].of(t < width[first], t < 1);
          least = std::min(least, gap);
        }
      } else {
        for (int j = low[second]; j <= high[second]; ++j)
          for (int i = low[first]; i <= high[first]; ++i) {
            const double s = std::abs(i - xi[first]), t = std::abs(j - xi[second]);
            const bool over = s < width[first] && t < width[second];
            auto& least = near.gap[static_cast<std::size_t>(j * kWindowSide + i)].of(over, s < 1 && t < 1);
            least = std::min(least, gap);
          }
      }
    }
  }
}

template <int Dim>
void SurfaceWalls<Dim>::find_gaps(const State<Dim>& state) {
  const auto n = static_cast<std::int64_t>(near_.size());
  for_each_of(n, state.threads, constants::threads::kFewBusyBlocks,
              [&](std::int64_t k) { measure(state, near_[static_cast<std::size_t>(k)]); });
  for (Column& column : columns_) column.gaps = {};
  for (const Near& near : near_)
    for (std::size_t k = 0; k < kAcross; ++k) {
      if (near.column[k] < 0) continue;
      Column& column = columns_[static_cast<std::size_t>(near.column[k])];
      column.gaps.take(near.gap[k]);
    }
  for (Column& column : columns_)
    column.gap = state.grid.cell * column.gaps.least(constants::conditions::kColumnSlack);
}

template void SurfaceWalls<2>::list(const State<2>&, const Prescribed&);
template void SurfaceWalls<3>::list(const State<3>&, const Prescribed&);
template void SurfaceWalls<2>::list_near(const State<2>&);
template void SurfaceWalls<3>::list_near(const State<3>&);
template void SurfaceWalls<2>::find_gaps(const State<2>&);
template void SurfaceWalls<3>::find_gaps(const State<3>&);

}  // namespace mpmfast
