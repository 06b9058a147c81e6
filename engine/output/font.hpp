#pragma once

/// @file A 5 × 7 dot font for labels: printable ASCII, and the µ ° ² ³ · of units.

#include <string>
#include <string_view>

namespace mpmfast {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;  ///< of capitals
inline constexpr int kGlyphRows = 9;                     ///< with what goes below the line

/// Is the dot of this letter set? Row 0 is the top.
bool glyph_dot(char letter, int row, int column);

/// The text in letters that the font has, one a code point: those of units that are not ASCII have the codes
/// 1 to 5, any other becomes a near letter or '?'. Printable text is left as it is.
std::string printable(std::string_view text);

}  // namespace mpmfast
