#include "engine/scene/text/yaml_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/scene/text/parts.hpp"

namespace mpmfast {

namespace {

std::size_t indentation(std::string_view line) {
  return std::min(line.find_first_not_of(" \t"), line.size());
}

bool is_blank(std::string_view line) {
  const std::size_t first = indentation(line);
  return first == line.size() || line[first] == '#' || line[first] == '\r';
}

struct Bracket {
  char mark;
  int line, column;
};

/// The brackets of the text up to a place: those still open, and the first that closes what it should not.
class Brackets {
 public:
  std::vector<Bracket> open;
  std::optional<Bracket> wrong;

  Brackets(const std::vector<std::string_view>& lines, int last_line, int last_column) {
    for (int n = 1; n <= last_line && n <= static_cast<int>(lines.size()); ++n)
      read(lines[static_cast<std::size_t>(n) - 1], n, n == last_line ? last_column : 0);
  }

 private:
  /// @param last  the last column that counts; 0: all
  void read(std::string_view line, int number, int last) {
    char before = ' ';
    for (std::size_t at = 0; at < line.size() && !wrong; ++at) {
      if (last > 0 && static_cast<int>(at) + 1 > last) return;
      const char c = line[at];
      const bool fresh = before == ' ' || before == '\t' || before == '[' || before == '{' || before == ',';
      before = c;
      if (quote_ != '\0') {
        if (c == '\\' && quote_ == '"')
          ++at;
        else if (c == quote_)
          quote_ = '\0';
        continue;
      }
      if (c == '#' && fresh) return;
      if (fresh && (c == '\'' || c == '"')) quote_ = c;
      if (line.compare(at, 2, "${") == 0) {
        at = std::min(line.find('}', at), line.size() - 1);
        continue;
      }
      // Within a plain text of a block, brackets are letters.
      if ((c == '[' || c == '{') && (fresh || !open.empty()))
        open.push_back({c, number, static_cast<int>(at) + 1});
      if (c == ']' || c == '}') close({c, number, static_cast<int>(at) + 1});
    }
  }

  void close(const Bracket& mark) {
    const char opens = mark.mark == ']' ? '[' : '{';
    if (open.empty() || open.back().mark != opens)
      wrong = mark;
    else
      open.pop_back();
  }

  char quote_ = '\0';
};

std::optional<YamlFault> tab_fault(const std::vector<std::string_view>& lines, int line) {
  for (int n = std::max(line - 1, 1); n <= line + 1 && n <= static_cast<int>(lines.size()); ++n) {
    const std::string_view text = lines[static_cast<std::size_t>(n) - 1];
    const std::size_t tab = text.substr(0, indentation(text)).find('\t');
    if (tab == std::string_view::npos || is_blank(text)) continue;
    return YamlFault{n, static_cast<int>(tab) + 1, "a tab indents this line", "Use blanks"};
  }
  return std::nullopt;
}

std::optional<YamlFault> bracket_fault(const std::vector<std::string_view>& lines, int line, int column) {
  const Brackets brackets(lines, line, column);
  if (const auto& wrong = brackets.wrong) {
    if (brackets.open.empty())
      return YamlFault{wrong->line, wrong->column, fmt::format("this '{}' closes nothing", wrong->mark), ""};
    const Bracket& last = brackets.open.back();
    return YamlFault{wrong->line, wrong->column,
                     fmt::format("this '{}' meets the '{}' of line {}, column {}", wrong->mark, last.mark,
                                 last.line, last.column),
                     ""};
  }
  if (brackets.open.empty()) return std::nullopt;
  const Bracket& last = brackets.open.back();
  return YamlFault{last.line, last.column, fmt::format("this '{}' is not closed", last.mark),
                   fmt::format("Put a '{}' where it ends", last.mark == '[' ? ']' : '}')};
}

/// What is wrong with lines of keys and values.
std::optional<YamlFault> line_fault(const std::vector<std::string_view>& lines, int line, int column) {
  if (line > static_cast<int>(lines.size())) return std::nullopt;
  const std::string_view text = lines[static_cast<std::size_t>(line) - 1];
  const int first = static_cast<int>(indentation(text)) + 1;
  if (text.substr(0, static_cast<std::size_t>(std::max(column - 1, 0))).find(": ") != std::string_view::npos)
    return YamlFault{line, column, "a second ':' in the value of a key",
                     "Put a text that holds ': ' in quotes"};
  int above = line - 1;
  while (above > 0 && is_blank(lines[static_cast<std::size_t>(above) - 1])) --above;
  if (above == 0) return std::nullopt;
  const std::string_view before = lines[static_cast<std::size_t>(above) - 1];
  const int start = static_cast<int>(indentation(before)) + 1;
  if (before.find(':') == std::string_view::npos && before[static_cast<std::size_t>(start) - 1] != '-')
    return YamlFault{above, start, "no ':' between a key and its value", ""};
  if (const std::size_t colon = before.find(':');
      colon < before.size() - 1 && before.find(": ") == std::string_view::npos)
    return YamlFault{above, static_cast<int>(colon) + 1, "no blank after the ':' of a key", ""};
  if (first > start)
    return YamlFault{
        line, first,
        fmt::format("this line is indented more than line {}, which has its value already", above),
        "Keys of one map begin in one column, entries of a list with '- '"};
  return YamlFault{line, first, "the indentation of this line is that of none above",
                   "Keys of one map begin in one column"};
}

}  // namespace

YamlFault yaml_fault(const std::string& text, int line, int column, const std::string& parser_message) {
  const std::vector<std::string_view> lines = parts_of(text, '\n');
  std::optional<YamlFault> fault = tab_fault(lines, line);
  if (!fault) fault = bracket_fault(lines, line, column);
  const bool about_lines = parser_message == "illegal map value" ||
                           parser_message == "end of map not found" ||
                           parser_message == "end of sequence not found";
  if (!fault && about_lines) fault = line_fault(lines, line, column);
  if (!fault) fault = YamlFault{line, column, parser_message, ""};
  fault->message = "not valid YAML: " + fault->message;
  return *fault;
}

}  // namespace mpmfast
