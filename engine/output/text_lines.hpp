#pragma once

/// @file Text that is too wide for a picture, in lines.

#include <string>
#include <vector>

namespace mpmfast {

/// Lines of at most so many pixels, broken at blanks, and within a word where it is wider than a line. What
/// does not fit into the most lines ends in "...".
/// @param space  pixels
/// @param most  lines
std::vector<std::string> text_lines(const std::string& text, double space, std::size_t most);

}  // namespace mpmfast
