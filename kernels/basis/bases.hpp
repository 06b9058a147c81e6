#pragma once

/// @file The bases of this build. To add one: a type in a header here that facts.hpp includes, and its line
/// in the list. Scenes, the plan, the schema and `mpmfast list` know it by that; the build compiles its
/// passes in a file of their own.

/// A scene's word and the type, in the order in which they are listed.
// clang-format off
#define MPMFAST_BASES(basis)     \
  basis(linear, LinearBasis)     \
  basis(ugimp, UGimpBasis)       \
  basis(lcpdi, LcpdiBasis)       \
  basis(qcpdi, QcpdiBasis)       \
  basis(bspline2, BSpline2Basis) \
  basis(bspline3, BSpline3Basis)
// clang-format on

namespace mpmfast {

#define MPMFAST_WORD(word, Basis) word,
enum class BasisKind { MPMFAST_BASES(MPMFAST_WORD) };
#undef MPMFAST_WORD

}  // namespace mpmfast
