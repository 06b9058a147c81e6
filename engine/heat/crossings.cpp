/// Heat between bodies: what touches, ties, friction, and what crosses a surface.

#include <algorithm>
#include <cmath>

#include "engine/constants.hpp"
#include "engine/contact/pairs/neighbours.hpp"
#include "engine/heat/heat.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

/// What touches, on how much of a surface, and how much the temperatures there differ by. The area of a node
/// is that of the side of less mass, as interfaces have it (Interfaces::find_pair).
template <int Dim>
void Heat<Dim>::find_crossings(const State<Dim>& state, const Contact<Dim>& contact) {
  const auto& list = contact.list();
  const PairColumns<Dim>& pairs = list.pairs;
  crossings_.assign(pairs.size(), {});
  const auto& nodes = state.nodes;
  const double *mass = nodes.column(Nodal::mass), *temperature = nodes.column(Nodal::temperature);
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  for_each_of(n, state.threads, constants::threads::kFewSolved, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    const NodeFields<Dim> fields(state, list, node);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      const PairGeometry<Dim>& geometry = pairs.geometry[e];
      Crossing& crossing = crossings_[static_cast<std::size_t>(e)];
      const LawScope scope = scope_of(contact.laws().law_of(fields, node, pair), pairs.is_broken(e));
      if (scope == LawScope::nowhere) continue;
      const int other = partner(fields, node, pair);
      crossing.a = fields.slot(pair.a);
      crossing.b = fields.slot(other);
      crossing.field_a = static_cast<std::size_t>(fields.field(pair.a));
      crossing.field_b = static_cast<std::size_t>(fields.field(other));
      crossing.tied = scope == LawScope::everywhere;
      if (crossing.tied || geometry.normal.isZero(0) || !nodes.has(Nodal::volume_gradient)) continue;
      const double share = share_of(state, contact, node, e);
      if (share == 0) continue;
      const ConductanceSpec& surface = contact.conductance_of(fields, node, pair);
      const bool springs_act = !pairs.spring.empty() && pairs.spring[e].acts;
      const bool touches = springs_act || pairs.status[e].touching ||
                           geometry.separation < constants::heat::kTouchingGap * state.grid.cell;
      const double gap = std::max(0.0, geometry.separation);
      if (touches) {
        crossing.conductance = capped(surface.touching);
      } else if (surface.gap > 0 && gap < state.grid.cell) {
        crossing.conductance = 1 / (1 / surface.touching + gap / surface.gap);  // resistances in series
      }
      const double a = nodes.vector(Nodal::volume_gradient, crossing.a).dot(geometry.normal),
                   b = -nodes.vector(Nodal::volume_gradient, crossing.b).dot(geometry.normal);
      const double m_a = mass[crossing.a], m_b = mass[crossing.b], wide = share * around(state, node.index);
      crossing.area = wide * std::max(0.0, (m_b * a + m_a * b) / (m_a + m_b));
      if (!touches) crossing.sides = {wide * a, wide * b};
      crossing.jump = temperature[crossing.b] - temperature[crossing.a];
    }
  });
}

/// The share of a surface that a pair stands for: none of a lumped pair whose node has explicit ones, half
/// where two lumped pairs see each other.
template <int Dim>
double Heat<Dim>::share_of(const State<Dim>& state, const Contact<Dim>& contact, const ContactNode<Dim>& node,
                           int e) const {
  if (node.explicit_begin < node.pair_end) return e < node.explicit_begin ? 0 : 1;
  const auto& pairs = contact.list().pairs.pair;
  const ContactPair& pair = pairs[e];
  if (!pair.is_lumped()) return 1;
  const NodeFields<Dim> fields(state, contact.list(), node);
  const int other = partner(fields, node, pair);
  for (int f = node.pair_begin; f < node.pair_end; ++f)
    if (f != e && pairs[f].is_lumped() && pairs[f].a == other && partner(fields, node, pairs[f]) == pair.a)
      return 0.5;
  return 1;
}

/// The jump of a surface, and what drives it: means over the nodes around, by area. Where the conductivities
/// of the two differ, so do their slopes, and led to nodes on either side of the surface their temperatures
/// differ by as much one way as the other: a jump of each node by itself would drive heat round in circles.
template <int Dim>
auto Heat<Dim>::mean_jump(const State<Dim>& state, const Contact<Dim>& contact, const ContactNode<Dim>& node,
                          std::size_t e) const -> Jump {
  const auto& list = contact.list();
  const Crossing& own = crossings_[e];
  double area = 0;
  std::array<double, 2> sides{};
  Jump sum;
  for (int m = 0; m < power(3, Dim); ++m) {
    const int k = contact_neighbour(state.tiling, list, node, m);
    if (k < 0) continue;
    const ContactNode<Dim>& other = list.nodes[k];
    for (int f = other.pair_begin; f < other.pair_end; ++f) {
      const Crossing& beside = crossings_[static_cast<std::size_t>(f)];
      if (!beside.conducts() || beside.field_a != own.field_a || beside.field_b != own.field_b) continue;
      area += beside.area;
      sum.jump += beside.area * beside.jump;
      sum.drive += beside.area * beside.drive;
      for (std::size_t k = 0; k < 2; ++k) sides[k] += beside.sides[k];
    }
  }
  // Across a gap each side has its surface at a place of its own, and some of it on nodes that are not
  // shared.
  const double wider = std::max(1.0, std::max(sides[0], sides[1]) / area);
  return {sum.jump / area, sum.drive / area, wider};
}

/// Gives what is tied on a node one value: a temperature by capacities, of flows what warms all alike.
template <int Dim>
void Heat<Dim>::tie(State<Dim>& state, const Contact<Dim>& contact, Nodal quantity) {
  const auto& list = contact.list();
  const double* capacity = state.nodes.column(Nodal::heat_capacity);
  double* value = state.nodes.column(quantity);
  const bool flow = quantity == Nodal::heat_flow;
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  for_each_of(n, state.threads, constants::threads::kFewSolved, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    // Of each group, its slots are found from its first one: nodes have few fields.
    const auto tied = [&](int s, int t) {
      for (int e = node.pair_begin; e < node.pair_end; ++e) {
        const Crossing& c = crossings_[static_cast<std::size_t>(e)];
        if (c.tied && ((c.a == s && c.b == t) || (c.a == t && c.b == s))) return true;
      }
      return false;
    };
    const int count = node.field_end - node.field_begin;
    std::vector<int>& workspace = workspaces_[static_cast<std::size_t>(thread_index())];
    workspace.resize(2 * static_cast<std::size_t>(count));
    int *const slots = workspace.data(), *const group = slots + count;
    for (int f = 0; f < count; ++f) {
      slots[f] = list.fields[node.field_begin + f].slot;
      group[f] = f;
    }
    for (int f = 0; f < count; ++f)
      for (int g = 0; g < f; ++g)
        if (group[f] != group[g] && tied(slots[f], slots[g])) {
          const int from = group[f], to = group[g];
          for (int h = 0; h < count; ++h)
            if (group[h] == from) group[h] = to;
        }
    for (int f = 0; f < count; ++f) {
      if (group[f] != f) continue;
      double all = 0, sum = 0;
      for (int g = 0; g < count; ++g)
        if (group[g] == f) {
          all += capacity[slots[g]];
          sum += flow ? value[slots[g]] : capacity[slots[g]] * value[slots[g]];
        }
      if (!(all > 0)) continue;
      for (int g = 0; g < count; ++g)
        if (group[g] == f) value[slots[g]] = flow ? capacity[slots[g]] * (sum / all) : sum / all;
    }
  });
}

/// Adds the heat of friction, shared by effusivities: two half-spaces of one temperature share it so.
/// (One thread: the ledger needs one order, and a node has little to do.)
template <int Dim>
void Heat<Dim>::add_friction_heat(State<Dim>& state, const Contact<Dim>& contact, double dt) {
  const auto& list = contact.list();
  double* flow = state.nodes.column(Nodal::heat_flow);
  for (const auto& node : list.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const Crossing& crossing = crossings_[at];
      const double work = list.pairs.impulse[at].friction_work;
      if (crossing.a < 0 || work == 0) continue;
      const double e_a = effusivity_[crossing.field_a], e_b = effusivity_[crossing.field_b];
      const bool hard_a = rigid_[crossing.field_a], hard_b = rigid_[crossing.field_b];
      const double share = e_a + e_b > 0 ? e_a / (e_a + e_b) : hard_a ? 0 : hard_b ? 1 : 0.5;
      if (!hard_a) flow[crossing.a] += share * work / dt;
      if (!hard_b) flow[crossing.b] += (1 - share) * work / dt;
      sums_.friction += (hard_a ? 0 : share * work) + (hard_b ? 0 : (1 - share) * work);
    }
}

/// Heat that crosses surfaces. The jump J of a node's temperatures follows J' = f - rJ, r = hA (1/C_a +
/// 1/C_b), while all else drives it by f; what crosses is hA times the mean of J over the step,
///   hA/r [(1 - w/x) f + w J/dt],  x = r dt,  w = 1 - exp(-x).
/// So a conductance may be as large as it likes: what crosses then is what keeps J at zero. At most half of J
/// goes in a step, with the same f/r at rest: nodes that have little of a body give back up to 2.4 times what
/// its particles took of them (theory.md, "Heat"), and would swing.
template <int Dim>
void Heat<Dim>::cross(State<Dim>& state, const Contact<Dim>& contact, double dt) {
  const auto& list = contact.list();
  const double* capacity = state.nodes.column(Nodal::heat_capacity);
  double* flow = state.nodes.column(Nodal::heat_flow);
  const auto inverse = [&](int slot, std::size_t field) { return rigid_[field] ? 0 : 1 / capacity[slot]; };
  for (Crossing& c : crossings_)
    if (c.conducts()) c.drive = inverse(c.b, c.field_b) * flow[c.b] - inverse(c.a, c.field_a) * flow[c.a];
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  for_each_of(n, state.threads, constants::threads::kFewSolved, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      Crossing& c = crossings_[static_cast<std::size_t>(e)];
      if (c.conducts()) c.mean = mean_jump(state, contact, node, static_cast<std::size_t>(e));
    }
  });
  for (const auto& node : list.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const auto at = static_cast<std::size_t>(e);
      const Crossing& c = crossings_[at];
      if (!c.conducts()) continue;
      const auto [jump, drive, wider] = c.mean;
      const double both = c.conductance * c.area * wider,
                   rate = both * (inverse(c.a, c.field_a) + inverse(c.b, c.field_b)), x = rate * dt;
      if (!(x > 0)) continue;
      const double share = shared(x);
      const double crosses = both / rate * ((1 - share / x) * drive + share * jump / dt);
      flow[c.a] += crosses;
      flow[c.b] -= crosses;
      if (rigid_[c.field_a]) sums_.rigid -= dt * crosses;
      if (rigid_[c.field_b]) sums_.rigid += dt * crosses;
    }
}

template void Heat<2>::find_crossings(const State<2>&, const Contact<2>&);
template void Heat<3>::find_crossings(const State<3>&, const Contact<3>&);
template void Heat<2>::tie(State<2>&, const Contact<2>&, Nodal);
template void Heat<3>::tie(State<3>&, const Contact<3>&, Nodal);
template void Heat<2>::add_friction_heat(State<2>&, const Contact<2>&, double);
template void Heat<3>::add_friction_heat(State<3>&, const Contact<3>&, double);
template void Heat<2>::cross(State<2>&, const Contact<2>&, double);
template void Heat<3>::cross(State<3>&, const Contact<3>&, double);

}  // namespace mpmfast
