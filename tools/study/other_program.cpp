#include "other_program.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <vector>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/output/hash.hpp"
#include "engine/scene/text/diagnostic.hpp"

extern char** environ;

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

// Exit statuses of the command line.
constexpr std::array<std::pair<int, const char*>, 5> kEndings{
    {{0, "finished"}, {3, "failed"}, {129, "stopped"}, {130, "stopped"}, {143, "stopped"}}};

/// @return the exit status, 128 + N after signal N
int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

fs::path program_path(const Study& study, const Setting& asked) {
  return fs::absolute(study.file.parent_path() / asked.override.second).lexically_normal();
}

void check_programs(const Study& study) {
  Problems problems({study.file.string()});
  for (const Axis& axis : study.axes)
    for (const Choice& choice : axis.choices) {
      if (!choice.program) continue;
      const fs::path path = program_path(study, *choice.program);
      if (access(path.c_str(), X_OK) != 0 || fs::is_directory(path))
        problems.add(choice.program->place, choice.program->path,
                     fmt::format("no program '{}' that could be run", path.string()));
    }
  if (problems.count() > 0) throw SceneError(problems.sorted());
}

std::string order_text(const StudyRun& run) {
  std::ifstream file(run.program, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) throw_file_error("read the program", run.program);
  return fmt::format("# for {} ({:016x})\n{}", run.program.string(), XXH64(bytes.data(), bytes.size(), 0),
                     run.scene.resolved_yaml);
}

fs::path order_file(const StudyRun& run, const fs::path& folder) { return folder / (run.folder + ".yaml"); }

std::string run_by_program(const StudyRun& run, const fs::path& folder, int threads) {
  const fs::path scene = order_file(run, folder);
  write_aside(scene, order_text(run));
  std::vector<std::string> words{run.program.string(),           "run",     scene.string(), "--out",
                                 (folder / run.folder).string(), "--force", "--progress",   "none"};
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t quiet;  // its summary is in run.json; its messages are for the user
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", 1 /* O_WRONLY */, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, run.program.c_str(), &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (error != 0) throw_file_error("start the program", run.program, error);
  const int status = wait_for(child);
  for (const auto& [code, ending] : kEndings)
    if (status == code) return ending;
  throw FileError(
      fmt::format("{} run {} ended with exit status {}", run.program.string(), scene.string(), status));
}

}  // namespace mpmfast
