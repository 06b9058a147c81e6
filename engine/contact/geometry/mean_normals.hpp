#pragma once

/// @file The mean of the normals of a pair over the nodes around. A single normal is poor where its cloud
/// holds few particles of one field.

#include <algorithm>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/pairs/neighbours.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// What the mean takes of a pair, in a column of its own: each is read for all nodes around it.
template <int Dim>
struct RawNormal {
  Vec<Dim> weighted;  ///< normal times the smaller of the two masses, kg
  bool overlaps;      ///< the surfaces overlap
  bool doubted;       ///< they overlap, and the normal is that of a simpler method
  int a;              ///< velocity field
  int pair;           ///< the two velocity fields, or a and the lumped others: rises with a, then with b
};

/// Do the normals around confirm one? Not where there are none.
/// @param sum  of all of them, its own included
template <int Dim>
bool is_confirmed(const RawNormal<Dim>& own, const Vec<Dim>& sum) {
  using constants::contact::kConfirmingCosine;
  const Vec<Dim> others = sum - own.weighted;
  return own.weighted.dot(others) > kConfirmingCosine * own.weighted.norm() * others.norm();
}

template <int Dim>
class MeanNormals {
 public:
  /// @param raw        by pair
  /// @param all_pairs  as FitChoice
  MeanNormals(const State<Dim>& state, const ContactList<Dim>& list, const std::vector<RawNormal<Dim>>& raw,
              bool all_pairs)
      : state_(state), list_(list), raw_(raw), all_pairs_(all_pairs) {}

  /// The contact nodes around a node, itself included.
  struct Around {
    int nodes[power(3, Dim)], count = 0;
  };
  Around around(const ContactNode<Dim>& node) const {
    Around found;
    for (int m = 0; m < power(3, Dim); ++m) {
      const int other = contact_neighbour(state_.tiling, list_, node, m);
      if (other >= 0) found.nodes[found.count++] = other;
    }
    return found;
  }

  RawNormal<Dim> raw(const ContactNode<Dim>& node, const ContactPair& pair, const Vec<Dim>& normal,
                     bool overlaps, bool doubted) const {
    const double w = all_pairs_ ? weight(node, pair.a, pair.b) : weight(node, pair.a);
    const int a = field(node, pair.a), b = pair.is_lumped() ? 0 : field(node, pair.b) + 1;
    return {w * normal, overlaps, doubted, a, a * (state_.fields() + 1) + b};
  }

  /// For each pair of a node the sum of its raw normal and of those around whose surfaces overlap, weighted
  /// by the smaller of the two masses; not normalised.
  void operator()(const Around& around, const ContactNode<Dim>& node, std::vector<Vec<Dim>>& sums) const {
    sums.assign(static_cast<std::size_t>(node.pair_end - node.pair_begin), Vec<Dim>::Zero());
    for (int k = 0; k < around.count; ++k) {
      const ContactNode<Dim>& other = list_.nodes[around.nodes[k]];
      if (all_pairs_) {
        add_pairs(node, other, sums);
        continue;
      }
      for (int e = node.pair_begin; e < node.pair_end; ++e)
        add(raw_[static_cast<std::size_t>(e)].a, node, other,
            sums[static_cast<std::size_t>(e - node.pair_begin)]);
    }
  }

 private:
  int field(const ContactNode<Dim>& node, int k) const { return list_.fields[node.field_begin + k].field; }

  /// Adds the other node's normals of field a against b, and those of b against a with the opposite sign. For
  /// a lumped pair, b is any of the fields that a meets here.
  void add(int a, const ContactNode<Dim>& node, const ContactNode<Dim>& other, Vec<Dim>& sum) const {
    const auto meets_a = [&](int f) {
      if (f == a) return false;
      for (int k = 0; k < node.field_end - node.field_begin; ++k)
        if (field(node, k) == f) return true;
      return false;
    };
    const auto has = [&](auto wanted, int except) {
      for (int k = 0; k < other.field_end - other.field_begin; ++k)
        if (field(other, k) != except && wanted(field(other, k))) return true;
      return false;
    };
    for (int e = other.pair_begin; e < other.pair_end; ++e) {
      const RawNormal<Dim>& theirs = raw_[static_cast<std::size_t>(e)];
      const bool same = theirs.a == a && has(meets_a, theirs.a);
      const bool turned = meets_a(theirs.a) && has([&](int g) { return g == a; }, theirs.a);
      if ((same || turned) && (theirs.overlaps || &other == &node))
        sum += (same ? 1.0 : -1.0) * theirs.weighted;
    }
  }

  /// Adds the other node's normals of the same pairs. Every node has its pairs in the order of their fields,
  /// and a pair has the same first field everywhere.
  void add_pairs(const ContactNode<Dim>& node, const ContactNode<Dim>& other,
                 std::vector<Vec<Dim>>& sums) const {
    int own = node.pair_begin;
    for (int e = other.pair_begin; e < other.pair_end; ++e) {
      const RawNormal<Dim>& theirs = raw_[static_cast<std::size_t>(e)];
      if (!theirs.overlaps && &other != &node) continue;
      while (own < node.pair_end && raw_[static_cast<std::size_t>(own)].pair < theirs.pair) ++own;
      if (own == node.pair_end) return;
      if (raw_[static_cast<std::size_t>(own)].pair == theirs.pair)
        sums[static_cast<std::size_t>(own - node.pair_begin)] += theirs.weighted;
    }
  }

  /// The smaller mass of field a and the others, or b alone.
  double weight(const ContactNode<Dim>& node, int a, int b = -1) const {
    const double* mass = state_.nodes.column(Nodal::mass);
    double own = 0, total = 0;
    for (int k = 0; k < node.field_end - node.field_begin; ++k) {
      if (b >= 0 && k != a && k != b) continue;
      const double m = mass[list_.fields[node.field_begin + k].slot];
      total += m;
      if (k == a) own = m;
    }
    return std::min(own, total - own);
  }

  const State<Dim>& state_;
  const ContactList<Dim>& list_;
  const std::vector<RawNormal<Dim>>& raw_;
  bool all_pairs_;
};

}  // namespace mpmfast
