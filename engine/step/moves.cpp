#include "engine/step/moves.hpp"

namespace mpmfast {

MPMFAST_MOVE_CHUNK(, 2, false);
MPMFAST_MOVE_CHUNK(, 2, true);
MPMFAST_MOVE_CHUNK(, 3, false);
MPMFAST_MOVE_CHUNK(, 3, true);

}  // namespace mpmfast
