#pragma once

/// @file The threads of a step. They start once and wait awake for what there is to do: OpenMP's own
/// wait between two loops either takes the processor from other programs or falls asleep, and waking a thread
/// costs more than a short loop. These sleep only where others want the processor, or after some 5 ms.

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>

#include "engine/state/function_ref.hpp"

namespace mpmfast {

class ThreadTeam;

/// The index of this thread in its parallel region, 0 outside one. Not OpenMP's: a simulation
/// may be one of many in a parallel region of the caller's.
inline int& thread_index() {
  static thread_local int number = 0;
  return number;
}

/// One thread of a parallel region.
struct TeamThread {
  int thread = 0, threads = 1;
  ThreadTeam* team = nullptr;

  void wait_for_all() const;  ///< until all threads of the region have come so far
};

/// A number that threads wait for.
struct alignas(64) Signal {
  std::atomic<int> value{0}, sleepers{0};
};

class ThreadTeam {
 public:
  /// Calls work() on this thread, while threads − 1 others wait for what on_threads() hands them. What work()
  /// throws comes out when they have gone. Where threads are at work already it is just called.
  template <class Work>
  static void parallel_region(int threads, const Work& work) {
    if (threads <= 1 || omp_in_parallel()) return work();
    ThreadTeam team;
    std::exception_ptr thrown;
#pragma omp parallel num_threads(threads)
    {
      if (const int thread = omp_get_thread_num(); thread > 0) {
        team.serve(thread);
      } else {
        team.size_ = omp_get_num_threads();
        of_this_thread() = &team;
        try {
          work();
        } catch (...) {
          thrown = std::current_exception();
        }
        of_this_thread() = nullptr;
        team.dismiss();
      }
    }
    if (thrown) std::rethrow_exception(thrown);
  }

  /// Calls f(thread) on the threads of the team that this one leads and that have nothing to do. What f
  /// throws ends the program, as in a parallel region.
  /// @param most  so many of them at most
  /// @return false, and nothing done, if there is none
  static bool run_on_team(int most, FunctionRef<void(const TeamThread&)> f);

 private:
  friend struct TeamThread;
  using Job = FunctionRef<void(const TeamThread&)>;

  static ThreadTeam*& of_this_thread();  ///< the team of which this thread is the first
  void run(int most, const Job& job) noexcept;
  void serve(int thread);
  void dismiss();
  void wait_for_all();

  int size_ = 1, busy_ = 0;
  const Job* job_ = nullptr;
  int running_ = 1;
  Signal called_;  ///< rises with every job
  Signal done_;    ///< threads that have done theirs
  Signal passed_;  ///< rises when all have arrived
  std::atomic<int> arrived_{0};
};

/// Calls f(thread) on so many threads at once; on this one alone where threads are at work already.
void on_threads(int threads, FunctionRef<void(const TeamThread&)> f);

/// Calls f(begin, end) for stretches that make up [0, n), one a thread and in their order; for all at once
/// where there are no more than a few.
template <class F>
void for_each_stretch(std::int64_t n, int threads, std::int64_t few, const F& f) {
  on_threads(n <= few ? 1 : threads,
             [&](const TeamThread& me) { f(n * me.thread / me.threads, n * (me.thread + 1) / me.threads); });
}

/// Calls f(k) for all k of [0, n), each thread those of a stretch.
template <class F>
void for_each_of(std::int64_t n, int threads, std::int64_t few, const F& f) {
  for_each_stretch(n, threads, few, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) f(k);
  });
}

/// Calls f(k) for all k of [0, n), where some take longer than others: a thread that is done takes more, so
/// many at a time.
template <class F>
void share_out(std::int64_t n, int threads, std::int64_t at_once, const F& f) {
  std::atomic<std::int64_t> next{0};
  on_threads(n <= at_once ? 1 : threads, [&](const TeamThread&) {
    for (;;) {
      const std::int64_t begin = next.fetch_add(at_once, std::memory_order_relaxed);
      if (begin >= n) return;
      for (std::int64_t k = begin; k < std::min(n, begin + at_once); ++k) f(k);
    }
  });
}

}  // namespace mpmfast
