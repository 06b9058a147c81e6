#include "engine/quantities/printable.hpp"

#include <fmt/format.h>

#include "engine/quantities/code_point.hpp"

namespace mpmfast {
namespace {

bool is_control(std::uint32_t code) {
  return (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7F && code < 0xA0);
}

/// Characters that show the text after them in another order, or break a line where no terminal does.
bool is_rearranging(std::uint32_t code) {
  return code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = code_point(text, at);
    if (point.bytes == 0) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at++]));
      continue;
    }
    if (is_control(point.code))
      out += fmt::format("\\x{:02x}", point.code);
    else if (is_rearranging(point.code))
      out += fmt::format("\\u{:04x}", point.code);
    else
      out += text.substr(at, point.bytes);
    at += point.bytes;
  }
  return out;
}

}  // namespace mpmfast
