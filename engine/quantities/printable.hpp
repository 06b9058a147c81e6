#pragma once

#include <string>
#include <string_view>

namespace mpmfast {

/// A text for a terminal or a log, in which nothing acts: characters that would move the cursor, change
/// colours, the title or the direction of writing, and bytes that are no UTF-8, become text: "\x1b",
/// "\u202e". Lines and tabs stay.
std::string printable(std::string_view text);

}  // namespace mpmfast
