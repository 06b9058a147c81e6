#pragma once

/// @file Which contact law holds between two velocity fields.

#include <variant>

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/node_fields.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// Calls f with the law that acts at present. A broken bond acts by its contact law; so do springs with the
/// compression model `contact`.
template <class Law, class F>
void with_acting_law(const Law& law, bool broken, const F& f) {
  if constexpr (requires { law.contact(); }) {
    if ((std::is_same_v<Law, Cohesive> && broken) || law.compression == CompressionModel::contact)
      return f(law.contact());
  }
  f(law);
}

/// One law for every pair.
template <class Law>
struct OneLaw {
  const Law& law;
  static constexpr bool by_pair = false;
  template <class F>
  void with(int, const F& f) const {
    f(law);
  }
};

/// The law of each pair, or of a crack, by its number (PairLaws).
struct LawsByPair {
  const std::vector<AnyLaw>& laws;
  static constexpr bool by_pair = true;
  template <class F>
  void with(int number, const F& f) const {
    std::visit(f, laws[static_cast<std::size_t>(number + 1)]);
  }
};

/// The laws of a scene: the default (kDefault), those of ContactSpec::pairs, then those of cracks.
class PairLaws {
 public:
  static constexpr int kDefault = -1;  ///< number of the default law

  PairLaws(const Scene& scene, const Plan& plan);

  /// Laws without the default.
  std::size_t count() const { return laws_.size() - 1; }
  bool none_by_fields() const { return table_.empty(); }
  const AnyLaw& law(int number) const { return laws_[static_cast<std::size_t>(number + 1)]; }
  /// Does this hold of any law? Of all?
  template <class F>
  bool any(const F& holds) const {
    return std::any_of(laws_.begin(), laws_.end(), holds);
  }
  template <class F>
  bool all(const F& holds) const {
    return std::all_of(laws_.begin(), laws_.end(), holds);
  }
  /// Calls f with the laws in the form that costs least: OneLaw or LawsByPair. Coulomb's law, which most
  /// scenes have, is called directly.
  template <class F>
  void dispatch(const F& f) const {
    if (by_pair_) return f(LawsByPair{laws_});
    if (const auto* coulomb = std::get_if<Coulomb>(&laws_.front())) return f(OneLaw<Coulomb>{*coulomb});
    std::visit([&](const auto& law) { f(OneLaw<std::decay_t<decltype(law)>>{law}); }, laws_.front());
  }

  /// The number of the law between field a of a pair and another field of its node.
  template <int Dim>
  int number_between(const NodeFields<Dim>& fields, const ContactPair& pair, int other) const {
    if (pair.crack >= 0) return listed_ + pair.crack;
    if (table_.empty()) return -1;
    return table_.pair[table_.at(fields.field(pair.a), fields.field(other))];
  }
  /// The number of the law of a pair.
  template <int Dim>
  int number_of(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, const ContactPair& pair) const {
    if (table_.empty() && pair.crack < 0) return -1;
    return number_between(fields, pair, partner(fields, node, pair));
  }
  template <int Dim>
  const AnyLaw& law_of(const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                       const ContactPair& pair) const {
    return law(number_of(fields, node, pair));
  }
  /// Is field a of a pair the first of the two that the scene names?
  template <int Dim>
  bool is_first(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, const ContactPair& pair) const {
    return table_.forward[table_.at(fields.field(pair.a), fields.field(partner(fields, node, pair)))];
  }

 private:
  PairTable table_;
  int listed_;  ///< ContactSpec::pairs
  std::vector<AnyLaw> laws_;
  bool by_pair_;
};

/// Where the acting law of a pair acts.
inline LawScope scope_of(const AnyLaw& law, bool broken) {
  LawScope scope{};
  std::visit(
      [&](const auto& one) { with_acting_law(one, broken, [&](const auto& now) { scope = now.scope; }); },
      law);
  return scope;
}

}  // namespace mpmfast
