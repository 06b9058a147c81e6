#include "other_program.hpp"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "child.hpp"
#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/output/hash.hpp"
#include "engine/output/output.hpp"
#include "engine/scene/text/diagnostic.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

// Exit statuses of the command line; the signals are those that ask a run to stop
// (tools/mpmfast/signals.cpp).
constexpr std::array<std::pair<int, const char*>, 10> kEndings{{{0, "finished"},
                                                                {3, "failed"},
                                                                {128 + SIGHUP, "stopped"},
                                                                {128 + SIGINT, "stopped"},
                                                                {128 + SIGQUIT, "stopped"},
                                                                {128 + SIGUSR1, "stopped"},
                                                                {128 + SIGUSR2, "stopped"},
                                                                {128 + SIGALRM, "stopped"},
                                                                {128 + SIGTERM, "stopped"},
                                                                {128 + SIGXCPU, "stopped"}}};

void add_common(std::vector<std::string>& words, int threads) {
  words.insert(words.end(), {"--progress", "none"});
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
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
      if (has_control_character(path)) {  // it stands in a comment of the scenes that it runs
        problems.add(choice.program->location, choice.program->path, "holds a control character");
      } else if (find_program(path).empty())
        problems.add(choice.program->location, choice.program->path,
                     fmt::format("no program '{}' that could be run", path.string()));
    }
  if (problems.count() > 0) throw SceneError(problems.sorted());
}

std::string order_text(const StudyRun& run) {
  if (run.program.empty()) return fmt::format("# for {}\n{}", program_text(), run.scene.resolved_yaml);
  std::ifstream file(run.program, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) throw_file_error("read the program", run.program);
  return fmt::format("# for {} ({:016x})\n{}", run.program.string(), XXH64(bytes.data(), bytes.size(), 0),
                     run.scene.resolved_yaml);
}

fs::path order_file(const StudyRun& run, const fs::path& folder) { return folder / (run.folder + ".yaml"); }

std::vector<std::string> run_words(const fs::path& program, const fs::path& order, const fs::path& folder,
                                   int threads) {
  std::vector<std::string> words{program.string(), "run",           order.string(),
                                 "--out",          folder.string(), "--force"};
  add_common(words, threads);
  return words;
}

std::vector<std::string> resume_words(const fs::path& program, const fs::path& folder, int threads) {
  std::vector<std::string> words{program.string(), "resume", folder.string()};
  add_common(words, threads);
  return words;
}

std::string run_by_program(const StudyRun& run, const fs::path& folder, int threads,
                           const volatile int* stop_signal) {
  const fs::path scene = order_file(run, folder), summary = folder / run.folder / "run.json";
  std::error_code error;
  fs::remove(summary, error);  // of an earlier program, should this one never begin
  write_aside(scene, order_text(run));
  ChildOptions options;  // its summary is in run.json; its messages are for the user
  options.stop_signal = stop_signal;
  const int status = run_child(run_words(run.program, scene, folder / run.folder, threads), options);
  for (const auto& [code, ending] : kEndings)
    if (status == code) return ending;
  fs::remove(summary, error);  // a disk that was full is no result
  throw FileError(
      fmt::format("{} run {} ended with exit status {}", run.program.string(), scene.string(), status));
}

}  // namespace mpmfast
