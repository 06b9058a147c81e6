#pragma once

/// @file Crack lines: polylines of points inside a body, each with a position on both crack sides.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// The growth of one end of a crack.
struct CrackEnd {
  bool grows = false;          ///< the end lies in its body, and its crack has a growth rule
  double due{};                ///< time of the next growth check, s
  double straight = HUGE_VAL;  ///< length behind the end without a turn, m
  double grown = 0;            ///< length added since the start, m
  bool fresh = false;          ///< the end grew in the last step
};

/// A crack: its points from one end to the other. A flag `end` selects the end: false is the first point,
/// true the last one.
template <int Dim>
struct CrackLine {
  int field{};                   ///< velocity field of its body
  double node_mass{};            ///< mass of a node inside the body at the start, kg
  std::vector<Vec<Dim>> points;  ///< positions between the crack sides, m
  /// Positions of the material that was at the points at the start, on the left and on the right side, m.
  std::array<std::vector<Vec<Dim>>, 2> sides;
  std::array<CrackEnd, 2> ends;  ///< of the first and of the last point

  double length() const {
    double sum = 0;
    for (std::size_t k = 1; k < points.size(); ++k) sum += (points[k] - points[k - 1]).norm();
    return sum;
  }
  /// The k-th point, counted from an end.
  const Vec<Dim>& point_from(bool end, std::size_t k) const {
    return points[end ? points.size() - 1 - k : k];
  }
  /// Adds a point at an end, at the same position on both sides.
  void extend(bool end, const Vec<Dim>& point) {
    for (auto* list : {&points, &sides[0], &sides[1]}) list->insert(end ? list->end() : list->begin(), point);
  }
  /// Moves the last point at an end, on both sides.
  void move_end(bool end, const Vec<Dim>& point) {
    for (auto* list : {&points, &sides[0], &sides[1]}) (end ? list->back() : list->front()) = point;
  }
};

/// The crack lines at the start, as Scene::cracks: each straight part is divided into pieces of equal length,
/// no longer than CrackSpec::spacing.
template <int Dim>
std::vector<CrackLine<Dim>> make_crack_lines(const Scene& scene, const Plan& plan);

/// Reads or writes all lines. A file with another number of lines, or points that are no numbers, is refused.
template <int Dim>
void visit_crack_lines(Archive& archive, std::vector<CrackLine<Dim>>& lines);

/// Refuses a checkpoint while it is read. Writing never fails, so that a failed run can still be written.
/// @param name  the entry that does not fit the scene
void require_checkpoint(const Archive& archive, bool fits, const std::string& name);

}  // namespace mpmfast
