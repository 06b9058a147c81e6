#pragma once

/// @file What holds where: a map for each value of one axis, its columns another, its rows the rest.

#include <filesystem>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace mpmfast {

/// A table of all maps, in Markdown.
std::string map_overview(const Study& study, const StudyRuns& runs, const StudyResults& results);

/// For people, in Markdown: a table of all maps, then of each what its scene says, what must hold, its chart
/// and what does not hold.
std::string map_page(const Study& study, const StudyRuns& runs, const StudyResults& results);

/// A chart a map, map_NAME.svg. Returns what could not be drawn, and why. Throws FileError.
std::vector<std::string> draw_maps(const Study& study, const StudyRuns& runs, const StudyResults& results,
                                   const std::filesystem::path& folder);

}  // namespace mpmfast
