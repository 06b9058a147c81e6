#include "launcher.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "child.hpp"
#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "other_program.hpp"
#include "study_results.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kNamesInBraces{"{threads}", "{name}"};
constexpr int kRefused =
    4;  ///< the exit status of a resume that cannot be, and of files that cannot be written
constexpr std::string_view kCommand = "$ ";  ///< before a command in the log
// A shared folder may show a file only so long after another machine wrote it.
constexpr std::chrono::seconds kShareDelay{30};

/// The first {word} that begins at or after `from`; empty: none.
std::string_view name_in_braces(std::string_view text, std::size_t from) {
  for (std::size_t open = text.find('{', from); open != text.npos; open = text.find('{', open + 1)) {
    std::size_t end = open + 1;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
      ++end;
    if (end < text.size() && text[end] == '}') return text.substr(open, end + 1 - open);
  }
  return {};
}

std::string filled(std::string word, const std::array<std::string, kNamesInBraces.size()>& values) {
  for (std::size_t k = 0; k < values.size(); ++k)
    for (std::size_t at = 0; (at = word.find(kNamesInBraces[k], at)) != word.npos; at += values[k].size())
      word.replace(at, kNamesInBraces[k].size(), values[k]);
  return word;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string last_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (line.find_first_not_of(" \t\r") != line.npos) last = line;
  return last;
}

/// One run, from its first start to its end.
class LaunchedRun {
 public:
  LaunchedRun(const StudyRun& run, const Launch& launch)
      : run_(run),
        launch_(launch),
        folder_(fs::absolute(launch.folder)),
        log_(folder_ / (run.folder + ".log")) {}

  Launched execute(bool anew, const std::function<void(const std::string&)>& again) {
    for (int restart = 0;; ++restart) {
      const bool goes_on = !anew && may_go_on();
      if (!goes_on) clear();
      const int status = start(goes_on);
      const EarlierRun now = result(status);
      if (now.ended) return {false, false, now.note};
      if (is_stopping()) return {false, true, "stopped"};
      const std::string why = reason(status, now);
      if (restart == launch_.restarts || !may_heal(status, now, goes_on))
        return {true, false, fmt::format("lost: {} ({})", why, log_.string())};
      // What is refused says so; what else ends by itself left a checkpoint that does not serve.
      anew = goes_on && (status == kRefused || (!was_killed(status) && !now.stopped));
      again(fmt::format("{}; started again{}, {} of {}", why,
                        !anew && may_go_on() ? " from its checkpoint" : "", restart + 1, launch_.restarts));
    }
  }

 private:
  bool is_stopping() const { return launch_.stop_signal && *launch_.stop_signal; }
  static bool was_killed(int status) { return status > 128; }
  EarlierRun earlier() const { return earlier_run(run_, folder_, 0); }

  /// Is there a checkpoint of this scene by this program, of a run that has not ended?
  bool may_go_on() const {
    const EarlierRun before = earlier();
    std::error_code error;
    return (before.stopped || before.note.empty()) &&
           fs::exists(folder_ / run_.folder / "checkpoint.h5", error) &&
           text_of(order_file(run_, folder_)) == order_text(run_);
  }

  /// Nothing that an earlier run left may be taken for a result of this one, should it never begin.
  void clear() const {
    std::error_code error;
    for (const char* name : {"run.json", "checkpoint.h5"}) fs::remove(folder_ / run_.folder / name, error);
    write_aside(order_file(run_, folder_), order_text(run_));
  }

  std::vector<std::string> words(bool goes_on) const {
    std::vector<std::string> out;
    for (const std::string& word : launch_.words)
      out.push_back(filled(word, {std::to_string(launch_.threads), run_.folder}));
    const fs::path program = run_.program.empty() ? launch_.program : run_.program;
    const fs::path folder = folder_ / run_.folder;
    const std::vector<std::string> command =
        goes_on ? resume_words(program, folder, launch_.threads)
                : run_words(program, order_file(run_, folder_), folder, launch_.threads);
    out.insert(out.end(), command.begin(), command.end());
    return out;
  }

  /// @return the exit status; 127, as of a shell, when there is nothing to start
  int start(bool goes_on) const {
    const std::vector<std::string> command = words(goes_on);
    std::ofstream(log_, std::ios::app) << fmt::format("{}{}\n", kCommand, fmt::join(command, " "));
    ChildOptions options;
    options.log = log_;
    options.stop_signal = launch_.stop_signal;
    options.stop_with = SIGUSR1;  // srun hands it on; SIGTERM and SIGINT make it kill the job
    try {
      return run_child(command, options);
    } catch (const FileError& error) {
      std::ofstream(log_, std::ios::app) << error.what() << '\n';
      return 127;
    }
  }

  /// What the run left, for which we wait where it says that it has ended.
  EarlierRun result(int status) const {
    const auto until = std::chrono::steady_clock::now() + kShareDelay;
    EarlierRun now = earlier();
    while (!now.ended && (status == 0 || status == 3) && now.note.empty() && !is_stopping() &&
           std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      now = earlier();
    }
    return now;
  }

  std::string reason(int status, const EarlierRun& now) const {
    if (now.stopped && status != kRefused) return "somebody stopped it";
    if (!now.note.empty() && !now.stopped) return "what ran does not count, " + now.note;
    if (status == 0 || status == 3)
      return fmt::format("exit status {}, but no run.json: is the folder shared, does the launcher wait?",
                         status);
    const std::string said = last_line(log_);
    return fmt::format("exit status {}{}{}", status,
                       was_killed(status) ? fmt::format(" (signal {})", status - 128) : "",
                       said.starts_with(kCommand) ? "" : ": " + said);
  }

  /// Another start would meet the same mistake where the run ended by itself.
  static bool may_heal(int status, const EarlierRun& now, bool goes_on) {
    if (now.unwritten) return false;
    if (now.stopped) return true;
    if (!now.note.empty()) return false;
    return goes_on || (status != 0 && status != 2 && status != 3);
  }

  const StudyRun& run_;
  const Launch& launch_;
  fs::path folder_, log_;
};

}  // namespace

std::string launcher_mistake(const std::vector<std::string>& words) {
  if (words.empty()) return "a command was expected";
  for (const std::string& word : words)
    for (std::string_view found = name_in_braces(word, 0); !found.empty();
         found = name_in_braces(word, static_cast<std::size_t>(found.data() + found.size() - word.data())))
      if (std::find(kNamesInBraces.begin(), kNamesInBraces.end(), found) == kNamesInBraces.end())
        return fmt::format("unknown name '{}' in braces (one of {})", found, fmt::join(kNamesInBraces, ", "));
  if (find_program(words[0]).empty()) return fmt::format("no program '{}' that could be run", words[0]);
  return "";
}

Launched run_launched(const StudyRun& run, const Launch& launch, bool anew,
                      const std::function<void(const std::string&)>& again) {
  return LaunchedRun(run, launch).execute(anew, again);
}

}  // namespace mpmfast
