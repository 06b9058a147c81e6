#pragma once

/// @file Text in parts.

#include <cstddef>
#include <string_view>
#include <vector>

namespace mpmfast {

/// What stands before, between and after the marks; nothing of no text. (std::views::split is not for
/// clang 14.)
inline std::vector<std::string_view> parts_of(std::string_view text, char mark) {
  std::vector<std::string_view> parts;
  if (text.empty()) return parts;
  std::size_t begin{};
  for (std::size_t end = 0; (end = text.find(mark, begin)) != std::string_view::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

}  // namespace mpmfast
