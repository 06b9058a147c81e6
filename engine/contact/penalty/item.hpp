#pragma once

/// @file Access to a list by a signed number.

#include <cstddef>

namespace mpmfast::penalty {

/// list[number], of a number that is not negative.
template <class List, class Number>
decltype(auto) item(List& list, Number number) {
  return list[static_cast<std::size_t>(number)];
}

}  // namespace mpmfast::penalty
