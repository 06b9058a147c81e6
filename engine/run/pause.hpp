#pragma once

/// @file For what would cost too much after every step.

#include <chrono>

namespace mpmfast {

/// Due once every 50 ms; the first time after as long.
class Pause {
 public:
  bool due() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace mpmfast
