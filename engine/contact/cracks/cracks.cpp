#include "engine/contact/cracks/cracks.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace mpmfast {

template <int Dim>
Cracks<Dim>::Cracks(const Scene& scene, const Plan& plan) : first_side_(plan.first_side) {
  rooms_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  for (const CrackSpec& crack : scene.cracks) {
    CrackLine<Dim> line{plan.body_field[static_cast<std::size_t>(crack.body)], {}};
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
    lines_.push_back(line);
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

template <int Dim>
void Cracks<Dim>::move(const State<Dim>& state, double dt) {
  const double* mass = state.nodes.column(Nodal::mass);
  for (CrackLine<Dim>& line : lines_) {
    const int first = first_side_[static_cast<std::size_t>(line.field)];
    velocity_.assign(line.points.size(), Vec<Dim>::Zero());
    is_known_.assign(line.points.size(), false);
    for (std::size_t k = 0; k < line.points.size(); ++k) {
      NodeIndex<Dim> node;
      Vec<Dim> share;
      for (int d = 0; d < Dim; ++d) {
        const double cells = (line.points[k][d] - state.grid.origin[d]) * state.grid.inverse_cell;
        node[d] = static_cast<int>(std::floor(cells));
        share[d] = cells - node[d];
      }
      double weight = 0;
      for (int corner = 0; corner < kCorners<Dim>; ++corner) {
        NodeIndex<Dim> at = node;
        double w = 1;
        for (int d = 0; d < Dim; ++d) {
          at[d] += corner >> d & 1;
          w *= corner >> d & 1 ? share[d] : 1 - share[d];
        }
        double all = 0;
        Vec<Dim> momentum = Vec<Dim>::Zero();
        const auto add = [&](int field) {
          const int slot = state.tiling.slot(at, field);
          if (slot < 0 || !(mass[slot] > 0)) return;
          all += mass[slot];
          momentum += mass[slot] * state.nodes.vector(Nodal::velocity, slot);
        };
        add(line.field);
        for (int f = first; f < state.fields() && state.field_base[static_cast<std::size_t>(f)] == line.field;
             ++f)
          add(f);
        if (!(all > 0)) continue;
        velocity_[k] += w / all * momentum;
        weight += w;
      }
      if (!(weight > 0)) continue;
      velocity_[k] /= weight;
      is_known_[k] = true;
    }
    // Beyond the body it goes on as the last point inside.
    const auto spread = [&](auto begin, auto end, auto step) {
      for (auto k = begin + step; k != end; k += step)
        if (!is_known_[static_cast<std::size_t>(k)] && is_known_[static_cast<std::size_t>(k - step)]) {
          velocity_[static_cast<std::size_t>(k)] = velocity_[static_cast<std::size_t>(k - step)];
          is_known_[static_cast<std::size_t>(k)] = true;
        }
    };
    const auto n = static_cast<std::ptrdiff_t>(line.points.size());
    spread(std::ptrdiff_t{0}, n, std::ptrdiff_t{1});
    spread(n - 1, std::ptrdiff_t{-1}, std::ptrdiff_t{-1});
    for (std::size_t k = 0; k < line.points.size(); ++k) line.points[k] += dt * velocity_[k];
  }
}

template <int Dim>
void Cracks<Dim>::visit(Archive& archive) {
  std::uint64_t count = lines_.size();
  archive.number("cracks/count", count);
  lines_.resize(count);
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const std::string name = "cracks/" + std::to_string(k);
    archive.number(name + "/field", lines_[k].field);
    std::vector<double> places;
    for (const Vec<Dim>& x : lines_[k].points) places.insert(places.end(), x.data(), x.data() + Dim);
    archive.list(name + "/points", places);
    lines_[k].points.resize(places.size() / Dim);
    for (std::size_t p = 0; p < lines_[k].points.size(); ++p)
      std::copy_n(places.data() + Dim * p, Dim, lines_[k].points[p].data());
  }
}

// Here: the members that this file defines.
template class Cracks<2>;
template class Cracks<3>;

}  // namespace mpmfast
