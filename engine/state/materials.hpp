#pragma once

/// @file The strain pass of every constitutive law (kernels/materials/laws.hpp), compiled once, in
/// materials.cpp, rather than with every basis.

#include "kernels/materials/laws.hpp"
#include "kernels/transfer/strain_chunk.hpp"

namespace mpmfast {

#define MPMFAST_STRAIN_CHUNK(prefix, Dim, Law)                                                          \
  prefix template bool strain_chunk<Dim, Law>(const ParticleView<Dim>&, const Law&, std::uint32_t, int, \
                                              double, int, const StrainWorkspace<Dim>&,                 \
                                              const ChunkStress<Dim>&)
#define MPMFAST_DECLARE(Law)            \
  MPMFAST_STRAIN_CHUNK(extern, 2, Law); \
  MPMFAST_STRAIN_CHUNK(extern, 3, Law);
MPMFAST_LAWS(MPMFAST_DECLARE)
#undef MPMFAST_DECLARE
extern template bool deform_chunk<2>(const ParticleView<2>&, std::uint32_t, int, double, int,
                                     const StrainWorkspace<2>&);
extern template bool deform_chunk<3>(const ParticleView<3>&, std::uint32_t, int, double, int,
                                     const StrainWorkspace<3>&);

}  // namespace mpmfast
