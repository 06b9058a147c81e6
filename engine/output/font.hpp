#pragma once

/// @file A 5 × 7 dot font for labels: printable ASCII.

#include <string>
#include <string_view>

namespace mpmfast {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;

/// Is the dot of this letter set? Row 0 is the top.
bool glyph_dot(char letter, int row, int column);

/// The text in letters that the font has: UTF-8 beyond ASCII becomes a near letter or '?', one a code point.
std::string printable(std::string_view text);

}  // namespace mpmfast
