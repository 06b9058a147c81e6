#pragma once

/// @file The motion of particles (kernels/transfer/move.hpp), compiled once, in moves.cpp, rather than with
/// every basis.

#include "kernels/transfer/move.hpp"

namespace mpmfast {

#define MPMFAST_MOVE_CHUNK(prefix, Dim, Convected)                                                  \
  prefix template void move_chunk<Dim, Convected>(const TileContext<Dim>&, int, std::uint32_t, int, \
                                                  const double(*)[kChunk<Dim>], const UpdateRule&,  \
                                                  const double(&)[Dim], const double(&)[Dim], LaneReport&)
MPMFAST_MOVE_CHUNK(extern, 2, false);
MPMFAST_MOVE_CHUNK(extern, 2, true);
MPMFAST_MOVE_CHUNK(extern, 3, false);
MPMFAST_MOVE_CHUNK(extern, 3, true);

}  // namespace mpmfast
