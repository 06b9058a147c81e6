#pragma once

/// @file Elements of lists by signed indices.

#include <concepts>
#include <cstddef>
#include <utility>

namespace mpmfast {

/// The element of a list at an index that is not negative.
template <class List>
decltype(auto) element(List&& list, std::integral auto index) {
  return std::forward<List>(list)[static_cast<std::size_t>(index)];
}

}  // namespace mpmfast
