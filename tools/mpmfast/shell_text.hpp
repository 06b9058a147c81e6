#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mpmfast {

/// The word as a shell would take it: in quotes where it needs them.
std::string shell_text(const std::string& word);

/// The words that a shell would make of the text: at blanks, with 'quotes', "quotes" and backslashes, and
/// nothing else that a shell does. Nothing where a quote is not closed or a backslash ends the text.
std::optional<std::vector<std::string>> shell_words(const std::string& text);

}  // namespace mpmfast
