#pragma once

/// @file Is this text at all? yaml-cpp reads UTF-16 and binary files without a complaint.

#include <string>

#include "engine/scene/text/problems.hpp"

namespace mpmfast {

/// UTF-8 without control characters (but tab and line ends). Notes the first offence.
bool check_text(const std::string& text, int source, Problems& problems);

}  // namespace mpmfast
