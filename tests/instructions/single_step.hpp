#pragma once

/// @file Counts the instructions that this thread executes, exactly, on any machine of the architecture: the
/// processor's trap flag stops it after every one. Nothing else counts all of them everywhere: virtual
/// machines often have no counters, and valgrind does not know every instruction that -march=native may
/// choose. It is slow (2 to 20 us an instruction), and what another thread does is not seen.

#include <cstdint>

namespace mpmfast::instructions {

/// Can this program count here?
bool can_count();

/// Between the two calls every instruction of the calling thread counts; an instruction with a repeat prefix
/// is one.
void start_counting();
/// @return instructions since start_counting, with about ten of the two calls themselves
std::uint64_t stop_counting();

}  // namespace mpmfast::instructions
