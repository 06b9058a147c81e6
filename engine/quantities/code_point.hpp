#pragma once

/// @file Characters of UTF-8, one by one.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mpmfast {

/// A character of UTF-8. Overlong forms and surrogates are none.
struct CodePoint {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  ///< 0 where there is none
};
CodePoint code_point(std::string_view text, std::size_t at);

}  // namespace mpmfast
