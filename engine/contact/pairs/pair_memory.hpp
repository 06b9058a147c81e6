#pragma once

/// @file What the pairs of a step leave to those of the next, and to a checkpoint.

#include <cstdint>
#include <vector>

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {

/// Names a pair from step to step: its node, then its field a, then b (first of all the lumped one). The
/// sides of a crack are named by that crack, since the fields that it separates depend on what else is near.
template <int Dim>
std::uint64_t pair_key(const State<Dim>& state, const ContactList<Dim>& list, const ContactNode<Dim>& node,
                       const ContactPair& pair);

/// Stores columns of the last step by the keys of their pairs, and restores them.
template <int Dim>
class PairMemory {
 public:
  explicit PairMemory(const Scene& scene, const Plan& plan, const PairLaws& laws);

  /// Stores the pairs of the list.
  void store(const ContactList<Dim>& list, int threads);
  /// Makes space for so many pairs in the list; its springs, bonds and fits are kept as those of the last
  /// step.
  void resize(std::size_t count, ContactList<Dim>& list);

  /// Where the search for the next key begins: keys mostly rise from pair to pair.
  struct Cursor {
    std::uint64_t key_before = ~std::uint64_t{0};
    std::size_t at = 0;
  };
  /// Names pair e and gives it what the last step stored of it. May be called for different pairs at once.
  void restore(std::uint64_t key, std::size_t e, Cursor& cursor, ContactList<Dim>& list);

  /// Writes the stored columns to an archive, or reads them. Throws what the archive throws, and on contents
  /// that no step wrote.
  void visit(Archive& archive, ContactList<Dim>& list);

  std::size_t bytes() const { return bytes_in(keys_, stored_, springs_, bonds_, fits_); }

 private:
  struct Stored {
    std::uint64_t key;
    std::uint32_t pair;  ///< its index in the last step
    PairHistory history;
    double plane[Dim + 1];  ///< PairGeometry::plane
  };

 public:
  static constexpr std::size_t kPairBytes = sizeof(Stored) + sizeof(std::uint64_t);  ///< with its key

 private:
  void visit_history(Archive& archive, PairColumns<Dim>& pairs) const;
  void visit_jumps(Archive& archive, PairColumns<Dim>& pairs) const;
  void visit_bonds(Archive& archive, PairColumns<Dim>& pairs) const;
  void visit_fits(Archive& archive, PairColumns<Dim>& pairs) const;

  bool in_order_;   ///< pairs are listed in the order of their keys
  bool separates_;  ///< fitted normals have support particles
  bool has_springs_, has_bonds_, has_fits_;
  std::vector<std::uint64_t> keys_;  ///< of the pairs of the list
  std::vector<Stored> stored_;       ///< of the last step, in the order of the keys
  Indexed<InterfaceSpring<Dim>> springs_;
  Indexed<Bond<Dim>> bonds_;
  Indexed<KeptFit<Dim>> fits_;
};

extern template class PairMemory<2>;
extern template class PairMemory<3>;

}  // namespace mpmfast
