#include <fmt/format.h>

#include <cstdio>

#include "commands.hpp"
#include "complain.hpp"
#include "exit_codes.hpp"
#include "plot_files.hpp"
#include "plot_history.hpp"
#include "plot_particles.hpp"

namespace mpmfast {

int plot_command(const CommandLine& line) {
  if (const std::string wrong = contradiction(line); !wrong.empty()) {
    complain("mpmfast: {}\n", wrong);
    return kExitWrongInput;
  }
  for (const std::string& folder : line.folders) check_run_folder(folder);
  const PlotFiles files = plot_files(line);
  const bool particles = asks_for_particles(line);
  if (particles && line.columns.empty()) return plot_particles(line, files);
  const int code = plot_history(line, files);
  const bool usual = line.columns.empty() && has_particle_files(line.scene);
  if (code == kExitWrongInput || !(particles || usual)) return code;
  const int drawn = plot_particles(line, files);
  return drawn != 0 ? drawn : code;
}

}  // namespace mpmfast
