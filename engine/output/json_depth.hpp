#pragma once

/// @file A run.json may come from anyone. nlohmann's library writes nested values by calling itself, and deep
/// ones overflow the stack.

#include <cstddef>
#include <string_view>

namespace mpmfast {

inline constexpr std::size_t kDeepestJson = 32;  ///< levels; a run.json has four

/// Do the braces and brackets of a text, those in strings left out, nest no deeper than that?
inline bool is_shallow_json(std::string_view text, std::size_t deepest = kDeepestJson) {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quoted) {
      if (c == '\\') ++k;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest) return false;
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return true;
}

}  // namespace mpmfast
