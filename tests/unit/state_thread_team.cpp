/// Threads that are gathered once and do many things together.

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "engine/state/shares.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

constexpr int kThreads = 4;

/// Everything a loop does of its turns, in a gathered team and outside of one.
template <class Check>
void in_both(const Check& check) {
  check();
  ThreadTeam::parallel_region(kThreads, check);
}

TEST_CASE("each turn of a loop is taken once, whoever takes it") {
  in_both([] {
    for (const std::int64_t n : {0, 1, 3, 4, 5, 1000}) {
      std::vector<int> taken(static_cast<std::size_t>(n)), shared = taken, own_first = taken;
      Shares shares(kThreads);
      share_out(shares, n, kThreads, 3, 1, [&](std::int64_t k) { ++own_first[static_cast<std::size_t>(k)]; });
      for_each_of(n, kThreads, 1, [&](std::int64_t k) { ++taken[static_cast<std::size_t>(k)]; });
      share_out(n, kThreads, 3, [&](std::int64_t k) { ++shared[static_cast<std::size_t>(k)]; });
      CHECK(taken == std::vector<int>(static_cast<std::size_t>(n), 1));
      CHECK(shared == taken);
      CHECK(own_first == taken);
    }
  });
}

TEST_CASE("a thread takes the turns of its own share before those of the others") {
  const std::vector<int> begin{0, 5, 5, 12, 20};  // the second has none
  Shares shares(kThreads);
  for (int thread = 0; thread < kThreads; ++thread) {
    shares.cut_at(kThreads, 2, [&](int t) { return begin[static_cast<std::size_t>(t)]; });
    std::vector<std::int64_t> turns, wanted;
    shares.for_each(thread, [&](std::int64_t turn) { turns.push_back(turn); });
    for (int k = 0; k < kThreads; ++k) {
      const auto of = static_cast<std::size_t>((thread + k) % kThreads);
      for (int turn = begin[of]; turn < begin[of + 1]; ++turn) wanted.push_back(turn);
    }
    CHECK(turns == wanted);
  }
}

TEST_CASE("stretches follow each other in the order of the threads") {
  in_both([] {
    std::vector<int> of(1000, -1);
    for_each_stretch(1000, kThreads, 1, [&](std::int64_t begin, std::int64_t end) {
      std::fill(of.begin() + begin, of.begin() + end, omp_get_thread_num());
    });
    CHECK(std::is_sorted(of.begin(), of.end()));
    CHECK(of.front() == 0);
    CHECK(of.back() == kThreads - 1);
  });
}

// Each writes one number, and after the barrier reads that of the next; without it some would see an old one.
TEST_CASE("after a barrier each thread sees what all have written before it") {
  in_both([] {
    std::vector<int> written(kThreads, 0);
    std::atomic<int> wrong{0}, members{0};
    for (int job = 0; job < 200; ++job)
      on_threads(kThreads, [&](const TeamThread& me) {
        members += me.threads;
        for (int turn = 0; turn < 20; ++turn) {
          const int value = 20 * job + turn;
          written[static_cast<std::size_t>(me.thread)] = value;
          me.wait_for_all();
          wrong += written[static_cast<std::size_t>((me.thread + 1) % me.threads)] != value;
          me.wait_for_all();
        }
      });
    CHECK(wrong == 0);
    CHECK(members == 200 * kThreads * kThreads);
  });
}

TEST_CASE("a part of the team can do something alone, and waits for its own only") {
  ThreadTeam::parallel_region(kThreads, [] {
    std::atomic<int> there{0};
    on_threads(2, [&](const TeamThread& me) {
      CHECK(me.threads == 2);
      ++there;
      me.wait_for_all();
    });
    CHECK(there == 2);
  });
}

TEST_CASE("a loop within a loop is the calling thread's alone") {
  in_both([] {
    std::vector<std::atomic<int>> taken(kThreads * 10);
    on_threads(kThreads, [&](const TeamThread& me) {
      for_each_of(10, kThreads, 1, [&](std::int64_t k) {
        ++taken[static_cast<std::size_t>(me.thread * 10 + static_cast<int>(k))];
      });
      on_threads(kThreads, [&](const TeamThread& alone) {
        CHECK(alone.threads == 1);
        alone.wait_for_all();
      });
    });
    for (const auto& once : taken) CHECK(once == 1);
  });
}

TEST_CASE("what is thrown comes out of the gathering, and the next one works") {
  for (int k = 0; k < 3; ++k) {
    CHECK_THROWS_AS(
        ThreadTeam::parallel_region(kThreads, [] { throw std::runtime_error("a particle is lost"); }),
        std::runtime_error);
    std::atomic<int> threads{0};
    ThreadTeam::parallel_region(kThreads,
                                [&] { on_threads(kThreads, [&](const TeamThread&) { ++threads; }); });
    CHECK(threads == kThreads);
  }
}

// As where a caller runs a simulation on each thread: workspaces are by thread_index().
TEST_CASE("in a parallel region of the caller's, what each of its threads does is its own") {
  std::atomic<int> wrong{0}, turns{0};
#pragma omp parallel num_threads(kThreads)
  ThreadTeam::parallel_region(kThreads, [&] {
    on_threads(kThreads, [&](const TeamThread& me) { wrong += me.threads != 1 || thread_index() != 0; });
    for_each_of(10, kThreads, 1, [&](std::int64_t) { ++turns; });
  });
  CHECK(wrong == 0);
  CHECK(turns == 10 * kThreads);
  in_both([] {
    std::atomic<int> other{0};
    on_threads(kThreads, [&](const TeamThread& me) { other += thread_index() != me.thread; });
    CHECK(other == 0);
    CHECK(thread_index() == 0);
  });
}

// More threads than processors: those that wait give way, or this would take minutes.
TEST_CASE("threads that wait give way to those that work") {
  const int threads = 4 * omp_get_num_procs();
  std::atomic<int> turns{0};
  ThreadTeam::parallel_region(threads, [&] {
    for (int job = 0; job < 50; ++job) on_threads(threads, [&](const TeamThread&) { ++turns; });
  });
  CHECK(turns == 50 * threads);
}

}  // namespace
}  // namespace mpmfast
