#pragma once

/// @file What a study leaves behind: study.csv, study.md and its charts.

#include <filesystem>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace mpmfast {

/// One row a variant: variant, error, particle_steps, wall_s, particle_steps_per_s, pareto, the value on each
/// axis, then what else is known, the study's quantities last. An empty cell is a number that there is not.
std::string study_csv(const Study& study, const StudyRuns& runs, const StudyResults& results);

/// The same for people, in Markdown.
std::string study_table(const Study& study, const StudyRuns& runs, const StudyResults& results);

/// Writes both and draws every chart. Returns what could not be drawn, and why. Throws FileError.
std::vector<std::string> write_report(const Study& study, const StudyRuns& runs, const StudyResults& results,
                                      const std::filesystem::path& folder);

/// Error against cost of every variant, with the front as a line, and a line through the runs of a method
/// that differ by their cells alone. Returns why there is no picture, or nothing.
std::string draw_cost_chart(const Study& study, const StudyRuns& runs, const StudyResults& results,
                            const std::filesystem::path& folder, Cost cost, const std::string& stem);

}  // namespace mpmfast
