/// What contact did in a step: friction work, and the impulses, moments and work of rigid bodies and pairs.

#include <Eigen/Geometry>

#include "engine/contact/contact.hpp"
#include "engine/state/slots.hpp"

namespace mpmfast {

template <int Dim>
void Contact<Dim>::open_books(const std::vector<Vec<Dim>>& pivots) {
  pivots_ = pivots;
  books_.open(pivots.size(), laws_.size() - 1);
}

/// Adds up, in a fixed order, what the particles will keep of a correction.
template <int Dim>
void Contact<Dim>::book(const State<Dim>& state) {
  for (const auto& node : list_.nodes) {
    if (node.rigid < 0 && pairs_.empty()) continue;
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      // In a lump, each touching pair is seen from both sides.
      const double share = entry.b >= 0 || node.rigid >= 0 ? 1.0 : 0.5;
      if (node.rigid >= 0 && (entry.b < 0 || entry.b == node.rigid)) book_rigid(state, node, entry);
      if (!pairs_.empty()) book_pair(state, node, entry, share);
    }
  }
}

/// What the particles lose by sliding, J: the tangential impulse on the mean of the slips that the strains of
/// the step see, and what forces do to slips that strains do not see because the pair sticks. (Normal parts
/// do no work: tools/manual/theory.md, "The energy of a contact".) Where each correction finds its pairs by
/// itself, on the slip that is left: impulses of many fields that jam and do not settle take energy with both
/// parts. Particles that keep the first correction lose by that too.
template <int Dim>
double Contact<Dim>::friction_work_of(const ContactEntry<Dim>& entry, bool tangential) const {
  const auto sliding_part = [&](const Vec<Dim>& x) -> Vec<Dim> {
    return tangential || one_set_ ? Vec<Dim>(x - x.dot(entry.normal) * entry.normal) : x;
  };
  const Vec<Dim> second = sliding_part(entry.second - (one_set_ ? Vec<Dim>::Zero() : entry.passed));
  double gain = one_set_ ? 0.5 * second.dot(entry.slip_held + entry.slip_end) : second.dot(entry.slip_end);
  if (first_correction_stays_)
    gain += sliding_part(entry.first)
                .dot(one_set_ ? Vec<Dim>(0.5 * (entry.slip_start + entry.slip_held)) : entry.slip_held);
  else if (holds_sticking_) {
    const Vec<Dim> unseen = entry.slip_pulled - entry.slip_held;
    if (entry.stuck_before) gain -= 0.5 * sliding_part(entry.first).dot(unseen);
    if (entry.stuck) gain -= 0.5 * sliding_part(entry.impulse).dot(unseen);
  }
  return -gain;
}

/// The friction work of each entry, and its sum in an order that does not depend on the threads.
template <int Dim>
void Contact<Dim>::book_friction(const State<Dim>& state) {
  constexpr std::int64_t kNodes = 64;  // whose work makes one sum
  const auto n = static_cast<std::int64_t>(list_.nodes.size());
  friction_sums_.resize(static_cast<std::size_t>((n + kNodes - 1) / kNodes));
  for_each_block(n, kNodes, state.threads, [&](std::int64_t begin, std::int64_t end) {
    double sum = 0;
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const auto& node = list_.nodes[k];
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = list_.entries[static_cast<std::size_t>(e)];
        const bool springs = bridges_ && !bridge_of(entry).friction.isZero(0);
        entry.friction_work = springs ? bridge_of(entry).friction_work : 0;
        if (springs || !(entry.first.isZero(0) && entry.second.isZero(0))) {
          const int law = pair_of(state, node, entry);
          const LawScope scope = scope_of(laws_[static_cast<std::size_t>(law + 1)], entry);
          if (scope == LawScope::contact || scope == LawScope::bonded) {
            // In a lump, each touching pair is seen from both sides.
            const double share = entry.b >= 0 || node.rigid >= 0 ? 1.0 : 0.5;
            entry.friction_work += share * friction_work_of(entry, scope == LawScope::bonded);
          }
        }
        sum += entry.friction_work;
      }
    }
    friction_sums_[static_cast<std::size_t>(begin / kNodes)] = sum;
  });
  for (const double sum : friction_sums_) books_.friction_work += sum;
  if (pairs_.empty() && !cracks_.active()) return;
  for (const auto& node : list_.nodes)
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      const auto& entry = list_.entries[static_cast<std::size_t>(e)];
      if (entry.friction_work == 0) continue;
      if (const int law = pair_of(state, node, entry); law >= 0)
        books_.pair_friction_work[static_cast<std::size_t>(law)] += entry.friction_work;
    }
}

/// Δp_a that the particles keep: of contact and of springs.
template <int Dim>
Vec<Dim> Contact<Dim>::kept_of(const ContactEntry<Dim>& entry) const {
  const Vec<Dim> kept = entry.impulse + entry.passed;
  return bridges_ ? Vec<Dim>(kept + bridge_of(entry).impulse) : kept;
}

template <int Dim>
void Contact<Dim>::book_rigid(const State<Dim>& state, const ContactNode<Dim>& node,
                              const ContactEntry<Dim>& entry) {
  const auto [field, slot] = list_.fields[static_cast<std::size_t>(node.field_begin + node.rigid)];
  const auto f = static_cast<std::size_t>(field);
  const Vec<Dim> kept = kept_of(entry);
  books_.rigid_impulse[f] -= kept;
  books_.rigid_work +=
      kept.dot(state.nodes.vector(Nodal::momentum, slot)) / state.nodes.column(Nodal::mass)[slot];
  Vec<3> arm = Vec<3>::Zero(), impulse = Vec<3>::Zero();
  for (int d = 0; d < Dim; ++d) {
    arm[d] = state.grid.origin[d] + node.node[d] * state.grid.cell - pivots_[f][d];
    impulse[d] = kept[d];
  }
  books_.rigid_moment[f] -= arm.cross(impulse);
}

/// Where the table of pairs has the two fields of an entry.
template <int Dim>
std::size_t Contact<Dim>::place_of_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                                        const ContactEntry<Dim>& entry) const {
  const auto field_of = [&](int k) {
    return list_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  };
  return pairs_.at(field_of(entry.a), field_of(partner(state, node, entry)));
}

/// Which of ContactSpec::pairs an entry is, behind them of cracks; −1: of none.
template <int Dim>
int Contact<Dim>::pair_of(const State<Dim>& state, const ContactNode<Dim>& node,
                          const ContactEntry<Dim>& entry) const {
  if (pairs_.empty() && entry.crack < 0) return -1;
  return law_between(entry, node, partner(state, node, entry));
}

template <int Dim>
const ConductanceSpec& Contact<Dim>::conductance_of(const State<Dim>& state, const ContactNode<Dim>& node,
                                                    const ContactEntry<Dim>& entry) const {
  const int pair = pair_of(state, node, entry);
  return (pair < 0 || entry.crack >= 0 ? spec_.law : spec_.pairs[static_cast<std::size_t>(pair)].law)
      .conductance;
}

template <int Dim>
void Contact<Dim>::book_pair(const State<Dim>& state, const ContactNode<Dim>& node,
                             const ContactEntry<Dim>& entry, double share) {
  const int pair = pair_of(state, node, entry);
  if (pair < 0 || entry.crack >= 0) return;
  const auto k = static_cast<std::size_t>(pair);
  const bool forward = pairs_.forward[place_of_pair(state, node, entry)];
  books_.pair_impulse[k] += (forward ? share : -share) * kept_of(entry);
}

// Here: the members that this file defines.
template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
