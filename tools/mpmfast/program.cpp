/// @file Every way to end, and its exit code, is here (design §3).

#include "program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <ios>
#include <new>
#include <system_error>

#include "commands.hpp"
#include "complain.hpp"
#include "engine/errors.hpp"
#include "engine/run/threads.hpp"
#include "engine/scene/text/diagnostic.hpp"
#include "exit_codes.hpp"

namespace {

using namespace mpmfast;

int perform(const CommandLine& line) {
  switch (line.command) {
    case Command::new_scene:
      return new_command(line);
    case Command::run:
      return run_command(line);
    case Command::resume:
      return resume_command(line);
    case Command::check:
      return check_command(line);
    case Command::study:
      return study_command(line);
    case Command::plot:
      return plot_command(line);
    case Command::report:
      return report_command(line);
    case Command::list:
      return list_command(line);
    case Command::schema:
      return schema_command(line);
  }
  return kExitWrongInput;
}

/// A stream that is closed would lend its number to the next file that is opened, the history of a run say,
/// and messages would go there. What holds the number instead takes none.
void hold_closed_streams() {
  for (int stream = 0; stream < 3; ++stream)
    if (fcntl(stream, F_GETFD) < 0) (void)open("/dev/null", O_RDONLY);
}

/// What helps where there was too little memory for a command.
const char* way_out_of_memory(Command command) {
  switch (command) {
    case Command::run:
    case Command::resume:
    case Command::study:
      return "'mpmfast check' tells how much a scene needs";
    case Command::check:
      return "Take larger cells, fewer particles_per_cell or fewer bodies at one place";
    default:
      return "Fewer frames, rows or particles take less";
  }
}

int perform_and_report(int count, char** arguments) {
  Command command = Command::run;
  try {
    const ParsedCommandLine parsed = parse_command_line(count, arguments);
    if (!parsed.line) return parsed.exit_code;
    command = parsed.line->command;
    return perform(*parsed.line);
  } catch (const SceneError& error) {
    const std::size_t count = error.diagnostics().size();
    complain("{}\n{} error{}\n", error.what(), count, count == 1 ? "" : "s");
    return kExitWrongInput;
  } catch (const FileError& error) {
    complain("mpmfast: {}\n", error.what());
    return kExitFile;
  } catch (const RunFailure& error) {
    complain("mpmfast: the run failed: {}\n", error.what());
    return kExitRunFailed;
  } catch (const std::filesystem::filesystem_error& error) {
    complain("mpmfast: cannot look at {}: {}\n", error.path1().string(), error.code().message());
    return kExitFile;
  } catch (const std::ios_base::failure& error) {
    complain("mpmfast: a file could not be read: {}\n", error.what());
    return kExitFile;
  } catch (const std::system_error& error) {
    const bool closed = std::ferror(stdout) != 0;
    complain("mpmfast: {}{}\n", closed ? "the output could not be written: " : "", error.what());
    return kExitFile;
  } catch (const std::bad_alloc&) {
    complain("mpmfast: out of memory. {}\n", way_out_of_memory(command));
    return kExitRunFailed;
  } catch (const std::exception& error) {
    complain("mpmfast: internal error: {}\n", error.what());
    return kExitRunFailed;
  }
}

}  // namespace

int mpmfast::run_program(int count, char** arguments) {
  // What a frame or a picture took goes back to the system at once, rather than to lie between other things.
  mallopt(M_MMAP_THRESHOLD, 128 << 10);
  hold_closed_streams();
  wait_quietly(arguments);
  const int code = perform_and_report(count, arguments);
  if (code == 0 && (std::fflush(stdout) != 0 || std::ferror(stdout))) {
    complain("mpmfast: the output could not be written\n");
    return kExitFile;
  }
  return code;
}
