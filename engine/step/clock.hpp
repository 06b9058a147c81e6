#pragma once

/// @file Wall seconds by task, and which tasks a step came to.

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <utility>

#include "engine/plan/step_table.hpp"

namespace mpmfast {

/// Tasks may lie in each other: each second counts once, for the innermost.
class StepClock {
 public:
  using Seconds = std::array<double, kTimerNames.size()>;

  /// A task, from enter() to the end of the scope.
  class Running {
   public:
    Running(StepClock& clock, Task task) : clock_(clock), outer_(clock.change_to(timer_of(task))) {}
    ~Running() { clock_.change_to(outer_); }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    StepClock& clock_;
    int outer_;
  };
  [[nodiscard]] Running enter(Task task) {
    if (!(seen_ >> static_cast<int>(task) & 1)) tasks_[count_++] = task;
    seen_ |= std::uint64_t{1} << static_cast<int>(task);
    return {*this, task};
  }
  /// A step begins: no task has been entered.
  void begin_step() { seen_ = 0, count_ = 0; }

  /// By timer.
  const Seconds& seconds() const { return seconds_; }
  Seconds& seconds() { return seconds_; }
  /// Of this step, in the order in which they were entered first.
  std::span<const Task> tasks() const { return {tasks_.data(), count_}; }

 private:
  using Moment = std::chrono::steady_clock::time_point;
  static_assert(kTasks <= 64);
  static constexpr int kNone = -1;

  static int timer_of(Task task) { return static_cast<int>(row_of(task).timer); }
  /// Books what has run so far. @return what that was
  int change_to(int timer) {
    const Moment now = std::chrono::steady_clock::now();
    if (timer_ != kNone)
      seconds_[static_cast<std::size_t>(timer_)] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    return std::exchange(timer_, timer);
  }

  Seconds seconds_{};
  std::array<Task, kTasks> tasks_{};
  std::size_t count_ = 0;
  std::uint64_t seen_ = 0;
  int timer_ = kNone;
  Moment since_{};
};

}  // namespace mpmfast
