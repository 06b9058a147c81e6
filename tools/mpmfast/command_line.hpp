#pragma once

/// @file What was asked for on the command line.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/read_scene.hpp"

namespace mpmfast {

enum class Command { new_scene, run, resume, check, study, plot, report, list, schema };
enum class ProgressStyle { automatic, plain, none };

struct CommandLine {
  Command command = Command::run;
  std::string
      scene;  ///< or the study, the folder to plot, to report or to go on with, the name of a new scene
  std::string out, topic, like, title, x = "time_s";
  std::vector<std::string> set;      ///< as written, "time.cfl=0.3"
  std::vector<std::string> folders;  ///< of a plot, one or more; the first is `scene` too
  std::vector<std::string> columns;  ///< of a plot, expressions
  std::vector<std::string> fields;   ///< of a plot, of the particles
  std::string frame, range;          ///< of a plot, as written
  std::vector<std::string> labels;   ///< of a plot: of its runs, or of the columns of the one run
  std::string x_label, y_label;      ///< of a plot, without units; empty if not given
  int threads = 0;
  int jobs = 1;
  std::uint64_t steps = std::numeric_limits<std::uint64_t>::max();
  double until = std::numeric_limits<double>::infinity();  ///< s
  ProgressStyle progress = ProgressStyle::automatic;
  bool force = false;
  bool markdown = false;              ///< the reference page in place of the schema
  bool verbose = false;               ///< of a check: all bodies, passes and columns
  std::vector<std::string> launcher;  ///< of a study: its words
  int restarts = 2;                   ///< of a run that it loses
  std::string text;                   ///< the whole command, quoted for a shell

  std::vector<Override> overrides() const;
};

/// Either what to do, or (help, version, a mistake: already printed) the exit code to leave with.
struct ParsedCommandLine {
  std::optional<CommandLine> line;
  int exit_code = 0;
};
ParsedCommandLine parse_command_line(int count, const char* const* arguments);

}  // namespace mpmfast
