#include "engine/output/font.hpp"

#include <array>
#include <utility>

namespace mpmfast {
namespace {

/// From ' ' to '~', a digit in base 32 for each row of dots, the top row first; two more where a letter goes
/// below the line.
constexpr std::array<std::string_view, 95> kGlyphs{
    "0000000",   "4444404", "AA00000",   "AAVAVAA", "4FKE5U4", "OP248J3", "CIK8LID", "4400000", "2488842",
    "8422248",   "04LEL40", "044V440",   "0000448", "000E000", "00000CC", "01248G0", "EHJLPHE", "4C4444E",
    "EH1248V",   "V2421HE", "26AIV22",   "VGU11HE", "68GUHHE", "V124888", "EHHEHHE", "EHHF12C", "0CC0CC0",
    "0CC0C48",   "248G842", "00V0V00",   "8421248", "EH12404", "EH1DLLE", "EHHVHHH", "UHHUHHU", "EHGGGHE",
    "SIHHHIS",   "VGGUGGV", "VGGUGGG",   "EHGNHHF", "HHHVHHH", "E44444E", "72222IC", "HIKOKIH", "GGGGGGV",
    "HRLLHHH",   "HHPLJHH", "EHHHHHE",   "UHHUGGG", "EHHHLID", "UHHUKIH", "FGGE11U", "V444444", "HHHHHHE",
    "HHHHHA4",   "HHHLLLA", "HHA4AHH",   "HHHA444", "V1248GV", "E88888E", "0G84210", "E22222E", "4AH0000",
    "000000V",   "8420000", "00E1FHF",   "GGMPHHU", "00EGGHE", "11DJHHF", "00EHVGE", "698S888", "00FHHHF1E",
    "GGMPHHH",   "40C444E", "2062222IC", "GGIKOKI", "C44444E", "00QLLHH", "00MPHHH", "00EHHHE", "00UHHHUGG",
    "00FHHHF11", "00MPGGG", "00EGE1U",   "88S8896", "00HHHJD", "00HHHA4", "00HHLLA", "00HA4AH", "00HHHHF1E",
    "00V248V",   "2448442", "4444444",   "8442448", "008L200"};

/// µ, °, ², ³ and ·: letters 1 to 5.
constexpr std::array<std::string_view, 5> kOfUnits{"00HHHJTGG", "EAE0000", "C24E000", "C242C00", "000CC00"};

constexpr std::array<std::pair<std::string_view, char>, 10> kNear{{{"\u2013", '-'},
                                                                   {"\u2212", '-'},
                                                                   {"\u00b5", '\1'},
                                                                   {"\u03bc", '\1'},
                                                                   {"\u00b0", '\2'},
                                                                   {"\u00b2", '\3'},
                                                                   {"\u00b3", '\4'},
                                                                   {"\u00b7", '\5'},
                                                                   {"\u00d7", 'x'},
                                                                   {"\u2019", '\''}}};

bool is_of_units(char letter) { return letter >= 1 && letter <= static_cast<char>(kOfUnits.size()); }

std::string_view glyph(char letter) {
  if (is_of_units(letter)) return kOfUnits[static_cast<std::size_t>(letter - 1)];
  if (letter < ' ' || letter > '~') letter = '?';
  return kGlyphs[static_cast<std::size_t>(letter - ' ')];
}

}  // namespace

bool glyph_dot(char letter, int row, int column) {
  const std::string_view rows = glyph(letter);
  if (static_cast<std::size_t>(row) >= rows.size()) return false;
  const char digit = rows[static_cast<std::size_t>(row)];
  const int dots = digit <= '9' ? digit - '0' : digit - 'A' + 10;
  return (dots >> (kGlyphWidth - 1 - column) & 1) != 0;
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    while (i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xC0) == 0x80)
      ++length;
    const bool known = length == 1 && ((text[i] >= ' ' && text[i] <= '~') || is_of_units(text[i]));
    char letter = known ? text[i] : '?';
    for (const auto& [code_point, near] : kNear)
      if (text.substr(i, length) == code_point) letter = near;
    out += letter;
    i += length;
  }
  return out;
}

}  // namespace mpmfast
