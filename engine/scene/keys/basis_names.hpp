#pragma once

/// @file The words of the bases, from the list of kernels/basis/bases.hpp.

#include "engine/scene/keys/names.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

inline constexpr auto kBases = [] {
  std::array<Keyword<BasisKind>, kBasisFacts.size()> words{};
  for (std::size_t k = 0; k < words.size(); ++k)
    words[k] = {static_cast<BasisKind>(k), kBasisFacts[k].keyword, kBasisFacts[k].description};
  return words;
}();

}  // namespace mpmfast
