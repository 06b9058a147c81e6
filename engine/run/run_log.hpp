#pragma once

/// @file run.log: what a terminal that is gone would have shown.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/output/output.hpp"

namespace mpmfast {

/// Says what runs, then a line for each row of the history, each kind of warning when it first holds, and at
/// the end how the run went and how often each warning held. A log that cannot be written stops nothing.
class RunLog {
 public:
  /// Goes on with the log that is there when the run was resumed.
  RunLog(const std::filesystem::path& folder, const RunSummary& figures);
  void row(const RunSummary& figures, double dt);
  void close(const RunSummary& summary);

 private:
  struct Counted {
    RunWarning warning;
    std::uint64_t rows = 0;
  };
  void count(const RunSummary& figures);

  std::ofstream file_;
  std::uint64_t rows_ = 0;
  std::vector<Counted> warnings_;
};

}  // namespace mpmfast
