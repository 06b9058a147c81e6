#pragma once

/// @file What the points of a step leave to those of the next, and to a checkpoint. Points have no names:
/// one takes over from the nearest point of the same two fields.

#include <vector>

#include "engine/contact/surface/surface_list.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {

template <int Dim>
struct PointRecord {
  Vec<Dim> position;  ///< m
  int field_a, field_b;
  PairHistory history;
};

template <int Dim>
class PointMemory {
 public:
  /// Keeps what the points of a step leave.
  void store(const SurfaceList<Dim>& points);
  /// Puts the records in order of their cells, for `nearest`.
  void sort(const GridView<Dim>& grid);
  /// The nearest record of the two fields within so many cells of a place, or null.
  const PointRecord<Dim>* nearest(const Vec<Dim>& position, int field_a, int field_b, double cells) const;

  /// Throws what the archive throws, and on contents that no step wrote.
  void visit(Archive& archive, int fields);
  std::size_t bytes() const { return bytes_in(records_, first_, next_); }

 private:
  NodeIndex<Dim> cell_of(const Vec<Dim>& position) const;
  std::size_t bin_of(const NodeIndex<Dim>& cell) const;

  GridView<Dim> grid_{};
  std::vector<PointRecord<Dim>> records_;
  std::vector<int> first_, next_;  ///< lists of the records of a bin of cells; −1: the end
};

extern template class PointMemory<2>;
extern template class PointMemory<3>;

}  // namespace mpmfast
