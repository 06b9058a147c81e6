#pragma once

/// @file Is this text at all? yaml-cpp reads UTF-16 and binary files without a complaint.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "engine/scene/text/problems.hpp"

namespace mpmfast {

/// A character of UTF-8. Overlong forms and surrogates are none.
struct CodePoint {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0 where there is none
};
CodePoint code_point(std::string_view text, std::size_t at);

/// UTF-8 without control characters (but tab and line ends). Notes the first offence.
bool check_text(const std::string& text, int source, Problems& problems);

}  // namespace mpmfast
