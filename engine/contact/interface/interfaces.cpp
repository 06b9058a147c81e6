#include "engine/contact/interface/interfaces.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/constants.hpp"
#include "engine/contact/interface/bond_steps.hpp"
#include "engine/contact/interface/extrapolated_jump.hpp"
#include "engine/contact/pairs/neighbours.hpp"
#include "engine/state/thread_team.hpp"
#include "kernels/contact/curved_springs.hpp"

namespace mpmfast {

namespace {

/// Adds Coulomb friction to springs in compression (NN §5.7). Where the compression model is `contact`, the
/// contact corrections have friction instead.
/// @param joint     the two fields at the start of the step
/// @param end_rate  rate of the jump at the end of the step, m/s: without friction, then with it
template <int Dim>
void add_friction(const AnyLaw& law, const PairStart<Dim>& joint, double dt, bool alone,
                  InterfaceSpring<Dim>& spring, Vec<Dim>& end_rate) {
  spring.friction.setZero();
  const auto slide_with = [&](const Coulomb& friction, const auto& tangential_spring) {
    const double normal_impulse =  // of the normal spring, positive in compression
        joint.mass * (end_rate - joint.rate).dot(joint.normal) - dt * joint.along().opening;
    if (friction.friction == 0 || !(normal_impulse > 0)) return;
    const FrictionResult<Dim> after =
        apply_friction(friction, normal_impulse, tangential_spring, joint, dt, alone);
    end_rate = end_rate.dot(joint.normal) * joint.normal + after.rate;
    spring.friction = after.impulse;
  };
  const auto springs_press = [](const auto& springs) {
    return springs.compression == CompressionModel::spring;
  };
  if (const auto* straight = std::get_if<Interface>(&law)) {
    if (springs_press(*straight)) slide_with(straight->contact(), SlipSpring{spring.stiffness.shear});
  } else if (const auto* curves = std::get_if<NonlinearInterface>(&law)) {
    if (springs_press(*curves)) slide_with(curves->contact(), CurvedSlip{curves->shear_curve, spring.area});
  }
}

/// The stored energy of the springs of a pair, J. @param bond  null: none
template <int Dim>
double stored_energy(const AnyLaw& law, const Bond<Dim>* bond, const InterfaceSpring<Dim>& spring) {
  const double gap = spring.jump.value.dot(spring.normal);
  const double slip_squared = (spring.jump.value - gap * spring.normal).squaredNorm();
  if (const auto* curves = std::get_if<NonlinearInterface>(&law))
    return spring.area *
           (curves->normal_curve.energy(gap) + curves->shear_curve.energy(std::sqrt(slip_squared)));
  const auto* cohesive = std::get_if<Cohesive>(&law);
  const double integrity = cohesive ? cohesive->integrity_of(bond->damage) : 1;
  return 0.5 * ((gap > 0 ? integrity * spring.stiffness.tension : spring.stiffness.compression) * gap * gap +
                integrity * spring.stiffness.shear * slip_squared);
}

}  // namespace

template <int Dim>
Interfaces<Dim>::Interfaces(const Scene& scene, const Plan& plan, const PairLaws& laws,
                            const Cracks<Dim>& cracks)
    : spec_(scene.contact),
      laws_(laws),
      cracks_(cracks),
      active_(plan.interface_springs),
      bonds_active_(plan.interface_springs &&
                    laws.any([](const AnyLaw& law) { return std::holds_alternative<Cohesive>(law); })),
      bonds_(scene, laws, cracks),
      impulses_(static_cast<std::size_t>(omp_get_max_threads())) {}

template <int Dim>
void Interfaces<Dim>::find(const State<Dim>& state, ContactList<Dim>& list) const {
  using constants::threads::kFewSolved;
  if (!active_) return;
  if (bonds_active_) bonds_.find(state, list);
  for_each_of(static_cast<std::int64_t>(list.nodes.size()), state.threads, kFewSolved, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list.nodes[k];
    for (int e = node.pair_begin; e < node.pair_end; ++e) find_pair(state, node, e, list);
  });
  if (bonds_active_) bonds_.find_followers(state, list);
}

/// Finds the jump and the surface of a pair whose law has springs.
///
/// The node's share of the surface is (m_b A_a + m_a A_b)/(m_a + m_b) with A_a = g_a·n and A_b = −g_b·n,
/// where g is Σ_p V_p ∇S_ip (N20's area). The lighter field counts most, since its stress ends on the
/// surface. On a nearly massless field, springs that carry another force than its stress would accelerate it
/// without bound.
template <int Dim>
void Interfaces<Dim>::find_pair(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                                ContactList<Dim>& list) const {
  PairColumns<Dim>& pairs = list.pairs;
  const ContactPair& pair = pairs.pair[e];
  PairGeometry<Dim>& geometry = pairs.geometry[e];
  if (geometry.normal.isZero(0)) return;
  const NodeFields<Dim> fields(state, list, node);
  const AnyLaw& law = laws_.law_of(fields, node, pair);
  if (!has_springs(law)) return;
  const int other = partner(fields, node, pair);
  const double m_a = fields.mass(pair.a), m_b = fields.mass(other);
  const bool broken = pairs.is_broken(e),
             has_springs_left = !(std::holds_alternative<Cohesive>(law) && broken),
             in_contact = scope_of(law, broken) == LawScope::contact;
  const double area_a = fields.vector(Nodal::volume_gradient, pair.a).dot(geometry.normal),
               area_b = -fields.vector(Nodal::volume_gradient, other).dot(geometry.normal);
  const double area = std::max(0.0, (m_b * area_a + m_a * area_b) / (m_a + m_b));
  if (bonds_active_) pairs.bond[e].area = area;
  InterfaceSpring<Dim>& spring = pairs.spring[e];
  DisplacementJump<Dim>& jump = spring.jump;
  if (has_springs_left) {
    spring.normal = geometry.normal;
    // Fitted normals vary by some degrees from step to step. The jump turns with them, which keeps its normal
    // and tangential parts.
    if (jump.known) jump.value = turned<Dim>(jump.normal, spring.normal, jump.value);
    jump.normal = spring.normal;
    const bool integrates =
        spec_.jumps == JumpKind::integrated || (pair.crack >= 0 && cracks_.grows(pair.crack));
    jump.integrated = jump.known && integrates;
    jump.extrapolated = jump.integrated ? jump.value : extrapolated_jump(state, fields, node, pair.a, other);
    spring.own_area = area;
    spring.mean_area = 0.5 * (std::max(0.0, area_a) + std::max(0.0, area_b));
  }
  // The gap is the normal part of the jump. Surfaces touch at the start of the run.
  if (has_springs_left && in_contact)
    geometry.separation = jump.known       ? jump.value.dot(geometry.normal)
                          : state.step > 0 ? jump.extrapolated.dot(geometry.normal)
                                           : 0.0;
  // Springs act on fields of any mass. Contact would accelerate a nearly massless field without bound.
  if (in_contact && other != node.rigid && std::min(m_a, m_b) < spec_.mass_screen * (m_a + m_b))
    geometry.normal.setZero();
}

/// The jump is integrated from nodal velocities, as the strains are, so that any stiffness is stable.
/// (Springs on extrapolated displacements of particles alone add energy from D h = 0.15 ρ c² on, since
/// particles follow nodes through S and return through S⁺.) The extrapolated jump, a mean over the nodes
/// around, slowly replaces the integrated one as the bodies move through the cells.
///
/// Several springs of a node are solved together by Gauss–Seidel: the sum of separate solutions of stiff
/// springs adds energy.
template <int Dim>
void Interfaces<Dim>::apply(State<Dim>& state, const ContactNode<Dim>& node, const FreeDirections<Dim>& free,
                            double dt, ContactList<Dim>& list) {
  int acting = 0;
  for (int e = node.pair_begin; e < node.pair_end; ++e) acting += start(state, node, e, free, dt, list);
  if (acting == 0) return;
  const NodeFields<Dim> fields(state, list, node);
  std::vector<Vec<Dim>>& impulses = impulses_[static_cast<std::size_t>(thread_index())];
  impulses.assign(static_cast<std::size_t>(fields.count()), Vec<Dim>::Zero());
  solve_node(fields, node, acting, free, dt, list, impulses);
  for (int k = 0; k < fields.count(); ++k) {
    const Vec<Dim>& impulse = impulses[static_cast<std::size_t>(k)];
    if (k == node.rigid || impulse.isZero(0)) continue;
    const int slot = fields.slot(k);
    state.nodes.set(Nodal::momentum, slot, fields.vector(Nodal::momentum, k) + impulse);
    state.nodes.set(Nodal::force, slot, fields.vector(Nodal::force, k) + impulse / dt);
  }
}

/// The impulses of the springs of a node. @param impulses  result, by field, N s
template <int Dim>
void Interfaces<Dim>::solve_node(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, int acting,
                                 const FreeDirections<Dim>& free, double dt, ContactList<Dim>& list,
                                 std::vector<Vec<Dim>>& impulses) const {
  PairColumns<Dim>& pairs = list.pairs;
  for (int sweep = 0; sweep < (acting > 1 ? constants::contact::kSpringSweeps : 1); ++sweep) {
    double change = 0, largest = 0;
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      InterfaceSpring<Dim>& spring = pairs.spring[e];
      if (!spring.acts) continue;
      const SpringEnds<Dim>& ends = spring.ends;
      Vec<Dim>& on_a = impulses[static_cast<std::size_t>(ends.a)];
      Vec<Dim>& on_b = impulses[static_cast<std::size_t>(ends.b)];
      on_a -= spring.impulse;
      on_b += spring.impulse;
      const Vec<Dim> others = (ends.inverse_b * on_b - ends.inverse_a * on_a) / dt;
      const AnyLaw& law = laws_.law_of(fields, node, pairs.pair[e]);
      const Bond<Dim>* bond = bonds_active_ ? &pairs.bond[e] : nullptr;
      const Vec<Dim> impulse =
          free.part(node, impulse_of(law, bond, ends.external + others, dt, acting == 1, spring));
      change = std::max(change, (impulse - spring.impulse).squaredNorm());
      largest = std::max(largest, impulse.squaredNorm());
      spring.impulse = impulse;
      on_a += impulse;
      on_b -= impulse;
    }
    if (change <= constants::contact::kSpringTolerance * largest) break;
  }
}

/// Sets the state of a pair's springs at the start of the step. A spring whose jump exceeds a cell is
/// dropped; a bond breaks. @return whether the springs act
template <int Dim>
bool Interfaces<Dim>::start(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                            const FreeDirections<Dim>& free, double dt, ContactList<Dim>& list) const {
  InterfaceSpring<Dim>& spring = list.pairs.spring[e];
  if (spring.normal.isZero(0)) return false;  // no springs, or none left
  const NodeFields<Dim> fields(state, list, node);
  const ContactPair& pair = list.pairs.pair[e];
  SpringEnds<Dim>& ends = spring.ends;
  ends.a = pair.a;
  ends.b = partner(fields, node, pair);
  const double m_a = fields.mass(ends.a), m_b = fields.mass(ends.b);
  ends.inverse_a = 1 / m_a;
  ends.inverse_b = ends.b == node.rigid ? 0 : 1 / m_b;
  ends.external = free.part(node, fields.vector(Nodal::force, ends.b) * ends.inverse_b -
                                      fields.vector(Nodal::force, ends.a) * ends.inverse_a);
  const Vec<Dim> p_a = fields.vector(Nodal::momentum, ends.a), p_b = fields.vector(Nodal::momentum, ends.b);
  ends.rate = free.part(node, p_b / m_b - p_a / m_a) - dt * ends.external;
  const InterfaceAround<Dim> around = sum_around(state, node, e, list);
  DisplacementJump<Dim>& jump = spring.jump;
  // Positions lead strains by half a step, so the extrapolated jump is reduced by ½ Δt v.
  const Vec<Dim> extrapolated = free.part(node, around.jump) - (around.integrated ? 0 : 0.5 * dt) * ends.rate;
  const double moved_cells = (p_a + p_b).norm() / (m_a + m_b) * dt / state.grid.cell;
  jump.value = jump.known ? Vec<Dim>(jump.value + std::min(1.0, moved_cells) * (extrapolated - jump.value))
                          : extrapolated;
  spring.acts = jump.value.norm() < state.grid.cell;
  const double gap_cells = std::abs(jump.value.dot(spring.normal)) / state.grid.cell;
  const double area =
      spring.own_area * std::clamp(around.mean_area / around.own_area, 1 / (1 + gap_cells), 1 + gap_cells);
  spring.area = area;
  const AnyLaw& law = laws_.law_of(fields, node, pair);
  if (const auto* straight = std::get_if<Interface>(&law)) {
    spring.stiffness = {straight->normal_stiffness * area, straight->compression_stiffness * area,
                        straight->shear_stiffness * area};
  } else if (const auto* cohesive = std::get_if<Cohesive>(&law)) {
    const double undamaged = cohesive->initial_stiffness * area;
    spring.stiffness = {undamaged, cohesive->compression_stiffness * area, undamaged};
    if (!spring.acts) break_bond(*cohesive, spring, list.pairs.bond[e]);
  }
  return spring.acts;
}

/// The impulse of the springs or the bond of a pair on its field a, N s. Sets the friction of the springs.
/// @param external  change of v_b − v_a by all other forces, m/s²
template <int Dim>
Vec<Dim> Interfaces<Dim>::impulse_of(const AnyLaw& law, const Bond<Dim>* bond, const Vec<Dim>& external,
                                     double dt, bool alone, InterfaceSpring<Dim>& spring) const {
  const SpringEnds<Dim>& ends = spring.ends;
  const double reduced_mass = 1 / (ends.inverse_a + ends.inverse_b);
  const PairStart<Dim> joint{reduced_mass, spring.normal, spring.jump.value, ends.rate,
                             reduced_mass * external};
  Vec<Dim> end_rate;
  if (const auto* curves = std::get_if<NonlinearInterface>(&law)) {
    end_rate = rate_after_curves(curves->normal_curve, curves->shear_curve, spring.area, joint, dt, alone);
  } else if (const auto* cohesive = std::get_if<Cohesive>(&law)) {
    const BondStart<Dim> start{*cohesive, cohesive->integrity_of(bond->damage), spring.stiffness.tension,
                               spring.stiffness.compression, joint};
    end_rate = bond->follows() ? rate_with(start, start.integrity, dt) : rate_after_bond(start, dt);
  } else {
    end_rate = rate_after(spring.stiffness, joint, dt, alone);
  }
  add_friction(law, joint, dt, alone, spring, end_rate);
  return reduced_mass * (ends.rate + dt * external - end_rate);
}

template <int Dim>
void Interfaces<Dim>::end(const State<Dim>& state, const FreeDirections<Dim>& free, double dt,
                          ContactList<Dim>& list, ContactLedger<Dim>& ledger) {
  end_jumps(state, free, dt, list);
  if (bonds_active_) bonds_.carry(state, dt, list);
  ledger.stored = ledger.lost = 0;
  PairColumns<Dim>& pairs = list.pairs;
  for (const ContactNode<Dim>& node : list.nodes) {
    const NodeFields<Dim> fields(state, list, node);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      InterfaceSpring<Dim>& spring = pairs.spring[e];
      const Bond<Dim>* bond = bonds_active_ ? &pairs.bond[e] : nullptr;
      if (bond) ledger.lost += bond->lost;
      spring.jump.known = spring.acts;
      if (spring.acts)
        ledger.stored += stored_energy(laws_.law_of(fields, node, pairs.pair[e]), bond, spring);
    }
  }
}

/// Integrates the jumps to the end of the step, with the velocities with which its strains end, and the
/// damage.
template <int Dim>
void Interfaces<Dim>::end_jumps(const State<Dim>& state, const FreeDirections<Dim>& free, double dt,
                                ContactList<Dim>& list) {
  PairColumns<Dim>& pairs = list.pairs;
  for (const ContactNode<Dim>& node : list.nodes) {
    if (!has_springs(list, node)) continue;
    const NodeFields<Dim> fields(state, list, node);
    motion_.read(fields);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      InterfaceSpring<Dim>& spring = pairs.spring[e];
      if (!spring.acts) continue;
      const ContactPair& pair = pairs.pair[e];
      const Vec<Dim> from = spring.jump.value,
                     mean = 0.5 * (spring.ends.rate + free.part(node, motion_.relative_velocity(node, pair)));
      spring.jump.value += dt * mean;
      spring.friction_work = spring.friction.dot(mean);
      if (!bonds_active_ || pairs.bond[e].follows()) continue;
      if (const auto* law = std::get_if<Cohesive>(&laws_.law_of(fields, node, pair)))
        end_bond(*law, from, spring, pairs.bond[e]);
    }
  }
}

/// Sums the areas over a node and its neighbours, and finds their mean jump, weighted by area. If one of them
/// has an integrated jump, only integrated jumps count.
///
/// Where a gap δ lies between the sides, or they overlap, each side has its surface at a position of its own.
/// The nodes around then share up to |δ|/h more or less than their mean. So much is evened out and no more:
/// a body that ends before the other gets no surface beyond its end.
template <int Dim>
InterfaceAround<Dim> Interfaces<Dim>::sum_around(const State<Dim>& state, const ContactNode<Dim>& node, int e,
                                                 const ContactList<Dim>& list) const {
  InterfaceAround<Dim> sum;
  Vec<Dim> integrated = Vec<Dim>::Zero();
  double integrated_area = 0;
  for (int position = 0; position < power(3, Dim); ++position) {
    const int f = same_pair(state, list, node, list.pairs.pair[e], position);
    if (f < 0) continue;
    const InterfaceSpring<Dim>& spring = list.pairs.spring[f];
    sum.own_area += spring.own_area;
    sum.mean_area += spring.mean_area;
    sum.jump += spring.own_area * spring.jump.extrapolated;
    if (!spring.jump.integrated) continue;
    integrated_area += spring.own_area;
    integrated += spring.own_area * spring.jump.extrapolated;
  }
  const DisplacementJump<Dim>& own = list.pairs.spring[e].jump;
  if (!(sum.own_area > 0)) return {own.extrapolated, 1, 1, own.integrated};  // no surface: any finite ratio
  sum.integrated = integrated_area > 0;
  sum.jump = sum.integrated ? Vec<Dim>(integrated / integrated_area) : Vec<Dim>(sum.jump / sum.own_area);
  return sum;
}

template class Interfaces<2>;
template class Interfaces<3>;

}  // namespace mpmfast
