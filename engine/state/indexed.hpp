#pragma once

/// @file A vector that any whole number indexes.

#include <concepts>
#include <vector>

namespace mpmfast {

/// As std::vector; indices are not checked.
template <class T>
class Indexed : public std::vector<T> {
 public:
  using std::vector<T>::vector;
  T& operator[](std::integral auto k) { return this->data()[k]; }
  const T& operator[](std::integral auto k) const { return this->data()[k]; }
};

}  // namespace mpmfast
