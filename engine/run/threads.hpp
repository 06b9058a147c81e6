#pragma once

/// @file How many threads a run has, and how long they spin before they sleep when they wait for each other.

namespace mpmfast {

inline constexpr int kMostThreads = 4096;

/// While it lives, parallel regions of this thread have so many threads; then as many as before.
class ThreadCount {
 public:
  /// @param threads  0: as it is
  explicit ThreadCount(int threads);
  ~ThreadCount();
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

/// Spinning for long, libgomp's default, makes a run ten times slower as soon as another program wants one of
/// its cores. libgomp reads its settings before main: unless the user has set one, the program sets a short
/// spin and starts itself again. Returns where that is not needed or not possible.
void wait_quietly(char** arguments);

}  // namespace mpmfast
