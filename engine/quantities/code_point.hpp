#pragma once

/// @file Characters of UTF-8, one by one, and those of units as ASCII.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace mpmfast {

/// A character of UTF-8. Overlong forms and surrogates are none.
struct CodePoint {
  std::uint32_t code{};
  std::size_t bytes = 0;  ///< 0 where there is none
};
CodePoint code_point(std::string_view text, std::size_t at);

/// The typographic forms that people paste, µ, °, ·, ² and ³, as u, deg, *, ^2 and ^3.
std::string plain_spelling(std::string_view text);

}  // namespace mpmfast
