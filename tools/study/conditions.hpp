#pragma once

/// @file Does a run's history hold what must hold?

#include "study.hpp"

namespace mpmfast {

struct Judgement {
  bool holds = false;
  double value = 0;  ///< the worst of the rows that are judged
  double share = 0;  ///< of its bound that is used: 1 on the bound, more where it does not hold
};

/// A history without rows in the window, and a value that is not a number, hold nothing.
Judgement judge(const Condition& condition, const Table& history, const Constants& constants);

/// "at most 0.02", "from -0.1 to 0.02".
std::string bounds_text(const Condition& condition);

}  // namespace mpmfast
