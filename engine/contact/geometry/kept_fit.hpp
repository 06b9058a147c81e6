#pragma once

/// @file What a fitted normal leaves to the steps after it.

#include <array>
#include <cstdint>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// Valid while hardly anything near has moved (ContactSpec::refit).
template <int Dim>
struct KeptFit {
  Vec<Dim> raw = Vec<Dim>::Zero();     ///< normal of the node's own cloud
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< the mean over the nodes around, where the scene asks for it
  std::array<std::int32_t, 2> support{-1, -1};  ///< support particles: of a along the normal, of b against it
  double drift{};                               ///< how far the fields have moved since (follow_fits), m
  bool known = false;
  bool overlaps = false;  ///< the surfaces overlap
  bool doubted = false;   ///< they overlap, and the normal is that of a simpler method
};

}  // namespace mpmfast
