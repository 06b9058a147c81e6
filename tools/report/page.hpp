#pragma once

/// @file One page that shows a run: its words, histories and particles, with all that it needs inside.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace mpmfast {

struct ReportResult {
  std::uint64_t bytes = 0;
  std::vector<std::string> notices;  ///< what the page leaves out, a sentence each
};

/// Writes the page of the run in a folder, whatever came of it. Throws FileError, naming what is missing.
ReportResult write_report(const std::filesystem::path& folder, const std::filesystem::path& html);

}  // namespace mpmfast
