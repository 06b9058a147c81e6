#include "engine/step/conditions.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/time_table.hpp"

namespace mpmfast {

namespace {

constexpr double kRowTolerance = 1e-6;  ///< cells: a wall this close to a row of nodes lies on it

template <int Dim>
Vec<Dim> axis_vector(int axis) {
  return Vec<Dim>::Unit(axis);
}

const TimeTable& speed_table(const BoundarySpec& b) {
  return std::visit([](const auto& c) -> const TimeTable& { return c.speed; }, b.condition);
}

}  // namespace

template <int Dim>
Conditions<Dim>::Conditions(const Scene& scene) : scene_(&scene) {
  const auto n = scene.boundaries.size();
  speed_.assign(n, 0);
  row_.assign(n, 0);
  force_.assign(n, Vec<Dim>::Zero());
  for (std::size_t b = 0; b < n; ++b) {
    fastest_ = std::max(fastest_, largest(speed_table(scene.boundaries[b])));
    const int index = static_cast<int>(b);
    if (const auto* wall = std::get_if<WallSpec>(&scene.boundaries[b].condition)) {
      components_.push_back({index, axis_vector<Dim>(wall->axis), true});
      for (int d = 0; d < Dim; ++d)
        if (wall->held && d != wall->axis) components_.push_back({index, axis_vector<Dim>(d), false});
    } else {
      const auto& box = std::get<VelocityBoxSpec>(scene.boundaries[b].condition);
      Vec<Dim> direction;
      for (int d = 0; d < Dim; ++d) direction[d] = box.direction[static_cast<std::size_t>(d)];
      components_.push_back({index, direction.normalized(), true});
    }
  }
}

template <int Dim>
void Conditions<Dim>::prepare(const State<Dim>& state, double t, double dt) {
  const auto& grid = scene_->grid;
  work_ = 0;
  for (std::size_t b = 0; b < scene_->boundaries.size(); ++b) {
    const auto& table = speed_table(scene_->boundaries[b]);
    speed_[b] = mean_over(table, t, dt);
    force_[b] = Vec<Dim>::Zero();
    const auto* wall = std::get_if<WallSpec>(&scene_->boundaries[b].condition);
    if (!wall) continue;
    const double plane = wall->position + integral_to(table, t);
    const double cells = (plane - grid.origin[static_cast<std::size_t>(wall->axis)]) / grid.cell;
    const int row =
        static_cast<int>(wall->upper ? std::ceil(cells - kRowTolerance) : std::floor(cells + kRowTolerance));
    stale_ |= row != row_[b];
    row_[b] = row;
  }
  if (stale_) list_nodes(state);
  stale_ = false;
  for (auto& c : combinations_) orthonormalise(c);
}

template <int Dim>
bool Conditions<Dim>::covers(std::size_t b, const NodeIndex<Dim>& node) const {
  const auto& condition = scene_->boundaries[b].condition;
  if (const auto* wall = std::get_if<WallSpec>(&condition))
    return wall->upper ? node[wall->axis] >= row_[b] : node[wall->axis] <= row_[b];
  const auto& box = std::get<VelocityBoxSpec>(condition);
  const auto& grid = scene_->grid;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double x = grid.origin[d] + node[static_cast<int>(d)] * grid.cell,
                 slack = kRowTolerance * grid.cell;
    if (x < box.lower[d] - slack || x > box.upper[d] + slack) return false;
  }
  return true;
}

template <int Dim>
void Conditions<Dim>::list_nodes(const State<Dim>& state) {
  nodes_.clear();
  combinations_.clear();
  if (components_.empty()) return;
  std::vector<int> members;
  for (const auto& stack : state.tiling.stacks)
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const NodeIndex<Dim> node = state.tiling.node(stack, local);
      members.clear();
      for (std::size_t c = 0; c < components_.size(); ++c)
        if (covers(static_cast<std::size_t>(components_[c].boundary), node))
          members.push_back(static_cast<int>(c));
      if (members.empty()) continue;
      std::size_t k = 0;
      while (k < combinations_.size() && combinations_[k].members != members) ++k;
      if (k == combinations_.size()) {
        combinations_.emplace_back();
        combinations_.back().members = members;
      }
      for (int t = stack.begin; t < stack.end; ++t)
        if (!state.field_rigid[static_cast<std::size_t>(
                state.tiling.node_tiles[static_cast<std::size_t>(t)].field)])
          nodes_.push_back({t * kTileNodes<Dim> + local, static_cast<int>(k)});
    }
}

/// Parallel conditions first add up their velocities. Then Gram–Schmidt on (n, u): e ∝ n − Σ(n·e_k)e_k with
/// the speed that v·n = u leaves along e. The unit e is used throughout (NN §2.3.2 prints it without its
/// norm).
template <int Dim>
void Conditions<Dim>::orthonormalise(Combination& c) const {
  struct Prescribed {
    Vec<Dim> direction;
    double speed;
    int boundary;
  };
  std::vector<Prescribed> distinct;
  for (int member : c.members) {
    const Component& component = components_[static_cast<std::size_t>(member)];
    const double speed = component.moving ? speed_[static_cast<std::size_t>(component.boundary)] : 0.0;
    const auto parallel = [&](const Prescribed& p) {
      return std::abs(p.direction.dot(component.direction)) > 1 - 1e-12;
    };
    const auto twin = std::find_if(distinct.begin(), distinct.end(), parallel);
    if (twin == distinct.end())
      distinct.push_back({component.direction, speed, component.boundary});
    else
      twin->speed += twin->direction.dot(component.direction) * speed;
  }
  c.count = 0;
  c.share.setZero();
  for (const Prescribed& p : distinct) {
    if (c.count == Dim) break;  // the velocity is fixed already
    Vec<Dim> rest = p.direction;
    double rest_speed = p.speed;
    for (int k = 0; k < c.count; ++k) {
      const double along = p.direction.dot(c.direction[k]);
      c.share(c.count, k) = along;
      rest -= along * c.direction[k];
      rest_speed -= along * c.speed[k];
    }
    const double length = rest.norm();
    if (length < 1e-9) continue;
    c.share(c.count, c.count) = length;
    c.pushing[c.count] = p.direction;
    c.direction[c.count] = rest / length;
    c.speed[c.count] = rest_speed / length;
    c.boundary[c.count++] = p.boundary;
  }
}

template <int Dim>
void Conditions<Dim>::impose_velocity(State<Dim>& state) const {
  for (const auto& [slot, combination] : nodes_) {
    const Combination& c = combinations_[static_cast<std::size_t>(combination)];
    if (!(state.nodes.column(Nodal::mass)[slot] > 0)) continue;
    Vec<Dim> v = state.nodes.vector(Nodal::velocity, slot);
    for (int k = 0; k < c.count; ++k) v += (c.speed[k] - v.dot(c.direction[k])) * c.direction[k];
    state.nodes.set(Nodal::velocity, slot, v);
  }
}

/// Calls change(mass, slot, direction, speed) for every constrained component; it returns the reaction along
/// it, N.
template <int Dim>
template <class Change>
void Conditions<Dim>::apply(State<Dim>& state, double dt, Change change) {
  for (const auto& [slot, combination] : nodes_) {
    const Combination& c = combinations_[static_cast<std::size_t>(combination)];
    const double mass = state.nodes.column(Nodal::mass)[slot];
    if (!(mass > 0)) continue;
    double reaction[Dim];
    for (int k = 0; k < c.count; ++k) {
      reaction[k] = change(mass, slot, c.direction[k], c.speed[k]);
      work_ += reaction[k] * c.speed[k] * dt;
    }
    // Each boundary pushes along its own direction only: R = Σ λ_k n_k with n_k = Σ_j share_kj e_j, from the
    // last on.
    for (int k = c.count - 1; k >= 0; --k) {
      const double push = reaction[k] / c.share(k, k);
      force_[static_cast<std::size_t>(c.boundary[k])] += push * c.pushing[k];
      for (int j = 0; j < k; ++j) reaction[j] -= push * c.share(k, j);
    }
  }
}

template <int Dim>
void Conditions<Dim>::react(State<Dim>& state, double dt) {
  apply(state, dt, [&](double mass, int slot, const Vec<Dim>& e, double speed) {
    const Vec<Dim> f = state.nodes.vector(Nodal::force, slot);
    const double wanted = (mass * speed - state.nodes.vector(Nodal::momentum, slot).dot(e)) / dt;
    const double reaction = wanted - f.dot(e);
    state.nodes.set(Nodal::force, slot, f + reaction * e);
    return reaction;
  });
}

template <int Dim>
void Conditions<Dim>::enforce(State<Dim>& state, double dt) {
  apply(state, dt, [&](double mass, int slot, const Vec<Dim>& e, double speed) {
    const Vec<Dim> p = state.nodes.vector(Nodal::momentum, slot);
    const double impulse = mass * speed - p.dot(e);
    state.nodes.set(Nodal::momentum, slot, p + impulse * e);
    state.nodes.set(Nodal::force, slot, state.nodes.vector(Nodal::force, slot) + (impulse / dt) * e);
    return impulse / dt;
  });
}

template class Conditions<2>;
template class Conditions<3>;

}  // namespace mpmfast
