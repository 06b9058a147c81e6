#include "engine/state/materials.hpp"

namespace mpmfast {

#define MPMFAST_DEFINE(Law)       \
  MPMFAST_STRAIN_CHUNK(, 2, Law); \
  MPMFAST_STRAIN_CHUNK(, 3, Law);
MPMFAST_LAWS(MPMFAST_DEFINE)
#undef MPMFAST_DEFINE

}  // namespace mpmfast
