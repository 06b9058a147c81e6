#pragma once

/// @file xxHash, compiled in. Its AVX-512 path makes g++ 12 warn falsely, and the scalar one is fast enough
/// here; the hashes are the same.

#define XXH_INLINE_ALL
#define XXH_VECTOR 0
#include <fmt/format.h>
#include <xxhash.h>

#include <cstddef>
#include <memory>
#include <new>
#include <string>

namespace mpmfast {

/// XXH3-128 of bytes that come piece by piece.
class Hash128 {
 public:
  Hash128() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }
  void add(const void* bytes, std::size_t n) { XXH3_128bits_update(state_.get(), bytes, n); }
  /// As 32 hexadecimal digits.
  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

}  // namespace mpmfast
