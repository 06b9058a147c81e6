#include "engine/contact/cracks/cracks.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/scene/crack_tips.hpp"

namespace mpmfast {

template <int Dim>
Cracks<Dim>::Cracks(const Scene& scene, const Plan& plan) : scene_(&scene), first_side_(plan.first_side) {
  rooms_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  for (const CrackSpec& crack : scene.cracks) {
    const BodySpec& body = scene.bodies[static_cast<std::size_t>(crack.body)];
    CrackLine<Dim> line;
    line.field = plan.body_field[static_cast<std::size_t>(crack.body)];
    line.node_mass =
        density_of(scene.materials[static_cast<std::size_t>(body.material)]) * cell_volume(scene);
    const auto corner = [&](std::size_t k) {
      Vec<Dim> x = Vec<Dim>::Zero();
      for (int d = 0; d < 2; ++d) x[d] = crack.points[k][static_cast<std::size_t>(d)];
      return x;
    };
    line.points.push_back(corner(0));
    for (std::size_t k = 1; k < crack.points.size(); ++k) {
      const Vec<Dim> from = corner(k - 1), way = corner(k) - from;
      const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm() / crack.spacing - 1e-9)));
      for (int piece = 1; piece < pieces; ++piece)
        line.points.push_back(from + way * (static_cast<double>(piece) / pieces));
      line.points.push_back(corner(k));
    }
    line.sides = {line.points, line.points};
    lines_.push_back(line);
  }
  for (const CrackTip& tip : crack_tips(scene)) {
    const auto c = static_cast<std::size_t>(tip.crack);
    lines_[c].ends[tip.end].grows = scene.cracks[c].growth.active;
  }
}

template <int Dim>
int Cracks<Dim>::place_in_block(const NodeIndex<Dim>& node, NodeIndex<Dim>& block) {
  int local = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    block[d] = floor_div(node[d], kTileSide);
    local = local * kTileSide + (node[d] - block[d] * kTileSide);
  }
  return local;
}

template <int Dim>
const std::array<int, kTileNodes<Dim>>* Cracks<Dim>::find_block(int field,
                                                                const NodeIndex<Dim>& block) const {
  const std::uint64_t key = key_of(field, block);
  if (block_keys_.empty() || key < block_keys_.front() || key > block_keys_.back()) return nullptr;
  const auto found = std::lower_bound(block_keys_.begin(), block_keys_.end(), key);
  if (found == block_keys_.end() || *found != key) return nullptr;
  return &blocks_[static_cast<std::size_t>(found - block_keys_.begin())];
}

template <int Dim>
const CrackedNode<Dim>* Cracks<Dim>::find(int field, const NodeIndex<Dim>& node) const {
  NodeIndex<Dim> block;
  const auto local = static_cast<std::size_t>(place_in_block(node, block));
  const auto* found = find_block(field, block);
  return found && (*found)[local] >= 0 ? &nodes_[static_cast<std::size_t>((*found)[local])] : nullptr;
}

/// The nodes under the window of a tile that are seen behind cracks; @return whether there are any
template <int Dim>
bool Cracks<Dim>::find_under(const ParticleTile<Dim>& tile, WindowNodes& seen) const {
  seen.fill(nullptr);
  bool any = false;
  if (nodes_.empty() || first_side_[static_cast<std::size_t>(tile.field)] < 0) return false;
  for (int c = 0; c < kCorners<Dim>; ++c) {
    NodeIndex<Dim> block;
    int base = 0;
    for (int d = 0, stride = 1; d < Dim; ++d, stride *= kWindowSide) {
      block[d] = tile.window[d] / kTileSide + (c >> d & 1);
      base += (c >> d & 1) * kTileSide * stride;
    }
    const auto* found = find_block(tile.field, block);
    if (!found) continue;
    any = true;
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const int at = (*found)[static_cast<std::size_t>(local)];
      if (at < 0) continue;
      int w = base;
      for (int d = 0, rest = local, stride = 1; d < Dim; ++d, rest /= kTileSide, stride *= kWindowSide)
        w += rest % kTileSide * stride;
      seen[static_cast<std::size_t>(w)] = &nodes_[static_cast<std::size_t>(at)];
    }
  }
  return any;
}

template <int Dim>
std::uint64_t Cracks<Dim>::key_of(int field, const NodeIndex<Dim>& node) {
  constexpr int kBits = 20, kShift = 1 << (kBits - 1);
  auto key = static_cast<std::uint64_t>(field);
  for (int d = 0; d < Dim; ++d) key = key << kBits | static_cast<std::uint64_t>(node[d] + kShift);
  return key;
}

template <int Dim>
int Cracks<Dim>::side_of(const State<Dim>& state, int field) const {
  const int base = state.field_base[static_cast<std::size_t>(field)];
  return field == base ? 0 : field - first_side_[static_cast<std::size_t>(base)] + 1;
}

template <int Dim>
typename Cracks<Dim>::Parting Cracks<Dim>::parting(const State<Dim>& state, const NodeIndex<Dim>& node, int a,
                                                   int b, bool alone) const {
  constexpr double kLeast = 1e-3;  // of what crosses one way: a hairpin has no normal
  const int base = state.field_base[static_cast<std::size_t>(a)], side_a = side_of(state, a),
            side_b = side_of(state, b);
  const int differ = (side_a ^ side_b) == 3 && alone ? 1 : side_a ^ side_b;
  if (differ != 1 && differ != 2) return {};
  const CrackedNode<Dim>* cracked = find(base, node);
  if (!cracked) return {};
  const auto k = static_cast<std::size_t>(differ - 1);
  const double length = cracked->normal[k].norm();
  if (cracked->crack[k] < 0 || !(length > kLeast)) return {};
  const Vec<Dim> left = cracked->normal[k] / length;
  const bool from_left = (side_a & differ) == 0;
  return {cracked->crack[k], from_left ? Vec<Dim>(-left) : left, (side_a & side_b & ~differ) != 0};
}

/// Of the material beside a crack, between the nodes of a cell. @return whether there is any
template <int Dim>
bool Cracks<Dim>::velocity_at(const State<Dim>& state, int crack, int side, const Vec<Dim>& x,
                              Vec<Dim>& velocity) const {
  constexpr double kHardly = 1e-3;
  const double* mass = state.nodes.column(Nodal::mass);
  const int base = lines_[static_cast<std::size_t>(crack)].field,
            first = first_side_[static_cast<std::size_t>(base)];
  NodeIndex<Dim> low;
  Vec<Dim> share;
  for (int d = 0; d < Dim; ++d) {
    const double cells = (x[d] - state.grid.origin[d]) * state.grid.inverse_cell;
    low[d] = node_at(std::floor(cells));
    share[d] = cells - low[d];
  }
  double weight = 0;
  velocity.setZero();
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    NodeIndex<Dim> node = low;
    double w = 1;
    for (int d = 0; d < Dim; ++d) {
      node[d] += corner >> d & 1;
      w *= corner >> d & 1 ? share[d] : 1 - share[d];
    }
    const CrackedNode<Dim>* cracked = find(base, node);
    int bit = 0;  // of the sides of fields there that tells this crack's
    for (int k = 0; cracked && k < CrackedNode<Dim>::kMost; ++k)
      if (cracked->crack[static_cast<std::size_t>(k)] == crack) bit = 1 << k;
    double all = 0;
    Vec<Dim> momentum = Vec<Dim>::Zero();
    const auto add = [&](int field) {
      if (bit != 0 && ((side_of(state, field) & bit) != 0) != (side == 1)) return;
      const int slot = state.tiling.slot(node, field);
      if (slot < 0 || !(mass[slot] > 0)) return;
      all += mass[slot];
      momentum += mass[slot] * state.nodes.vector(Nodal::velocity, slot);
    };
    add(base);
    for (int f = first; f < state.fields() && state.field_base[static_cast<std::size_t>(f)] == base; ++f)
      add(f);
    // Nodes of hardly any mass are thrown.
    if (!(all > kHardly * lines_[static_cast<std::size_t>(crack)].node_mass)) continue;
    velocity += w / all * momentum;
    weight += w;
  }
  if (!(weight > 0)) return false;
  velocity /= weight;
  return true;
}

template <int Dim>
void Cracks<Dim>::move(const State<Dim>& state, double dt) {
  for (std::size_t c = 0; c < lines_.size(); ++c) {
    CrackLine<Dim>& line = lines_[c];
    for (CrackEnd& end : line.ends) end.fresh = false;
    const auto n = static_cast<std::ptrdiff_t>(line.points.size());
    for (std::size_t side = 0; side < 2; ++side) {
      auto& velocity = velocity_[side];
      auto& known = is_known_[side];
      velocity.assign(line.points.size(), Vec<Dim>::Zero());
      known.assign(line.points.size(), false);
      for (std::size_t k = 0; k < line.points.size(); ++k)
        known[k] =
            velocity_at(state, static_cast<int>(c), static_cast<int>(side), line.sides[side][k], velocity[k]);
      // Beyond the body it goes on as the last point inside.
      const auto spread = [&](std::ptrdiff_t begin, std::ptrdiff_t end, std::ptrdiff_t step) {
        for (std::ptrdiff_t k = begin + step; k != end; k += step) {
          const auto at = static_cast<std::size_t>(k), before = static_cast<std::size_t>(k - step);
          if (known[at] || !known[before]) continue;
          velocity[at] = velocity[before];
          known[at] = true;
        }
      };
      spread(0, n, 1);
      spread(n - 1, -1, -1);
    }
    for (std::size_t k = 0; k < line.points.size(); ++k)
      for (std::size_t side = 0; side < 2; ++side) {
        const auto& velocity = is_known_[side][k] ? velocity_[side][k] : velocity_[1 - side][k];
        line.sides[side][k] += dt * velocity;
        line.points[k] += 0.5 * dt * velocity;
      }
  }
}

// Here: the members that this file defines.
template class Cracks<2>;
template class Cracks<3>;

}  // namespace mpmfast
