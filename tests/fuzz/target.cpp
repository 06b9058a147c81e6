/// @file A fuzzer: libFuzzer calls the entry that MPMFAST_FUZZ_ENTRY names.

#include <cstddef>
#include <cstdint>

#include "entries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size <= mpmfast::fuzz::kMostBytes) mpmfast::fuzz::MPMFAST_FUZZ_ENTRY({data, size});
  return 0;
}
