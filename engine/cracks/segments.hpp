#pragma once

/// @file The straight segments of all crack lines, with bounding boxes that find those near a box of nodes.

#include <array>
#include <vector>

#include "engine/cracks/crack_line.hpp"
#include "engine/geometry/crossing.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

template <int Dim>
using CrackBox = std::array<Vec<Dim>, 2>;  ///< lowest and highest corner of a box, m

template <int Dim>
struct CrackSegment {
  int crack, field;   ///< number of its crack, velocity field of the body
  Vec<Dim> from, to;  ///< m
  CrackBox<Dim> box;  ///< around it
  Vec<Dim> normal;    ///< unit, to the left
};

/// All segments, in the order of the lines.
template <int Dim>
class CrackSegments {
 public:
  void build(const std::vector<CrackLine<Dim>>& lines);
  /// The segments of a field whose boxes overlap a box.
  void find(int field, const CrackBox<Dim>& box, std::vector<const CrackSegment<Dim>*>& out) const;

 private:
  std::vector<CrackSegment<Dim>> segments_;
  std::vector<CrackBox<Dim>> boxes_;  ///< each around kSegmentsPerBox segments
  CrackBox<Dim> all_;                 ///< around all segments
};

/// Bounding boxes in the plane, stored by coordinate: many are tested at once.
class SegmentBoxes {
 public:
  template <int Dim>
  void build(const std::vector<const CrackSegment<Dim>*>& segments);
  /// Indices of the boxes that overlap a box, in rising order.
  void find(const Point2& low, const Point2& high, std::vector<int>& out) const;

 private:
  std::array<std::vector<double>, 2> low_, high_;  ///< sizes are multiples of kLanes
  Point2 all_low_{}, all_high_{};
};

}  // namespace mpmfast
