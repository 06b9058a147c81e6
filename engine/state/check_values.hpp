#pragma once

/// @file What numbers of a checkpoint must be. Everything here throws FileError.

#include <cstddef>
#include <string_view>

namespace mpmfast {

/// Throws the FileError of a checkpoint that no run of its scene wrote.
[[noreturn]] void refuse_checkpoint(std::string_view why);

/// Each number of a column is finite.
void check_finite(std::string_view name, const double* values, std::size_t n);
/// 0 <= value, and finite.
void check_not_negative(std::string_view name, double value);

}  // namespace mpmfast
