#pragma once

/// @file Finds the nodes where velocity fields meet, and lists the contact pairs there.

#include <vector>

#include "engine/contact/pairs/contact_list.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/contact/pairs/pair_memory.hpp"
#include "engine/cracks/cracks.hpp"

namespace mpmfast {

template <int Dim>
class PairFinder {
 public:
  /// All of these must outlive it.
  PairFinder(const Scene& scene, const PairLaws& laws, const Cracks<Dim>& cracks);

  /// Lists the nodes where two or more fields have mass, with their pairs, without those that the screens
  /// drop. Pairs get what the memory has of the last step; the order does not depend on the number of
  /// threads.
  void find(const State<Dim>& state, PairMemory<Dim>& memory, ContactList<Dim>& list);

  std::size_t bytes() const;

 private:
  struct ListedPair {
    ContactPair pair;
    Vec<Dim> normal = Vec<Dim>::Zero();
    bool prescribed = false;  ///< the normal, as PairGeometry::prescribed
  };
  /// What one thread lists: the contact nodes of its share of the blocks, with pairs from 0 on.
  struct alignas(64) Listing {
    std::vector<ContactNode<Dim>> nodes;
    std::vector<ListedPair> pairs;
    std::vector<std::size_t> block_begin;              ///< the first of `nodes` of each block
    std::uint64_t meetings, screened;                  ///< as ContactCounters
    std::size_t node_begin, pair_begin, blocks_begin;  ///< position of its own in the whole list
  };

 public:
  static constexpr std::size_t kPairBytes = sizeof(ListedPair);  ///< memory of a listed pair

 private:
  int count_fields(const State<Dim>& state, std::size_t block) const;
  void list_block(const State<Dim>& state, std::size_t block, ContactList<Dim>& list, Listing& out);
  void list_pairs(const State<Dim>& state, const NodeFields<Dim>& fields, ContactNode<Dim>& node,
                  Listing& out) const;
  void list_all_pairs(const State<Dim>& state, const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                      Listing& out) const;
  void list_lumped_pairs(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, double total,
                         Listing& out) const;
  void list_explicit_pairs(const NodeFields<Dim>& fields, const ContactNode<Dim>& node, Listing& out) const;
  bool has_little_volume(const State<Dim>& state, const NodeFields<Dim>& fields) const;
  bool is_separated(const State<Dim>& state, const NodeFields<Dim>& fields, const ContactNode<Dim>& node,
                    ListedPair& listed) const;
  double least_mass_share(const NodeFields<Dim>& fields, const ContactPair& pair, int other) const;
  void place_listings(std::size_t threads, PairMemory<Dim>& memory, ContactList<Dim>& list);
  void take_listing(const State<Dim>& state, const Listing& listing, PairMemory<Dim>& memory,
                    ContactList<Dim>& list) const;

  const ContactSpec& spec_;
  const PairLaws& laws_;
  const Cracks<Dim>& cracks_;
  double cell_volume_;
  Indexed<int> field_begin_;  ///< by block, into ContactList::fields
  std::vector<Listing> listings_;
};

extern template class PairFinder<2>;
extern template class PairFinder<3>;

}  // namespace mpmfast
