#pragma once

/// @file Which law holds between two velocity fields, for scenes that give pairs laws of their own.

#include <cstddef>
#include <vector>

namespace mpmfast {

/// Fields that no pair names apart fall into groups by material, so that the table stays small however many
/// bodies there are.
struct PairTable {
  std::vector<int> group;  ///< by field
  int groups{};
  std::vector<int> pair;  ///< [group · groups + group] → index into ContactSpec::pairs; −1: the default law
  std::vector<bool> forward;  ///< [same]: the first group is the pair's first

  bool empty() const { return pair.empty(); }
  std::size_t at(int field_a, int field_b) const {
    const auto a = static_cast<std::size_t>(field_a), b = static_cast<std::size_t>(field_b);
    return static_cast<std::size_t>(group[a] * groups + group[b]);
  }
};

}  // namespace mpmfast
