#include "study_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "engine/geometry/read_regular.hpp"

namespace mpmfast {

namespace fs = std::filesystem;

std::string other_study(const Study& study, const StudyRuns& runs, const fs::path& folder) {
  const fs::path copy = folder / "study.yaml";
  std::error_code error;
  if (!fs::exists(fs::symlink_status(copy, error))) return "";
  constexpr std::uintmax_t kLargestFile = 16u << 20;  // bytes, as of a study
  std::string why_not;
  if (read_regular(copy, kLargestFile, why_not) == study.text) return "";
  const auto is_there = [&](const StudyRun& run) { return fs::is_directory(folder / run.folder, error); };
  if (std::any_of(runs.variants.begin(), runs.variants.end(), is_there) ||
      std::any_of(runs.references.begin(), runs.references.end(), is_there))
    return "";
  return fmt::format("{} is another study, none of whose runs is one of this", copy.string());
}

}  // namespace mpmfast
