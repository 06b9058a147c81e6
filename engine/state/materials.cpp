#include "engine/state/materials.hpp"

namespace mpmfast {

#define MPMFAST_DEFINE(Law)       \
  MPMFAST_STRAIN_CHUNK(, 2, Law); \
  MPMFAST_STRAIN_CHUNK(, 3, Law);
MPMFAST_LAWS(MPMFAST_DEFINE)
#undef MPMFAST_DEFINE
template bool deform_chunk<2>(const ParticleView<2>&, std::uint32_t, int, double, int,
                              const StrainWorkspace<2>&);
template bool deform_chunk<3>(const ParticleView<3>&, std::uint32_t, int, double, int,
                              const StrainWorkspace<3>&);

}  // namespace mpmfast
