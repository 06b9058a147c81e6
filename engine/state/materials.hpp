#pragma once

/// @file The constitutive laws of this build. A new law is a struct in kernels/materials, an entry in the
/// variant and in MPMFAST_LAWS here, a spec in engine/scene/scene.hpp with its reader and writer, and a line
/// in engine/plan/materials.cpp.

#include <variant>

#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/logarithmic_neo_hookean.hpp"
#include "kernels/materials/metal.hpp"
#include "kernels/materials/neo_hookean.hpp"
#include "kernels/transfer/strain_chunk.hpp"

namespace mpmfast {

/// A constitutive law with its parameters.
using Material =
    std::variant<NeoHookean, LinearElastic, LogarithmicNeoHookean, MieGruneisen, MieGruneisenPlastic,
                 MieGruneisenJohnsonCook, ElasticPlastic, ElasticJohnsonCook>;

/// Compiled once, in materials.cpp, rather than with every basis.
#define MPMFAST_LAWS(apply)       \
  apply(NeoHookean);              \
  apply(LinearElastic);           \
  apply(LogarithmicNeoHookean);   \
  apply(MieGruneisen);            \
  apply(MieGruneisenPlastic);     \
  apply(MieGruneisenJohnsonCook); \
  apply(ElasticPlastic);          \
  apply(ElasticJohnsonCook)
#define MPMFAST_STRAIN_CHUNK(prefix, Dim, Law)                                                          \
  prefix template bool strain_chunk<Dim, Law>(const ParticleView<Dim>&, const Law&, std::uint32_t, int, \
                                              double, int, const StrainRoom<Dim>&, const ChunkStress<Dim>&)
#define MPMFAST_DECLARE(Law)            \
  MPMFAST_STRAIN_CHUNK(extern, 2, Law); \
  MPMFAST_STRAIN_CHUNK(extern, 3, Law)
MPMFAST_LAWS(MPMFAST_DECLARE);
#undef MPMFAST_DECLARE

}  // namespace mpmfast
