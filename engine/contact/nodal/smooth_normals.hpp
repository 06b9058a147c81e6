#pragma once

/// @file The mean of the normals of one contact over the nodes around: a single normal is poor where its
/// cloud holds few particles of one field.

#include <algorithm>
#include <vector>

#include "engine/contact/nodal/list.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// The contact node at one of the 3^Dim places around a node (itself in the middle), or −1.
template <int Dim>
int contact_neighbour(const Tiling<Dim>& tiling, const ContactList<Dim>& contact,
                      const ContactNode<Dim>& node, int m) {
  int stack_digit = 0, stride3 = 1, local = 0, stride4 = 1, rest = node.local;
  for (int d = 0; d < Dim; ++d) {
    int at = rest % kTileSide + m % 3 - 1;
    int step = 1;
    if (at < 0) at += kTileSide, step = 0;
    if (at >= kTileSide) at -= kTileSide, step = 2;
    stack_digit += step * stride3;
    local += at * stride4;
    stride3 *= 3;
    stride4 *= kTileSide;
    rest /= kTileSide;
    m /= 3;
  }
  const int stack = tiling.stacks[static_cast<std::size_t>(node.stack)].neighbour[stack_digit];
  return stack < 0 ? -1
                   : contact.node_at[static_cast<std::size_t>(stack) * kTileNodes<Dim> +
                                     static_cast<std::size_t>(local)];
}

/// What the mean takes of an entry: kept apart from the list, since each is read for all nodes around it.
template <int Dim>
struct RawNormal {
  Vec<Dim> weighted;  ///< normal times the smaller of the two masses, kg
  bool touches;       ///< its surfaces overlap
  bool doubted;       ///< it touches and is that of a simpler method
  int a;              ///< velocity field
  int pair;           ///< of velocity fields, or of a and a lump: rises with a, then with b
};

/// Do the normals around bear one out? Not where there are none.
/// @param sum  of all of them, its own among them
template <int Dim>
bool is_borne_out(const RawNormal<Dim>& own, const Vec<Dim>& sum) {
  constexpr double kCosine = 0.984807753012208;  // of 10 degrees
  const Vec<Dim> others = sum - own.weighted;
  return own.weighted.dot(others) > kCosine * own.weighted.norm() * others.norm();
}

template <int Dim>
class NormalMean {
 public:
  /// @param raw  the normals of the entries, with their separations
  /// @param pairs  nodes of three or more fields have an entry for every pair, and no lumps
  NormalMean(const State<Dim>& state, const ContactList<Dim>& contact, const std::vector<RawNormal<Dim>>& raw,
             bool pairs)
      : state_(state), contact_(contact), raw_(raw), pairs_(pairs) {}

  /// The contact nodes around a node, itself among them.
  struct Around {
    int nodes[power(3, Dim)], count = 0;
  };
  Around around(const ContactNode<Dim>& node) const {
    Around places;
    for (int m = 0; m < power(3, Dim); ++m) {
      const int other = contact_neighbour(state_.tiling, contact_, node, m);
      if (other >= 0) places.nodes[places.count++] = other;
    }
    return places;
  }

  RawNormal<Dim> raw(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry, const Vec<Dim>& normal,
                     bool touches, bool doubted) const {
    const double w = pairs_ ? weight(node, entry.a, entry.b) : weight(node, entry.a);
    const int a = field(node, entry.a), b = entry.b < 0 ? 0 : field(node, entry.b) + 1;
    return {w * normal, touches, doubted, a, a * (state_.fields() + 1) + b};
  }

  /// Sums of the entries of a node over the touching ones of the nodes around and this one, weighted by the
  /// smaller of the two masses; not normalised.
  void operator()(const Around& around, const ContactNode<Dim>& node, std::vector<Vec<Dim>>& sums) const {
    sums.assign(static_cast<std::size_t>(node.entry_end - node.entry_begin), Vec<Dim>::Zero());
    for (int k = 0; k < around.count; ++k) {
      const ContactNode<Dim>& other = contact_.nodes[static_cast<std::size_t>(around.nodes[k])];
      if (pairs_) {
        add_pairs(node, other, sums);
        continue;
      }
      for (int e = node.entry_begin; e < node.entry_end; ++e)
        add(raw_[static_cast<std::size_t>(e)].a, node, other,
            sums[static_cast<std::size_t>(e - node.entry_begin)]);
    }
  }

 private:
  int field(const ContactNode<Dim>& node, int k) const {
    return contact_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  }

  /// Adds the other node's normals of field a against b, and of b against a turned round; against a lump,
  /// those of a and any of the fields that it meets here.
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
    for (int e = other.entry_begin; e < other.entry_end; ++e) {
      const RawNormal<Dim>& theirs = raw_[static_cast<std::size_t>(e)];
      const bool same = theirs.a == a && has(meets_a, theirs.a);
      const bool turned = meets_a(theirs.a) && has([&](int g) { return g == a; }, theirs.a);
      if ((same || turned) && (theirs.touches || &other == &node))
        sum += (same ? 1.0 : -1.0) * theirs.weighted;
    }
  }

  /// Adds the other node's normals of the same pairs. The entries of every node are in the order of their
  /// fields, and a pair is everywhere seen from the same side.
  void add_pairs(const ContactNode<Dim>& node, const ContactNode<Dim>& other,
                 std::vector<Vec<Dim>>& sums) const {
    int own = node.entry_begin;
    for (int e = other.entry_begin; e < other.entry_end; ++e) {
      const RawNormal<Dim>& theirs = raw_[static_cast<std::size_t>(e)];
      if (!theirs.touches && &other != &node) continue;
      while (own < node.entry_end && raw_[static_cast<std::size_t>(own)].pair < theirs.pair) ++own;
      if (own == node.entry_end) return;
      if (raw_[static_cast<std::size_t>(own)].pair == theirs.pair)
        sums[static_cast<std::size_t>(own - node.entry_begin)] += theirs.weighted;
    }
  }

  /// The smaller mass of field a and the others, or b alone.
  double weight(const ContactNode<Dim>& node, int a, int b = -1) const {
    const double* mass = state_.nodes.column(Nodal::mass);
    double own = 0, total = 0;
    for (int k = 0; k < node.field_end - node.field_begin; ++k) {
      if (b >= 0 && k != a && k != b) continue;
      const double m = mass[contact_.fields[static_cast<std::size_t>(node.field_begin + k)].slot];
      total += m;
      if (k == a) own = m;
    }
    return std::min(own, total - own);
  }

  const State<Dim>& state_;
  const ContactList<Dim>& contact_;
  const std::vector<RawNormal<Dim>>& raw_;
  bool pairs_;
};

}  // namespace mpmfast
