#pragma once

/// @file Why a text is no YAML, in words that help: the parser names what it missed, not what was done.

#include <string>

namespace mpmfast {

struct YamlFault {
  int line = 0,
      column = 0;  ///< 1-based: of what is to be mended, which may be above where the parser stopped
  std::string message, hint;
};

/// @param line, column  where the parser stopped, 1-based
/// @param parser_says   what it missed there
YamlFault yaml_fault(const std::string& text, int line, int column, const std::string& parser_message);

}  // namespace mpmfast
