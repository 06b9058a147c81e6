#pragma once

/// @file The mean of the normals of one contact over the nodes around: a single normal is poor where its
/// cloud holds few particles of one field.

#include <algorithm>
#include <vector>

#include "engine/state/state.hpp"
#include "engine/step/contact_list.hpp"

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

/// What an entry found by itself.
template <int Dim>
struct RawNormal {
  Vec<Dim> normal;
  double separation;  ///< m
};

template <int Dim>
class NormalMean {
 public:
  /// @param raw  the normals of the entries, with their separations
  /// @param pairs  nodes of three or more fields have an entry for every pair, and no lumps
  NormalMean(const State<Dim>& state, const ContactList<Dim>& contact, const std::vector<RawNormal<Dim>>& raw,
             bool pairs)
      : state_(state), contact_(contact), raw_(raw), pairs_(pairs) {}

  /// Over the touching ones of the 3^Dim nodes around and this one, weighted by the smaller of the two
  /// masses; not normalised.
  Vec<Dim> operator()(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry) const {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int m = 0; m < power(3, Dim); ++m) {
      const int other = contact_neighbour(state_.tiling, contact_, node, m);
      if (other >= 0) add(node, entry, contact_.nodes[static_cast<std::size_t>(other)], sum);
    }
    return sum;
  }

 private:
  int field(const ContactNode<Dim>& node, int k) const {
    return contact_.fields[static_cast<std::size_t>(node.field_begin + k)].field;
  }

  /// Adds the other node's normals of field a against b, and of b against a turned round; against a lump,
  /// those of a and any of the fields that it meets here.
  void add(const ContactNode<Dim>& node, const ContactEntry<Dim>& entry, const ContactNode<Dim>& other,
           Vec<Dim>& sum) const {
    const int a = field(node, entry.a);
    if (entry.b >= 0 && pairs_) return add_pair(a, field(node, entry.b), node, other, sum);
    const auto meets_a = [&](int f) {
      if (f == a) return false;
      for (int k = 0; k < node.field_end - node.field_begin; ++k)
        if (field(node, k) == f) return true;
      return false;
    };
    const auto has = [&](auto wanted, int except) {
      for (int k = 0; k < other.field_end - other.field_begin; ++k)
        if (k != except && wanted(field(other, k))) return true;
      return false;
    };
    for (int e = other.entry_begin; e < other.entry_end; ++e) {
      const auto& theirs = contact_.entries[static_cast<std::size_t>(e)];
      const int f = field(other, theirs.a);
      const bool same = f == a && has(meets_a, theirs.a);
      const bool turned = meets_a(f) && has([&](int g) { return g == a; }, theirs.a);
      if ((same || turned) && counts(node, other, e))
        sum += (same ? 1.0 : -1.0) * weight(other, theirs.a) * raw_[static_cast<std::size_t>(e)].normal;
    }
  }

  bool counts(const ContactNode<Dim>& node, const ContactNode<Dim>& other, int e) const {
    return &other == &node || raw_[static_cast<std::size_t>(e)].separation < 0;
  }

  void add_pair(int a, int b, const ContactNode<Dim>& node, const ContactNode<Dim>& other,
                Vec<Dim>& sum) const {
    for (int e = other.entry_begin; e < other.entry_end; ++e) {
      const auto& theirs = contact_.entries[static_cast<std::size_t>(e)];
      if (theirs.b < 0) continue;
      const int f = field(other, theirs.a), g = field(other, theirs.b);
      if (!((f == a && g == b) || (f == b && g == a)) || !counts(node, other, e)) continue;
      sum += (f == a ? 1.0 : -1.0) * weight(other, theirs.a, theirs.b) *
             raw_[static_cast<std::size_t>(e)].normal;
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
