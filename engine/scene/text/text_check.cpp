#include "engine/scene/text/text_check.hpp"

#include <fmt/format.h>

#include "engine/quantities/code_point.hpp"

namespace mpmfast {

bool check_text(const std::string& text, int source, Problems& problems) {
  int line = 1, column = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = code_point(text, at).bytes;
    const auto byte = static_cast<unsigned char>(text[at]);
    const bool control = (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F;
    if (length == 0 || control) {
      problems.add({line, column, source}, "", fmt::format("not UTF-8 text, got the byte 0x{:02X}", byte),
                   at == 0 && byte >= 0xFE ? "It looks like UTF-16: save it as UTF-8" : "");
      return false;
    }
    if (byte == '\n') {
      ++line;
      column = 0;
    }
    ++column;
    at += length;
  }
  return true;
}

}  // namespace mpmfast
