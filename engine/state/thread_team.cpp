#include "engine/state/thread_team.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <thread>

#include "engine/constants.hpp"

namespace mpmfast {

namespace {

inline void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// As FUTEX_WAIT and FUTEX_WAKE: std::atomic::wait gives way some times before it sleeps.
void futex(std::atomic<int>& of, int operation, int value) {
  static_assert(sizeof(of) == sizeof(int));
  syscall(SYS_futex, &of, operation | FUTEX_PRIVATE_FLAG, value, nullptr, nullptr, 0);
}

/// Waits of this thread in which it sleeps soon, and in which another long turn means that it is to.
thread_local int crowded = 0, alert = 0;

/// Until done(value). A thread spins, then gives way to others for a turn at a time. If turns are long time
/// and again, others need the processor: each turn would cost a slice of their time, so that for a while this
/// thread sleeps until it is called, which the scheduler is quick to heed.
template <class Done>
void await(Signal& signal, const Done& done) {
  using Clock = std::chrono::steady_clock;
  using namespace constants::threads;
  for (int k = 0; k < kSpins; ++k) {
    if (done(signal.value.load(std::memory_order_acquire))) return;
    relax();
  }
  if (alert > 0) --alert;
  for (int turn = 0; crowded == 0 && turn < kYields; ++turn) {
    const auto before = Clock::now();
    std::this_thread::yield();
    if (Clock::now() - before > kLongTurn) {
      if (alert > 0) crowded = kSleepingWaits;
      alert = kAlertWaits;
    }
    if (done(signal.value.load(std::memory_order_acquire))) return;
  }
  if (crowded > 0) --crowded;
  for (;;) {
    signal.sleepers.fetch_add(1);
    const int value = signal.value.load();
    if (!done(value)) futex(signal.value, FUTEX_WAIT, value);
    signal.sleepers.fetch_sub(1);
    if (done(signal.value.load(std::memory_order_acquire))) return;
  }
}

/// To all that wait for this signal.
void call(Signal& signal) {
  if (signal.sleepers.load() > 0) futex(signal.value, FUTEX_WAKE, std::numeric_limits<int>::max());
}

}  // namespace

void TeamThread::wait_for_all() const {
  if (threads == 1) return;
  if (team) return team->wait_for_all();
#pragma omp barrier
}

ThreadTeam*& ThreadTeam::of_this_thread() {
  static thread_local ThreadTeam* team = nullptr;
  return team;
}

bool ThreadTeam::run_on_team(int most, Job f) {
  ThreadTeam* team = of_this_thread();
  if (!team || team->busy_) return false;
  team->run(most, f);
  return true;
}

void ThreadTeam::run(int most, const Job& job) noexcept {
  job_ = &job;
  running_ = std::min(most, size_);
  done_.value.store(0, std::memory_order_relaxed);
  called_.value.fetch_add(1);
  call(called_);
  busy_ = 1;
  job({0, running_, this});
  busy_ = 0;
  await(done_, [&](int done) { return done == size_ - 1; });
}

void ThreadTeam::serve(int thread) {
  thread_index() = thread;
  for (int seen = 0;; ++seen) {
    await(called_, [&](int called) { return called != seen; });
    if (!job_) break;
    if (thread < running_) (*job_)({thread, running_, this});
    if (done_.value.fetch_add(1) == size_ - 2) call(done_);
  }
  thread_index() = 0;
}

void ThreadTeam::dismiss() {
  job_ = nullptr;
  called_.value.fetch_add(1);
  call(called_);
}

void ThreadTeam::wait_for_all() {
  const int passed = passed_.value.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1) == running_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    passed_.value.fetch_add(1);
    call(passed_);
  } else {
    await(passed_, [&](int now) { return now != passed; });
  }
}

void on_threads(int threads, FunctionRef<void(const TeamThread&)> f) {
  if (threads <= 1) return f(TeamThread{});
  if (ThreadTeam::run_on_team(threads, f)) return;
  if (omp_in_parallel()) return f(TeamThread{});
#pragma omp parallel num_threads(threads)
  {
    thread_index() = omp_get_thread_num();
    f(TeamThread{omp_get_thread_num(), omp_get_num_threads(), nullptr});
    thread_index() = 0;
  }
}

}  // namespace mpmfast
