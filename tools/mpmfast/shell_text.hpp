#pragma once

#include <string>

namespace mpmfast {

/// The word as a shell would take it: in quotes where it needs them.
std::string shell_text(const std::string& word);

}  // namespace mpmfast
