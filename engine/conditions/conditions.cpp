#include "engine/conditions/conditions.hpp"

#include <algorithm>
#include <cmath>

#include "engine/conditions/wall_row.hpp"
#include "engine/constants.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

template <int Dim>
Vec<Dim> axis_vector(int axis) {
  return Vec<Dim>::Unit(axis);
}

const TimeTable& speed_table(const BoundarySpec& b) {
  return std::visit([](const auto& c) -> const TimeTable& { return c.speed; }, b.condition);
}

}  // namespace

template <int Dim>
Conditions<Dim>::Conditions(const Scene& scene) : scene_(&scene), walls_(scene) {
  const auto n = scene.boundaries.size();
  speed_.assign(n, 0);
  row_.assign(n, 0);
  cut_.assign(n, 1);
  ledger_.force.assign(n, Vec<Dim>::Zero());
  for (std::size_t b = 0; b < n; ++b) {
    const double largest_speed = largest(speed_table(scene.boundaries[b]));
    fastest_ = std::max(fastest_, largest_speed);
    moves_.push_back(largest_speed > 0);
    const int index = static_cast<int>(b);
    if (const auto* wall = std::get_if<WallSpec>(&scene.boundaries[b].condition)) {
      components_.push_back({index, axis_vector<Dim>(wall->axis), true});
      for (int d = 0; d < Dim; ++d)
        if (wall->fixed && d != wall->axis) components_.push_back({index, axis_vector<Dim>(d), false});
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
  ledger_.open();
  for (std::size_t b = 0; b < scene_->boundaries.size(); ++b) {
    const auto& table = speed_table(scene_->boundaries[b]);
    speed_[b] = mean_over(table, t, dt);
    const auto* wall = std::get_if<WallSpec>(&scene_->boundaries[b].condition);
    if (!wall) continue;
    const double plane = wall->position + integral_to(table, t);
    const double cells = (plane - grid.origin[static_cast<std::size_t>(wall->axis)]) / grid.cell;
    const WallRow at = wall_row(cells, wall->upper);
    const double cut = wall->enforcement != WallEnforcement::plane || at.cut == 1
                           ? 1
                           : std::max(thinnest_cut(scene_->method.basis), at.cut);
    stale_ |= at.row != row_[b] || (cut < 1) != (cut_[b] < 1);
    row_[b] = at.row;
    cut_[b] = cut;
  }
  if (stale_) {
    list_nodes(state);
    walls_.invalidate_nodes();  // rows that others prescribe are left to them
  }
  stale_ = false;
  for (auto& c : combinations_) orthonormalise(c);
  walls_.prepare(state, t, dt, [this](const NodeIndex<Dim>& node, int axis) {
    return std::any_of(components_.begin(), components_.end(), [&](const Component& c) {
      return c.direction[axis] != 0 && covers(static_cast<std::size_t>(c.boundary), node);
    });
  });
  walls_.decide(state);
}

template <int Dim>
bool Conditions<Dim>::covers(std::size_t b, const NodeIndex<Dim>& node) const {
  const auto& condition = scene_->boundaries[b].condition;
  if (const auto* wall = std::get_if<WallSpec>(&condition)) {
    const int beyond = (wall->upper ? 1 : -1) * (node[wall->axis] - row_[b]);
    return beyond >= (wall->enforcement == WallEnforcement::surface ? SurfaceWalls<Dim>::kRowsBeyond : 0);
  }
  const auto& box = std::get<VelocityBoxSpec>(condition);
  const auto& grid = scene_->grid;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double x = grid.origin[d] + node[static_cast<int>(d)] * grid.cell,
                 slack = constants::conditions::kRowTolerance * grid.cell;
    if (x < box.lower[d] - slack || x > box.upper[d] + slack) return false;
  }
  return true;
}

template <int Dim>
void Conditions<Dim>::components_at(const NodeIndex<Dim>& node, std::vector<int>& members) const {
  members.clear();
  for (std::size_t c = 0; c < components_.size(); ++c)
    if (covers(static_cast<std::size_t>(components_[c].boundary), node))
      members.push_back(static_cast<int>(c));
}

/// The rows around the plane of the component's wall in the column of the node, where it cuts a cell and the
/// node is beyond it.
template <int Dim>
auto Conditions<Dim>::around_plane(int component, const NodeIndex<Dim>& node) const
    -> std::optional<std::array<NodeIndex<Dim>, kRows>> {
  const auto b = static_cast<std::size_t>(components_[static_cast<std::size_t>(component)].boundary);
  const auto* wall = std::get_if<WallSpec>(&scene_->boundaries[b].condition);
  if (!wall || cut_[b] == 1) return std::nullopt;
  const int out = wall->upper ? 1 : -1;
  if (out * (node[wall->axis] - row_[b]) > kRows - 2) return std::nullopt;
  std::array<NodeIndex<Dim>, kRows> rows;
  for (int k = 0; k < kRows; ++k) {
    rows[static_cast<std::size_t>(k)] = node;
    rows[static_cast<std::size_t>(k)][wall->axis] = row_[b] + out * (k - 1);
  }
  return rows;
}

/// Whether no other component prescribes any of what this one does.
template <int Dim>
bool Conditions<Dim>::alone_along(int component, const std::vector<int>& members) const {
  const Vec<Dim>& direction = components_[static_cast<std::size_t>(component)].direction;
  return std::all_of(members.begin(), members.end(), [&](int other) {
    return other == component || components_[static_cast<std::size_t>(other)].direction.dot(direction) == 0;
  });
}

template <int Dim>
int Conditions<Dim>::combination_of(const std::vector<int>& members) {
  std::size_t k = 0;
  while (k < combinations_.size() && combinations_[k].members != members) ++k;
  if (k == combinations_.size()) combinations_.emplace_back().members = members;
  return static_cast<int>(k);
}

/// Have several fields slots on one of the rows of a column?
template <int Dim>
bool Conditions<Dim>::meet_on(const State<Dim>& state, const std::array<NodeIndex<Dim>, kRows>& rows) const {
  return std::any_of(rows.begin(), rows.end(), [&](const NodeIndex<Dim>& row) {
    int fields = 0;
    for (int field = 0; field < state.fields(); ++field) fields += state.tiling.slot(row, field) >= 0;
    return fields > 1;
  });
}

template <int Dim>
void Conditions<Dim>::list_nodes(const State<Dim>& state) {
  nodes_.clear();
  cuts_.clear();
  combinations_.clear();
  if (components_.empty()) return;
  const auto& tiling = state.tiling;
  combination_at_.assign(static_cast<std::size_t>(tiling.slots()), -1);
  std::vector<int> members, others, constrained;
  std::vector<std::pair<int, std::array<NodeIndex<Dim>, kRows>>> cut;
  for (const auto& block : tiling.node_blocks)
    for (int local = 0; local < kTileNodes<Dim>; ++local) {
      const NodeIndex<Dim> node = tiling.node(block, local);
      components_at(node, members);
      if (members.empty()) continue;
      constrained.clear();
      cut.clear();
      for (int c : members) {
        const auto rows = around_plane(c, node);
        // Bodies side by side press along the plane, where a line through rows would undo what their contact
        // settles on each: that made energy without end.
        const bool line = rows && (components_[static_cast<std::size_t>(c)].moving || !meet_on(state, *rows));
        const bool follows = line && std::all_of(rows->begin(), rows->end(), [&](const auto& row) {
                               components_at(row, others);
                               return alone_along(c, others);
                             });
        if (!follows) constrained.push_back(c);
        // A support that reaches further out has the first row beyond the plane too: one entry a column.
        if (follows && (*rows)[1] == node) cut.emplace_back(c, *rows);
      }
      const int combination = constrained.empty() ? -1 : combination_of(constrained);
      for (int t = block.begin; t < block.end; ++t) {
        const int field = tiling.node_tiles[static_cast<std::size_t>(t)].field;
        if (state.field_rigid[static_cast<std::size_t>(field)]) continue;
        if (combination >= 0) {
          nodes_.push_back({t * kTileNodes<Dim> + local, combination});
          combination_at_[static_cast<std::size_t>(nodes_.back().slot)] = combination;
        }
        for (const auto& [component, rows] : cut) {
          Cut& added = cuts_.emplace_back();
          added.component = component;
          for (std::size_t k = 0; k < kRows; ++k) added.slot[k] = tiling.slot(rows[k], field);
        }
      }
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
    bool moves;
    int boundary;
  };
  std::vector<Prescribed> distinct;
  for (int member : c.members) {
    const Component& component = components_[static_cast<std::size_t>(member)];
    const auto b = static_cast<std::size_t>(component.boundary);
    const double speed = component.moving ? speed_[b] : 0.0;
    const bool moves = component.moving && moves_[b];
    const auto parallel = [&](const Prescribed& p) {
      return std::abs(p.direction.dot(component.direction)) > 1 - constants::conditions::kParallel;
    };
    const auto twin = std::find_if(distinct.begin(), distinct.end(), parallel);
    if (twin == distinct.end())
      distinct.push_back({component.direction, speed, moves, component.boundary});
    else {
      twin->speed += twin->direction.dot(component.direction) * speed;
      twin->moves |= moves;
    }
  }
  c.count = 0;
  c.share.setZero();
  for (const Prescribed& p : distinct) {
    if (c.count == Dim) break;  // the velocity is fixed already
    Vec<Dim> rest = p.direction;
    double rest_speed = p.speed;
    bool moves = p.moves;
    for (int k = 0; k < c.count; ++k) {
      const double along = p.direction.dot(c.direction[k]);
      c.share(c.count, k) = along;
      rest -= along * c.direction[k];
      rest_speed -= along * c.speed[k];
      moves |= along != 0 && c.moves[k];
    }
    const double length = rest.norm();
    if (length < constants::conditions::kDependent) continue;
    c.share(c.count, c.count) = length;
    c.pushing[c.count] = p.direction;
    c.direction[c.count] = rest / length;
    c.speed[c.count] = rest_speed / length;
    c.moves[c.count] = moves;
    c.boundary[c.count++] = p.boundary;
  }
}

template <int Dim>
void Conditions<Dim>::impose_velocity(State<Dim>& state, Nodal velocities) {
  using constants::threads::kFewConstrained;
  if (velocities == Nodal::re_extrapolated)
    ledger_.settle(
        [&](const auto& taken) { return state.nodes.vector(velocities, taken.slot).dot(taken.direction); });
  for_each_of(static_cast<std::int64_t>(nodes_.size()), state.threads, kFewConstrained, [&](std::int64_t n) {
    const auto [slot, combination] = nodes_[static_cast<std::size_t>(n)];
    const Combination& c = combinations_[static_cast<std::size_t>(combination)];
    if (!(state.nodes.column(Nodal::mass)[slot] > 0)) return;
    Vec<Dim> v = state.nodes.vector(velocities, slot);
    for (int k = 0; k < c.count; ++k) v += (c.speed[k] - v.dot(c.direction[k])) * c.direction[k];
    state.nodes.set(velocities, slot, v);
  });
  apply_cuts(
      state, [&](int slot) { return state.nodes.vector(velocities, slot); },
      [&](int, int slot, const Vec<Dim>& e, double impulse) {
        const double mass = state.nodes.column(Nodal::mass)[slot];
        state.nodes.set(velocities, slot, state.nodes.vector(velocities, slot) + (impulse / mass) * e);
      });
  walls_.impose_velocity(state, velocities, ledger_);
}

/// On row k, at s_k = k − ξ cells from the plane, the velocity becomes u + g s_k; the slope with the least
/// Σ m (u + g s − v·e)², the smallest change in the norm of the masses, is g = Σ m s (v·e − u) / Σ m s². On
/// two rows that is the impulse of the one condition (1 − ξ) v_0 + ξ v_1 = u. Without mass inside, g = 0: the
/// nodes are held. Calls push(component, slot, direction, impulse).
template <int Dim>
template <class Velocity, class Push>
void Conditions<Dim>::apply_cuts(const State<Dim>& state, Velocity velocity, Push push) const {
  const double* mass = state.nodes.column(Nodal::mass);
  for (const Cut& cut : cuts_) {
    const Component& c = components_[static_cast<std::size_t>(cut.component)];
    const auto b = static_cast<std::size_t>(c.boundary);
    const double speed = c.moving ? speed_[b] : 0;
    double moment = 0, inertia = 0, m[kRows], s[kRows], along[kRows]{};
    for (std::size_t k = 0; k < kRows; ++k) {
      m[k] = cut.slot[k] < 0 ? 0 : mass[cut.slot[k]];
      s[k] = static_cast<double>(k) - cut_[b];
      if (!(m[k] > 0)) continue;
      along[k] = velocity(cut.slot[k]).dot(c.direction);
      moment += m[k] * s[k] * (along[k] - speed);
      inertia += m[k] * s[k] * s[k];
    }
    const double slope = m[0] > 0 ? moment / inertia : 0;
    for (std::size_t k = 0; k < kRows; ++k)
      if (m[k] > 0) push(cut.component, cut.slot[k], c.direction, m[k] * (speed + slope * s[k] - along[k]));
  }
}

template <int Dim>
void Conditions<Dim>::share_compression_weight(State<Dim>& state) const {
  const double* mass = state.nodes.column(Nodal::mass);
  double* compression_weight = state.nodes.column(Nodal::compression_weight);
  for (const Cut& cut : cuts_) {
    const auto has_mass = [&](int slot) { return slot >= 0 && mass[slot] > 0; };
    double least = 1;
    for (const int slot : cut.slot)
      if (has_mass(slot)) least = std::min(least, compression_weight[slot] / mass[slot]);
    for (const int slot : cut.slot)
      if (has_mass(slot)) compression_weight[slot] = least * mass[slot];
  }
}

template <int Dim>
void Conditions<Dim>::record_impulse(int component, double impulse, double dt) {
  const Component& c = components_[static_cast<std::size_t>(component)];
  const auto b = static_cast<std::size_t>(c.boundary);
  ledger_.force[b] += (impulse / dt) * c.direction;
  if (c.moving) ledger_.work += impulse * speed_[b];
}

/// Calls change(mass, slot, direction, speed) for every constrained component; it returns the reaction along
/// it, N.
template <int Dim>
template <class Change>
void Conditions<Dim>::apply(State<Dim>& state, double dt, Change change) {
  using constants::threads::kFewConstrained;
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  reactions_.resize(nodes_.size());
  for_each_of(static_cast<std::int64_t>(nodes_.size()), state.threads, kFewConstrained, [&](std::int64_t n) {
    const auto [slot, combination] = nodes_[static_cast<std::size_t>(n)];
    const Combination& c = combinations_[static_cast<std::size_t>(combination)];
    const double mass = state.nodes.column(Nodal::mass)[slot];
    std::array<double, Dim> reaction{};
    for (int k = 0; mass > 0 && k < c.count; ++k)
      reaction[at(k)] = change(mass, slot, c.direction[k], c.speed[k]);
    reactions_[static_cast<std::size_t>(n)] = reaction;
  });
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    auto& reaction = reactions_[n];
    if (reaction == std::array<double, Dim>{}) continue;
    const Combination& c = combinations_[static_cast<std::size_t>(nodes_[n].combination)];
    for (int k = 0; k < c.count; ++k) ledger_.work += reaction[at(k)] * c.speed[k] * dt;
    // Each boundary pushes along its own direction only: R = Σ λ_k n_k with n_k = Σ_j share_kj e_j, from the
    // last on.
    for (int k = c.count - 1; k >= 0; --k) {
      const double push = reaction[at(k)] / c.share(k, k);
      ledger_.force[static_cast<std::size_t>(c.boundary[k])] += push * c.pushing[k];
      for (int j = 0; j < k; ++j) reaction[at(j)] -= push * c.share(k, j);
    }
  }
}

/// What the particles take of v_s at nodes and planes that move (BoundaryLedger): the share s of m (u − v_s).
template <int Dim>
void Conditions<Dim>::take_shares(const State<Dim>& state, double share) {
  const double* mass = state.nodes.column(Nodal::mass);
  const auto start = [&](int slot) -> Vec<Dim> {
    return state.nodes.vector(Nodal::momentum, slot) / mass[slot];
  };
  for (const auto& [slot, combination] : nodes_) {
    const Combination& c = combinations_[static_cast<std::size_t>(combination)];
    for (int k = 0; mass[slot] > 0 && k < c.count; ++k) {
      if (!c.moves[k]) continue;
      const double v = start(slot).dot(c.direction[k]);
      ledger_.taken.push_back({slot, c.direction[k], share * mass[slot] * (c.speed[k] - v), v, c.speed[k]});
    }
  }
  apply_cuts(state, start, [&](int component, int slot, const Vec<Dim>& e, double impulse) {
    const Component& c = components_[static_cast<std::size_t>(component)];
    const auto b = static_cast<std::size_t>(c.boundary);
    if (c.moving && moves_[b])
      ledger_.taken.push_back({slot, e, share * impulse, start(slot).dot(e), speed_[b]});
  });
}

/// The strains of a step see (1 − P)v_s and (1 − P)v', P the part that the wall holds. A reaction −P(f Δt)
/// then gives the particles what is stored and the wall's work, to round-off; −P v_s beside it takes ½ m |P
/// v_s|² off in every step, most of it what particles at different distances from the wall differ by. To
/// leave it out for good leaves an approach in the particles that the grid never sees; a small share ends
/// that.
template <int Dim>
void Conditions<Dim>::react(State<Dim>& state, double dt, double share) {
  gives_back_ = share < 1;
  if (fastest_ > 0) take_shares(state, share);
  apply(state, dt, [&](double mass, int slot, const Vec<Dim>& e, double speed) {
    const Vec<Dim> f = state.nodes.vector(Nodal::force, slot), p = state.nodes.vector(Nodal::momentum, slot);
    const double wanted = mass * speed - p.dot(e);
    const double reaction = share * wanted / dt - f.dot(e);
    state.nodes.set(Nodal::force, slot, f + reaction * e);
    if (share < 1) state.nodes.set(Nodal::momentum, slot, p + (1 - share) * wanted * e);
    return reaction;
  });
  const auto start_velocity = [&](int slot) -> Vec<Dim> {
    return state.nodes.vector(Nodal::momentum, slot) / state.nodes.column(Nodal::mass)[slot];
  };
  if (share < 1)
    apply_cuts(state, start_velocity, [&](int, int slot, const Vec<Dim>& e, double impulse) {
      state.nodes.set(Nodal::momentum, slot,
                      state.nodes.vector(Nodal::momentum, slot) + (1 - share) * impulse * e);
    });
  const auto free_velocity = [&](int slot) -> Vec<Dim> {
    return (state.nodes.vector(Nodal::momentum, slot) + dt * state.nodes.vector(Nodal::force, slot)) /
           state.nodes.column(Nodal::mass)[slot];
  };
  apply_cuts(state, free_velocity, [&](int component, int slot, const Vec<Dim>& e, double impulse) {
    state.nodes.set(Nodal::force, slot, state.nodes.vector(Nodal::force, slot) + (impulse / dt) * e);
    record_impulse(component, impulse, dt);
  });
  walls_.react(state, dt, ledger_);
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
  const auto velocity = [&](int slot) -> Vec<Dim> {
    return state.nodes.vector(Nodal::momentum, slot) / state.nodes.column(Nodal::mass)[slot];
  };
  apply_cuts(state, velocity, [&](int component, int slot, const Vec<Dim>& e, double impulse) {
    state.nodes.set(Nodal::momentum, slot, state.nodes.vector(Nodal::momentum, slot) + impulse * e);
    state.nodes.set(Nodal::force, slot, state.nodes.vector(Nodal::force, slot) + (impulse / dt) * e);
    record_impulse(component, impulse, dt);
  });
  walls_.enforce(state, dt, ledger_);
  if (gives_back_) return;
  // v′ without what the particles' weights smooth: v_s + a Δt.
  ledger_.settle([&](const auto& taken) {
    const double mass = state.nodes.column(Nodal::mass)[taken.slot];
    return taken.start + dt / mass * state.nodes.vector(Nodal::force, taken.slot).dot(taken.direction);
  });
}

template <int Dim>
void Conditions<Dim>::hold_order(State<Dim>& state, double dt, bool last) {
  const auto velocity = [&](int slot) -> Vec<Dim> { return state.nodes.vector(Nodal::star, slot); };
  apply(state, dt, [&](double mass, int slot, const Vec<Dim>& e, double speed) {
    const double change = speed - velocity(slot).dot(e);
    state.nodes.set(Nodal::star, slot, velocity(slot) + change * e);
    return last ? mass * change / dt : 0;
  });
  const double* masses = state.nodes.column(Nodal::mass);
  apply_cuts(state, velocity, [&](int component, int slot, const Vec<Dim>& e, double impulse) {
    state.nodes.set(Nodal::star, slot, velocity(slot) + (impulse / masses[slot]) * e);
    if (last) record_impulse(component, impulse, dt);
  });
}

template class Conditions<2>;
template class Conditions<3>;

}  // namespace mpmfast
