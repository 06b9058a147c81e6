/// @file Every way to end, and its exit code, is here (design §3).

#include "program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>

#include <cstdio>
#include <exception>
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

int perform_and_report(int count, char** arguments) {
  try {
    const ParsedCommandLine parsed = parse_command_line(count, arguments);
    return parsed.line ? perform(*parsed.line) : parsed.exit_code;
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
  } catch (const std::system_error& error) {  // of a stream that is closed
    complain("mpmfast: the output could not be written: {}\n", error.what());
    return kExitFile;
  } catch (const std::bad_alloc&) {
    complain("mpmfast: out of memory ('mpmfast check' tells how much a scene needs)\n");
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
