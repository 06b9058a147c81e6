#pragma once

/// @file Another program: found, started, waited for, and asked to stop when we are.

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

namespace mpmfast {

/// The file that a shell would run for the word: itself where it has a slash, else from PATH. Empty: none.
std::filesystem::path find_program(const std::string& word);

struct ChildOptions {
  std::filesystem::path
      log;  ///< gets both streams, at its end; empty: errors go where ours go, the rest nowhere
  const volatile int* stop_signal = nullptr;  ///< non-zero: the child is to stop
  int stop_with = SIGTERM;                    ///< what tells it so
};

/// Starts the words as a program with nothing to read and waits for its end. It is in a process group of its
/// own: Ctrl-C reaches it through us. @return its exit status, 128 + N after signal N. Throws FileError when
/// it cannot be started.
int run_child(const std::vector<std::string>& words, const ChildOptions& options);

}  // namespace mpmfast
