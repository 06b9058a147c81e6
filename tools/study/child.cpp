#include "child.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

#include "engine/output/files.hpp"

extern char** environ;

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

/// How a child starts: its streams, its process group, its signals.
class SpawnSettings {
 public:
  explicit SpawnSettings(const fs::path& log) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    const char* out = log.empty() ? "/dev/null" : log.c_str();
    posix_spawn_file_actions_addopen(&files, 1, out, O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (!log.empty()) posix_spawn_file_actions_adddup2(&files, 1, 2);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setpgroup(&attributes, 0);
    sigset_t usual;  // what we ignore is no business of the child
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    sigaddset(&usual, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

pid_t start(std::vector<std::string> words, const fs::path& log) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const SpawnSettings settings(log);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &settings.files, &settings.attributes, arguments.data(), environ);
  if (error != 0) throw_file_error("start the program", words[0], error);
  return child;
}

}  // namespace

fs::path find_program(const std::string& word) {
  const auto runs = [](const fs::path& path) {
    std::error_code error;
    return access(path.c_str(), X_OK) == 0 && !fs::is_directory(path, error);
  };
  if (word.empty()) return {};
  if (word.find('/') != std::string::npos) return runs(word) ? fs::path(word) : fs::path();
  const char* found = std::getenv("PATH");
  std::istringstream folders(found ? found : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path path = fs::path(folder.empty() ? "." : folder) / word; runs(path)) return path;
  return {};
}

int run_child(const std::vector<std::string>& words, const ChildOptions& options) {
  const pid_t child = start(words, options.log);
  bool told = false;
  int status = 0;
  for (pid_t ended = 0; ended != child;) {
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) throw_file_error("wait for the program", words[0]);
    if (!told && options.stop_signal && *options.stop_signal) {
      kill(-child, options.stop_with);
      told = true;
    }
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace mpmfast
