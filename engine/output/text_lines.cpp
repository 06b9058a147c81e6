#include "engine/output/text_lines.hpp"

#include <algorithm>

#include "engine/output/canvas.hpp"
#include "engine/quantities/code_point.hpp"

namespace mpmfast {
namespace {

/// Bytes of as many letters as have space beside a text of this width; at least one.
std::size_t fitting(const std::string& text, double space) {
  std::size_t end = 0;
  for (double width = 0; end < text.size();) {
    const std::size_t bytes = std::max<std::size_t>(code_point(text, end).bytes, 1);
    width += Canvas::text_width(text.substr(end, bytes));
    if (width > space && end > 0) break;
    end += bytes;
  }
  return end;
}

/// Of a text that is too wide for a line: up to its last blank that fits, else up to the last letter.
std::size_t line_end(const std::string& text, double space) {
  std::size_t end = 0;
  for (std::size_t blank = text.find(' '); blank != std::string::npos; blank = text.find(' ', blank + 1)) {
    if (Canvas::text_width(text.substr(0, blank)) > space) break;
    end = blank;
  }
  return end > 0 ? end : fitting(text, space);
}

}  // namespace

std::vector<std::string> text_lines(const std::string& text, double space, std::size_t most) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (Canvas::text_width(rest) > space && lines.size() + 1 < most) {
    const std::size_t end = line_end(rest, space);
    lines.push_back(rest.substr(0, end));
    rest.erase(0, rest[end] == ' ' ? end + 1 : end);
  }
  if (Canvas::text_width(rest) > space)
    rest = rest.substr(0, fitting(rest, space - Canvas::text_width("..."))) + "...";
  lines.push_back(rest);
  return lines;
}

}  // namespace mpmfast
