/// Interfaces on nodes (NN chapter 5): springs on what the displacements of two fields differ by.

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/contact/contact.hpp"
#include "engine/contact/nodal/bonds.hpp"
#include "engine/contact/nodal/smooth_normals.hpp"
#include "engine/state/team.hpp"
#include "kernels/contact/curved_springs.hpp"

namespace mpmfast {

/// u_b − u_a of two fields at a node, by where their displacements lead to, and turned with the material: δ =
/// F (X_a − X_b), X the places at the start of what is here now, 1 − F⁻¹ the mean slope of both. (Without F,
/// an interface that turns with its bodies would be sheared as it opens.)
template <int Dim>
Vec<Dim> Contact<Dim>::told_jump(const State<Dim>& state, const ContactNode<Dim>& node, int slot_a,
                                 int slot_b) const {
  const auto& nodes = state.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const Vec<Dim> here = node.node.template cast<double>() * state.grid.cell;
  const auto slopes = [&](int slot) {
    Mat<Dim> sum;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) sum(i, j) = nodes.column(Nodal::mass_slope, i * Dim + j)[slot];
    return sum;
  };
  const Mat<Dim> slope_a = slopes(slot_a), slope_b = slopes(slot_b);
  const Vec<Dim> u_a = (nodes.vector(Nodal::mass_offset, slot_a) + slope_a * here) / mass[slot_a],
                 u_b = (nodes.vector(Nodal::mass_offset, slot_b) + slope_b * here) / mass[slot_b];
  const Mat<Dim> back = Mat<Dim>::Identity() - (slope_a + slope_b) / (mass[slot_a] + mass[slot_b]);
  return back.inverse() * (u_b - u_a);
}

template <int Dim>
const AnyLaw& Contact<Dim>::law_of(const State<Dim>& state, const ContactNode<Dim>& node,
                                   const ContactEntry<Dim>& entry) const {
  return laws_[static_cast<std::size_t>(pair_of(state, node, entry) + 1)];
}

/// Do springs or a bond that holds act between the surfaces of an entry?
template <int Dim>
bool Contact<Dim>::is_joined(const State<Dim>& state, const ContactNode<Dim>& node,
                             const ContactEntry<Dim>& entry) const {
  const AnyLaw& law = law_of(state, node, entry);
  return joins(law) && !(std::holds_alternative<Cohesive>(law) && is_broken(entry));
}

template <int Dim>
LawScope Contact<Dim>::scope_of(const AnyLaw& law, const ContactEntry<Dim>& entry) const {
  LawScope scope{};
  std::visit([&](const auto& one) { as_it_is(entry, one, [&](const auto& now) { scope = now.scope; }); },
             law);
  return scope;
}

/// Jumps, and what surface each node has of an interface.
template <int Dim>
void Contact<Dim>::find_bridges(const State<Dim>& state) {
  if (!bridges_) return;
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
  for_each_of(n, state.threads, 64, [&](std::int64_t k) {
    const auto& node = list_.nodes[static_cast<std::size_t>(k)];
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = list_.entries[static_cast<std::size_t>(e)];
      auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
      if (entry.normal.isZero(0)) continue;
      const AnyLaw& law = law_of(state, node, entry);
      if (!joins(law)) continue;
      const int other = partner(state, node, entry);
      const auto slot_of = [&](int k) {
        return list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
      };
      const int slot_a = slot_of(entry.a), slot_b = slot_of(other);
      const double* mass = state.nodes.column(Nodal::mass);
      const double m_a = mass[slot_a], m_b = mass[slot_b];
      const bool joined = is_joined(state, node, entry), touches = scope_of(law, entry) == LawScope::contact;
      const double a = state.nodes.vector(Nodal::volume_gradient, slot_a).dot(entry.normal),
                   b = -state.nodes.vector(Nodal::volume_gradient, slot_b).dot(entry.normal);
      const double area = std::max(0.0, (m_b * a + m_a * b) / (m_a + m_b));
      if (bonds_) bond_of(entry).area = area;
      if (joined) {
        bridge.normal = entry.normal;
        // Fitted normals come and go by some degrees: across or along, springs of two stiffnesses would hold
        // more or less of a jump that stays.
        if (bridge.known) bridge.jump = turned<Dim>(bridge.jump_normal, bridge.normal, bridge.jump);
        bridge.jump_normal = bridge.normal;
        const bool integrated =
            spec_.jumps == JumpKind::integrated || (entry.crack >= 0 && cracks_.grows(entry.crack));
        bridge.recalls = bridge.known && integrated;
        bridge.told = bridge.recalls ? bridge.jump : told_jump(state, node, slot_a, slot_b);
        bridge.own_area = area;
        bridge.mean_area = 0.5 * (std::max(0.0, a) + std::max(0.0, b));
      }
      if (joined && touches)  // the gap is that of the jump
        entry.separation = bridge.known     ? bridge.jump.dot(entry.normal)
                           : state.step > 0 ? bridge.told.dot(entry.normal)
                                            : 0.0;
      // Springs reach the last node, but a field of hardly any mass is thrown by its force: see mass_screen.
      if (touches && other != node.rigid && std::min(m_a, m_b) < spec_.mass_screen * (m_a + m_b))
        entry.normal.setZero();
    }
  });
}

/// The impulses of the springs of a node in one step, as forces on its fields.
///
/// Velocities bring the jump from step to step: then springs and what strains the bodies are of one kind, and
/// no stiffness is too much. (Displacements of particles follow nodes through S and come back through S⁺, and
/// led along their slopes more than whole: springs on these alone make energy from D h = 0.15 ρ c² on.) What
/// they tell takes the place of it as the bodies move through the cells: as a mean over the nodes around,
/// which has nothing rough to grow. Positions are half a step ahead of strains: particles move with v′ Δt,
/// which F follows by halves (theory, "The energy of a contact").
///
/// Where several pairs are joined on a node, they are solved together (Gauss-Seidel): each by itself and then
/// added, they make energy where springs are stiff.
template <int Dim>
void Contact<Dim>::bridge(State<Dim>& state, double dt, const ContactNode<Dim>& node) {
  constexpr int kSweeps = 200;
  int acting = 0;
  for (int e = node.entry_begin; e < node.entry_end; ++e) acting += start_bridge(state, dt, node, e);
  if (acting == 0) return;
  auto& pulled = together_[static_cast<std::size_t>(own_number())].pulled;
  pulled.assign(static_cast<std::size_t>(node.field_end - node.field_begin), Vec<Dim>::Zero());
  for (int sweep = 0; sweep < (acting > 1 ? kSweeps : 1); ++sweep) {
    double change = 0, largest = 0;
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
      if (!bridge.acts) continue;
      auto &on_a = pulled[static_cast<std::size_t>(bridge.a)],
           &on_b = pulled[static_cast<std::size_t>(bridge.b)];
      on_a -= bridge.impulse;
      on_b += bridge.impulse;
      const Vec<Dim> others = (bridge.inverse_b * on_b - bridge.inverse_a * on_a) / dt;
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      const Vec<Dim> impulse =
          pull_of(law_of(state, node, entry), entry, bridge, node, dt, bridge.pulls + others, acting == 1);
      change = std::max(change, (impulse - bridge.impulse).squaredNorm());
      largest = std::max(largest, impulse.squaredNorm());
      bridge.impulse = impulse;
      on_a += impulse;
      on_b -= impulse;
    }
    if (change <= 1e-24 * largest) break;
  }
  auto& nodes = state.nodes;
  for (int k = 0; k < node.field_end - node.field_begin; ++k) {
    const Vec<Dim>& impulse = pulled[static_cast<std::size_t>(k)];
    if (k == node.rigid || impulse.isZero(0)) continue;
    const int slot = list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
    nodes.set(Nodal::momentum, slot, nodes.vector(Nodal::momentum, slot) + impulse);
    nodes.set(Nodal::force, slot, nodes.vector(Nodal::force, slot) + impulse / dt);
  }
}

/// What the springs of an entry begin the step with. Surfaces that are a cell apart, or have come to each
/// other from farther, are joined no more. @return whether they are
template <int Dim>
bool Contact<Dim>::start_bridge(const State<Dim>& state, double dt, const ContactNode<Dim>& node, int e) {
  const auto& nodes = state.nodes;
  const double* mass = nodes.column(Nodal::mass);
  const auto& entry = list_.entries[static_cast<std::size_t>(e)];
  auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
  if (bridge.normal.isZero(0)) return false;  // none, or they are not joined
  const auto slot_of = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].slot;
  };
  const auto free = [&](const Vec<Dim>& x) { return node.constrained ? free_part(node, x) : x; };
  bridge.a = entry.a;
  bridge.b = partner(state, node, entry);
  const int a = slot_of(bridge.a), b = slot_of(bridge.b);
  bridge.inverse_a = 1 / mass[a];
  bridge.inverse_b = bridge.b == node.rigid ? 0 : 1 / mass[b];
  bridge.pulls = free(nodes.vector(Nodal::force, b) * bridge.inverse_b -
                      nodes.vector(Nodal::force, a) * bridge.inverse_a);
  const Vec<Dim> p_a = nodes.vector(Nodal::momentum, a), p_b = nodes.vector(Nodal::momentum, b);
  bridge.rate = free(p_b / mass[b] - p_a / mass[a]) - dt * bridge.pulls;
  const BridgesAround<Dim> around = bridges_around(state, node, entry);
  const Vec<Dim> told = free(around.told) - (around.recalls ? 0 : 0.5 * dt) * bridge.rate;
  const double moved = (p_a + p_b).norm() / (mass[a] + mass[b]) * dt / cell_;
  bridge.jump = bridge.known ? Vec<Dim>(bridge.jump + std::min(1.0, moved) * (told - bridge.jump)) : told;
  const AnyLaw& law = law_of(state, node, entry);
  bridge.acts = bridge.jump.norm() < cell_;
  const double gap = std::abs(bridge.jump.dot(bridge.normal)) / cell_;
  const double area =
      bridge.own_area * std::clamp(around.mean_area / around.own_area, 1 / (1 + gap), 1 + gap);
  bridge.area = area;
  if (const auto* springs = std::get_if<Interface>(&law)) {
    bridge.springs = {springs->normal_stiffness * area, springs->compression_stiffness * area,
                      springs->shear_stiffness * area};
  } else if (const auto* bond = std::get_if<Cohesive>(&law)) {
    const double unharmed = bond->initial_stiffness * area;
    bridge.springs = {unharmed, bond->compression_stiffness * area, unharmed};
    if (!bridge.acts) let_go(*bond, bridge, bond_of(entry));
  }
  return bridge.acts;
}

/// Friction of surfaces that an entry's springs press; none where contact holds them apart.
template <int Dim>
void Contact<Dim>::apply_pressed_friction(const AnyLaw& law, Bridge<Dim>& bridge, const PairStart<Dim>& joint,
                                          double dt, bool alone, Vec<Dim>& end) const {
  bridge.friction.setZero();
  const auto slide_with = [&](const Coulomb& friction, const auto& along) {
    const double pressed = joint.mass * (end - joint.rate).dot(joint.normal) - dt * joint.along().opening;
    if (friction.friction == 0 || !(pressed > 0)) return;
    const FrictionResult<Dim> after = apply_friction(friction, pressed, along, joint, dt, alone);
    end = end.dot(joint.normal) * joint.normal + after.rate;
    bridge.friction = after.impulse;
  };
  const auto springs_press = [](const auto& springs) { return springs.compression == CompressionModel::spring; };
  if (const auto* springs = std::get_if<Interface>(&law)) {
    if (springs_press(*springs)) slide_with(springs->contact(), SlipSpring{bridge.springs.shear});
  } else if (const auto* curves = std::get_if<NonlinearInterface>(&law)) {
    if (springs_press(*curves)) slide_with(curves->contact(), CurvedSlip{curves->shear_curve, bridge.area});
  }
}

/// The impulse of an entry's springs, or of its bond, on its field a, N s.
/// @param pulls  what all others change of v_b − v_a, m/s²
template <int Dim>
Vec<Dim> Contact<Dim>::pull_of(const AnyLaw& law, const ContactEntry<Dim>& entry, Bridge<Dim>& bridge,
                               const ContactNode<Dim>& node, double dt, const Vec<Dim>& pulls,
                               bool alone) const {
  const double reduced = 1 / (bridge.inverse_a + bridge.inverse_b);
  const PairStart<Dim> joint{reduced, bridge.normal, bridge.jump, bridge.rate, reduced * pulls};
  Vec<Dim> end;
  if (const auto* curves = std::get_if<NonlinearInterface>(&law)) {
    end = rate_after_curves(curves->normal_curve, curves->shear_curve, bridge.area, joint, dt, alone);
  } else if (const auto* glue = std::get_if<Cohesive>(&law)) {
    const Bond<Dim>& bond = bond_of(entry);
    const BondStart<Dim> start{*glue, glue->integrity_of(bond.way), bridge.springs.tension,
                               bridge.springs.compression, joint};
    end = bond.follows() ? rate_with(start, start.integrity, dt) : rate_after_bond(start, dt);
  } else {
    end = rate_after(bridge.springs, joint, dt, alone);
  }
  apply_pressed_friction(law, bridge, joint, dt, alone, end);
  const Vec<Dim> impulse = reduced * (bridge.rate + dt * pulls - end);
  return node.constrained ? free_part(node, impulse) : impulse;
}

/// What the springs of an entry hold, J.
template <int Dim>
double Contact<Dim>::stored_of(const AnyLaw& law, const ContactEntry<Dim>& entry) const {
  const Bridge<Dim>& bridge = bridge_of(entry);
  const double gap = bridge.jump.dot(bridge.normal);
  const double slip = (bridge.jump - gap * bridge.normal).squaredNorm();
  if (const auto* curves = std::get_if<NonlinearInterface>(&law))
    return bridge.area * (curves->normal_curve.energy(gap) + curves->shear_curve.energy(std::sqrt(slip)));
  const auto* glue = std::get_if<Cohesive>(&law);
  const double left = glue ? glue->integrity_of(bond_of(entry).way) : 1;
  return 0.5 * ((gap > 0 ? left * bridge.springs.tension : bridge.springs.compression) * gap * gap +
                left * bridge.springs.shear * slip);
}

/// The jumps at the end of the step, with the velocities that its strains end with, and what the springs
/// hold.
template <int Dim>
void Contact<Dim>::end_bridges(const State<Dim>& state, double dt) {
  auto& motion = together_.front().motion;
  for (const auto& node : list_.nodes) {
    if (!is_bridged(node)) continue;
    read_motion(state, node, motion);
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
      if (!bridge.acts) continue;
      const Vec<Dim> from = bridge.jump, mean = 0.5 * (bridge.rate - slip_of(node, entry, motion));
      bridge.jump += dt * mean;
      bridge.friction_work = bridge.friction.dot(mean);
      if (const auto* law = bonds_ ? std::get_if<Cohesive>(&law_of(state, node, entry)) : nullptr)
        if (!bond_of(entry).follows()) end_bond(*law, from, bridge, bond_of(entry));
    }
  }
  if (bonds_) carry_bonds(state, dt);
  books_.stored = books_.lost = 0;
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      auto& bridge = list_.bridges[static_cast<std::size_t>(e)];
      if (bonds_) books_.lost += bond_of(entry).lost;
      bridge.known = bridge.acts;
      if (!bridge.acts) continue;
      books_.stored += stored_of(law_of(state, node, entry), entry);
    }
}

/// The entry of the same two fields at one of the 3^Dim places around a node (itself in the middle).
template <int Dim>
const ContactEntry<Dim>* Contact<Dim>::same_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                                                 const ContactEntry<Dim>& entry, int place) const {
  const auto field = [&](const ContactNode<Dim>& at, int k) {
    return list_.fields[static_cast<std::size_t>(at.field_begin + k)].field;
  };
  const int k = contact_neighbour(state.tiling, list_, node, place);
  if (k < 0) return nullptr;
  const auto& other = list_.nodes[static_cast<std::size_t>(k)];
  for (int e = other.entry_begin; e < other.entry_end; ++e) {
    const auto& beside = list_.entries[static_cast<std::size_t>(e)];
    if (beside.crack != entry.crack) continue;
    const bool same = entry.crack >= 0 ? beside.beyond == entry.beyond
                                       : field(other, beside.a) == field(node, entry.a) &&
                                             field(other, partner(state, other, beside)) ==
                                                 field(node, partner(state, node, entry));
    if (same) return &beside;
  }
  return nullptr;
}

/// What an interface has on the nodes around one, itself among them: areas, and the mean of the jumps, of
/// those that recall it where there are such.
///
/// The node's share of the surface between the two is what the lighter side has there, whose stress ends on
/// it (N20's area, g·n), mixed as (m_b g_a − m_a g_b)·n/(m_a + m_b). A field of hardly any mass that gets
/// more or less than its stress carries is thrown, or loses that stress. Where a gap δ lies between the
/// sides, or they overlap, each has its surface at a place of its own, and the nodes around share up to |δ|/h
/// more or less than their mean: that is evened out, no more, so that a body which ends before the other gets
/// no surface for it.
template <int Dim>
BridgesAround<Dim> Contact<Dim>::bridges_around(const State<Dim>& state, const ContactNode<Dim>& node,
                                                const ContactEntry<Dim>& entry) const {
  BridgesAround<Dim> sum;
  Vec<Dim> recalled = Vec<Dim>::Zero();
  double recalling = 0;
  for (int m = 0; m < power(3, Dim); ++m)
    if (const auto* beside = same_pair(state, node, entry, m)) {
      const Bridge<Dim>& bridge = bridge_of(*beside);
      sum.own_area += bridge.own_area;
      sum.mean_area += bridge.mean_area;
      sum.told += bridge.own_area * bridge.told;
      if (!bridge.recalls) continue;
      recalling += bridge.own_area;
      recalled += bridge.own_area * bridge.told;
    }
  if (!(sum.own_area > 0)) return {bridge_of(entry).told, 1, 1, bridge_of(entry).recalls};  // no springs
  sum.recalls = recalling > 0;
  sum.told = sum.recalls ? Vec<Dim>(recalled / recalling) : Vec<Dim>(sum.told / sum.own_area);
  return sum;
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
