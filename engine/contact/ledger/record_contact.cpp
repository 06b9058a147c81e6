#include "engine/contact/ledger/record_contact.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/constants.hpp"
#include "engine/state/slots.hpp"
#include "kernels/contact/friction_cone.hpp"

namespace mpmfast {

namespace {

/// Share of a pair in sums over a node: lumped pairs count each contact from both sides.
template <int Dim>
double share_of(const ContactNode<Dim>& node, const ContactPair& pair) {
  return !pair.is_lumped() || node.rigid >= 0 ? 1.0 : 0.5;
}

/// The part of Δp_a by contact and springs that the particles keep, N s.
template <int Dim>
Vec<Dim> kept_impulse(const PairColumns<Dim>& pairs, int e) {
  const Vec<Dim> kept = pairs.impulse[e].now + pairs.impulse[e].as_force;
  return pairs.spring.empty() ? kept : Vec<Dim>(kept + pairs.spring[e].impulse);
}

template <int Dim>
void record_rigid(const State<Dim>& state, const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                  const Vec<Dim>& kept, const std::vector<Vec<Dim>>& pivots, ContactLedger<Dim>& ledger) {
  const auto f = static_cast<std::size_t>(fields.field(node.rigid));
  ledger.rigid_impulse[f] -= kept;
  ledger.rigid_work += kept.dot(fields.vector(Nodal::momentum, node.rigid)) / fields.mass(node.rigid);
  Vec<3> arm = Vec<3>::Zero(), impulse = Vec<3>::Zero();
  for (int d = 0; d < Dim; ++d) {
    arm[d] = state.grid.origin[d] + node.index[d] * state.grid.cell - pivots[f][d];
    impulse[d] = kept[d];
  }
  ledger.rigid_moment[f] -= arm.cross(impulse);
}

/// The energy that the particles lose by the friction of a pair, J (theory, "The energy of a contact").
///
/// With one active set it is the tangential impulse times the mean relative velocity in the strains of the
/// step. Where the pair sticks, the work of forces on the relative velocity that the strains lack is added.
/// Normal parts do no work. Without one active set it is the whole impulse times the remaining relative
/// velocity, since impulses that do not converge dissipate with both parts. If particles keep the first
/// correction, its work is added.
template <int Dim>
double friction_work_of(const CorrectionMethod& method, const PairColumns<Dim>& pairs, int e,
                        bool tangential) {
  const PairImpulses<Dim>& impulse = pairs.impulse[e];
  const RelativeVelocities<Dim>& relative = pairs.relative[e];
  const Vec<Dim>& normal = pairs.geometry[e].normal;
  const auto sliding_part = [&](const Vec<Dim>& x) -> Vec<Dim> {
    return tangential || method.one_set ? split(x, normal).tangential : x;
  };
  const Vec<Dim> second =
      sliding_part(impulse.second - (method.one_set ? Vec<Dim>::Zero() : impulse.as_force));
  double lost =
      method.one_set ? 0.5 * second.dot(relative.after_first + relative.end) : second.dot(relative.end);
  if (method.first_stays)
    lost += sliding_part(impulse.first)
                .dot(method.one_set ? Vec<Dim>(0.5 * (relative.start + relative.after_first))
                                    : relative.after_first);
  else if (method.holds_sticking) {
    const Vec<Dim> unseen = relative.after_second - relative.after_first;
    if (pairs.before[e].stuck) lost -= 0.5 * sliding_part(impulse.first).dot(unseen);
    if (pairs.status[e].stuck) lost -= 0.5 * sliding_part(impulse.now).dot(unseen);
  }
  return lost;
}

}  // namespace

template <int Dim>
void record_impulses(const State<Dim>& state, const PairLaws& laws, const std::vector<Vec<Dim>>& pivots,
                     const ContactList<Dim>& list, Entry entry, ContactLedger<Dim>& ledger) {
  const PairColumns<Dim>& pairs = list.pairs;
  if (laws.none_by_fields() &&
      std::find(state.field_rigid.begin(), state.field_rigid.end(), true) == state.field_rigid.end())
    return;
  for (const ContactNode<Dim>& node : list.nodes) {
    if (node.rigid < 0 && laws.none_by_fields()) continue;
    const NodeFields<Dim> fields(state, list, node);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = pairs.pair[e];
      const Vec<Dim> kept = entry == Entry::made ? kept_impulse(pairs, e) : Vec<Dim>(-kept_impulse(pairs, e));
      if (meets_rigid(node, pair)) record_rigid(state, fields, node, kept, pivots, ledger);
      if (laws.none_by_fields() || pair.crack >= 0) continue;
      const int number = laws.number_of(fields, node, pair);
      if (number < 0) continue;
      const double share = share_of(node, pair);
      ledger.pair_impulse[static_cast<std::size_t>(number)] +=
          (laws.is_first(fields, node, pair) ? share : -share) * kept;
    }
  }
}

template <int Dim>
void record_friction(const State<Dim>& state, const PairLaws& laws, const CorrectionMethod& method,
                     ContactList<Dim>& list, ContactLedger<Dim>& ledger, std::vector<double>& block_sums) {
  using constants::contact::kNodesOfSum;
  PairColumns<Dim>& pairs = list.pairs;
  const auto n = static_cast<std::int64_t>(list.nodes.size());
  block_sums.resize(static_cast<std::size_t>((n + kNodesOfSum - 1) / kNodesOfSum));
  for_each_block(n, kNodesOfSum, state.threads, [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (std::int64_t k = begin; k < end; ++k) {
      const ContactNode<Dim>& node = list.nodes[k];
      const NodeFields<Dim> fields(state, list, node);
      for (int e = node.pair_begin; e < node.pair_end; ++e) {
        const ContactPair& pair = pairs.pair[e];
        PairImpulses<Dim>& impulse = pairs.impulse[e];
        const bool springs = !pairs.spring.empty() && !pairs.spring[e].friction.isZero(0);
        impulse.friction_work = springs ? pairs.spring[e].friction_work : 0;
        if (springs || !(impulse.first.isZero(0) && impulse.second.isZero(0))) {
          const LawScope scope = scope_of(laws.law_of(fields, node, pair), pairs.is_broken(e));
          if (scope == LawScope::contact || scope == LawScope::bonded)
            impulse.friction_work +=
                share_of(node, pair) * friction_work_of(method, pairs, e, scope == LawScope::bonded);
        }
        sum += impulse.friction_work;
      }
    }
    block_sums[static_cast<std::size_t>(begin / kNodesOfSum)] = sum;
  });
  for (const double sum : block_sums) ledger.friction_work += sum;
  if (laws.count() == 0) return;
  for (const ContactNode<Dim>& node : list.nodes) {
    const NodeFields<Dim> fields(state, list, node);
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const double work = pairs.impulse[e].friction_work;
      if (work == 0) continue;
      if (const int number = laws.number_of(fields, node, pairs.pair[e]); number >= 0)
        ledger.pair_friction_work[static_cast<std::size_t>(number)] += work;
    }
  }
}

template void record_impulses(const State<2>&, const PairLaws&, const std::vector<Vec<2>>&,
                              const ContactList<2>&, Entry, ContactLedger<2>&);
template void record_impulses(const State<3>&, const PairLaws&, const std::vector<Vec<3>>&,
                              const ContactList<3>&, Entry, ContactLedger<3>&);
template void record_friction(const State<2>&, const PairLaws&, const CorrectionMethod&, ContactList<2>&,
                              ContactLedger<2>&, std::vector<double>&);
template void record_friction(const State<3>&, const PairLaws&, const CorrectionMethod&, ContactList<3>&,
                              ContactLedger<3>&, std::vector<double>&);

}  // namespace mpmfast
