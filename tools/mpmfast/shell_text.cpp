#include "shell_text.hpp"

namespace mpmfast {

std::string shell_text(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t\n'\"\\$`[]{}()*?&|;<>#!~") == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::optional<std::vector<std::string>> shell_words(const std::string& text) {
  std::vector<std::string> words;
  bool inside = false;  // a word, perhaps an empty one between quotes
  char quote = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (!quote && blank) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (c == quote) {
      quote = 0;
    } else if (!quote && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == '\\' && quote != '\'') {
      if (++k == text.size()) return std::nullopt;
      if (quote && text[k] != '"' && text[k] != '\\' && text[k] != '$' && text[k] != '`') words.back() += c;
      words.back() += text[k];
    } else {
      words.back() += c;
    }
  }
  if (quote) return std::nullopt;
  return words;
}

}  // namespace mpmfast
