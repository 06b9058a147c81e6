#pragma once

/// @file Whether a study may write into a folder.

#include <filesystem>
#include <string>

#include "study.hpp"

namespace mpmfast {

/// Why the folder is not for this study, without `--force`; empty when it is. It may be new or empty, hold
/// the same study, or one that this one goes on from: of which at least a run is one of its own.
std::string other_study(const Study& study, const StudyRuns& runs, const std::filesystem::path& folder);

}  // namespace mpmfast
