#pragma once

/// @file Shows where a run stands, on the error stream.

#include <string>

#include "command_line.hpp"
#include "engine/run/run.hpp"

namespace mpmfast {

/// A line that redraws itself on a terminal; elsewhere a plain line when 5 % and 2 s have passed, or a
/// minute.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(ProgressStyle style);
  void show(const Progress& progress);
  /// A line about many runs: redrawn on a terminal, elsewhere printed if it is news.
  void show(const std::string& text, bool news);
  /// Takes the redrawn line away.
  void clear();
  /// Leaves the redrawn line; what follows starts on a line of its own.
  void finish();

 private:
  void redraw(std::string line);
  void print_line(const Progress& progress);

  bool silent_, bar_;
  bool drawn_ = false;
  double last_wall_ = 0, last_share_ = 0;
};

/// "12.3 us", "4.5 s".
std::string time_text(double seconds);
/// "1:02:03", "0:07".
std::string clock_text(double seconds);
/// "12.3 M".
std::string count_text(double number);

}  // namespace mpmfast
