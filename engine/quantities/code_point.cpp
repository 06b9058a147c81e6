#include "engine/quantities/code_point.hpp"

#include <utility>

namespace mpmfast {

CodePoint code_point(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t first = byte(at);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || at + length > text.size()) return {};
  std::uint32_t code = first & (0xFFu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(at + k) & 0xC0) != 0x80) return {};
    code = (code << 6) | (byte(at + k) & 0x3F);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && (code < 0x10000 || code > 0x10FFFF));
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate ? CodePoint{} : CodePoint{code, length};
}

std::string plain_spelling(std::string_view text) {
  static const std::pair<std::string_view, std::string_view> kForms[] = {
      {"\xC2\xB5", "u"}, {"\xCE\xBC", "u"},  {"\xC2\xB0", "deg"},
      {"\xC2\xB7", "*"}, {"\xC2\xB2", "^2"}, {"\xC2\xB3", "^3"}};
  std::string out(text);
  for (const auto& [from, to] : kForms)
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at + to.size()))
      out.replace(at, from.size(), to);
  return out;
}

}  // namespace mpmfast
