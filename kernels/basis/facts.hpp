#pragma once

/// @file The types behind the words of the list of bases, and what is asked of them outside the kernels.

#include <array>
#include <cstddef>

#include "kernels/basis/bases.hpp"
#include "kernels/basis/cpdi.hpp"
#include "kernels/basis/separable.hpp"

namespace mpmfast {

/// The type behind a word: BasisOf<BasisKind::ugimp>::In<Dim>.
template <BasisKind kind>
struct BasisOf;
#define MPMFAST_TYPE(word, Basis)   \
  template <>                       \
  struct BasisOf<BasisKind::word> { \
    template <int Dim>              \
    using In = Basis<Dim>;          \
  };
MPMFAST_BASES(MPMFAST_TYPE)
#undef MPMFAST_TYPE

/// What decisions outside the kernels ask of a basis.
struct BasisFacts {
  const char* keyword;
  const char* description;
  bool convected;     ///< domains follow F: particles carry their edges
  bool over_domain;   ///< the grid's function is averaged over the particle's domain
  double grid_reach;  ///< cells from its node up to which the grid's function is not zero
  double spread;  ///< Σ_i S_pi (x_i − x_p)² along an axis, cells², where it is the same everywhere; else 0
  int usual_support;  ///< nodes a side that most particles have weight on
};

#define MPMFAST_FACTS(word, Basis)   \
  BasisFacts{#word,                  \
             Basis<2>::kDescription, \
             Basis<2>::kConvected,   \
             Basis<2>::kOverDomain,  \
             Basis<2>::kGridReach,   \
             Basis<2>::kSpread,      \
             Basis<2>::kMinSupport},
inline constexpr std::array kBasisFacts{MPMFAST_BASES(MPMFAST_FACTS)};
#undef MPMFAST_FACTS

constexpr const BasisFacts& facts(BasisKind basis) { return kBasisFacts[static_cast<std::size_t>(basis)]; }

}  // namespace mpmfast
