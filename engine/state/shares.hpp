#pragma once

/// @file Who does what in a loop over tiles, contact nodes or blocks: a thread begins with its own share, so
/// that it meets in every loop the particles and nodes that it met in the last one and still has in its
/// caches, and helps the others when it is done.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>

#include "engine/state/thread_team.hpp"

namespace mpmfast {

class Shares {
 public:
  explicit Shares(int most_threads)
      : most_(most_threads), shares_(std::make_unique<Share[]>(static_cast<std::size_t>(most_threads))) {}

  /// For the next loop, of n turns, so many of which are taken together. Called by one thread, before the
  /// others begin.
  void cut(int threads, std::int64_t n, std::int64_t at_once) {
    cut_at(threads, at_once, [&](int t) { return n * t / std::min(threads, most_); });
  }

  /// The same, where thread t begins with turn begin(t) and the last one ends before begin(threads).
  template <class Begin>
  void cut_at(int threads, std::int64_t at_once, const Begin& begin) {
    threads_ = std::min(threads, most_);
    at_once_ = at_once;
    for (int t = 0; t < threads_; ++t) {
      shares_[static_cast<std::size_t>(t)].next.store(begin(t), std::memory_order_relaxed);
      shares_[static_cast<std::size_t>(t)].end = begin(t + 1);
    }
  }

  /// Calls f(turn) for turns that nobody else takes, until all are taken.
  template <class F>
  void for_each(int thread, const F& f) {
    for (int k = 0; k < threads_; ++k) {
      Share& share = shares_[static_cast<std::size_t>((thread + k) % threads_)];
      for (;;) {
        const std::int64_t begin = share.next.fetch_add(at_once_, std::memory_order_relaxed);
        if (begin >= share.end) break;
        for (std::int64_t turn = begin; turn < std::min(begin + at_once_, share.end); ++turn) f(turn);
      }
    }
  }

 private:
  struct alignas(64) Share {
    std::atomic<std::int64_t> next{0};
    std::int64_t end = 0;
  };
  int most_, threads_ = 0;
  std::int64_t at_once_ = 1;
  std::unique_ptr<Share[]> shares_;
};

/// Calls f(k) for all k of [0, n), so many at a time, each thread those of its own share first; by one thread
/// where there are no more than a few.
template <class F>
void share_out(Shares& shares, std::int64_t n, int threads, std::int64_t at_once, std::int64_t few,
               const F& f) {
  const int asked = n <= few ? 1 : threads;
  shares.cut(asked, n, at_once);
  on_threads(asked, [&](const TeamThread& me) { shares.for_each(me.thread, f); });
}

}  // namespace mpmfast
