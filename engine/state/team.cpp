#include "engine/state/team.hpp"

#include <chrono>
#include <thread>

namespace mpmfast {

namespace {

inline void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Until done(value of watched). A turn that the processor gave to others was long: then they need it, and
/// this thread sleeps until it is called.
template <class Done>
void await(const std::atomic<int>& watched, const Done& done) {
  using Clock = std::chrono::steady_clock;
  constexpr int kSpins = 200, kTurns = 10000;  // some 10 µs, some 5 ms
  constexpr auto kLong = std::chrono::microseconds(50);
  for (int k = 0; k < kSpins; ++k) {
    if (done(watched.load(std::memory_order_acquire))) return;
    relax();
  }
  for (int turn = 0;; ++turn) {
    const int value = watched.load(std::memory_order_acquire);
    if (done(value)) return;
    const auto before = Clock::now();
    std::this_thread::yield();
    if (turn < kTurns && Clock::now() - before < kLong) continue;
    watched.wait(value);
    turn = 0;
  }
}

}  // namespace

void Member::wait_for_all() const {
  if (threads == 1) return;
  if (team) return team->wait_for_all();
#pragma omp barrier
}

Team*& Team::led() {
  static thread_local Team* team = nullptr;
  return team;
}

void Team::run(int most, Job job, const void* of) {
  job_ = job;
  of_ = of;
  members_ = std::min(most, size_);
  done_.store(0, std::memory_order_relaxed);
  called_.fetch_add(1);
  called_.notify_all();
  busy_ = 1;
  job(of, {0, members_, this});
  busy_ = 0;
  await(done_, [&](int done) { return done == size_ - 1; });
}

void Team::serve(int thread) {
  for (int seen = 0;; ++seen) {
    await(called_, [&](int called) { return called != seen; });
    if (!job_) return;
    if (thread < members_) job_(of_, {thread, members_, this});
    if (done_.fetch_add(1) == size_ - 2) done_.notify_all();
  }
}

void Team::dismiss() {
  job_ = nullptr;
  called_.fetch_add(1);
  called_.notify_all();
}

void Team::wait_for_all() {
  const int passed = passed_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1) == members_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    passed_.fetch_add(1);
    passed_.notify_all();
  } else {
    await(passed_, [&](int now) { return now != passed; });
  }
}

}  // namespace mpmfast
