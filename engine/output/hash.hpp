#pragma once

/// @file xxHash, compiled in. Its AVX-512 path makes g++ 12 warn falsely, and the scalar one is fast enough
/// here; the hashes are the same.

#define XXH_INLINE_ALL
#define XXH_VECTOR 0
#include <xxhash.h>
