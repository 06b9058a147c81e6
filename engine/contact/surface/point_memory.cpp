#include "engine/contact/surface/point_memory.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/state/check_values.hpp"

namespace mpmfast {

namespace {

/// The width of a record in a checkpoint: position, fields, history.
template <int Dim>
constexpr std::size_t kRecordWidth = Dim + 2 + 3;

template <int Dim>
void put(const PointRecord<Dim>& record, double* to) {
  for (int d = 0; d < Dim; ++d) *to++ = record.position[d];
  *to++ = record.field_a;
  *to++ = record.field_b;
  *to++ = record.history.touched;
  *to++ = record.history.stuck;
  *to++ = record.history.recovery_length;
}

template <int Dim>
PointRecord<Dim> take(const double* from, int fields) {
  PointRecord<Dim> record;
  for (int d = 0; d < Dim; ++d) record.position[d] = *from++;
  const auto field = [&] {
    const double number = *from++;
    if (!(number >= 0 && number < fields))
      refuse_checkpoint("contact/points names a field that is not there");
    return static_cast<int>(number);
  };
  record.field_a = field();
  record.field_b = field();
  record.history.touched = *from++ != 0;
  record.history.stuck = *from++ != 0;
  record.history.recovery_length = *from++;
  return record;
}

}  // namespace

template <int Dim>
void PointMemory<Dim>::store(const SurfaceList<Dim>& points) {
  records_.resize(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const PairStatus& status = points.status[p];
    records_[p] = {points.geometry[p].position,
                   points.geometry[p].field_a,
                   points.geometry[p].field_b,
                   {status.touching, status.stuck, status.recovery_length}};
  }
}

template <int Dim>
void PointMemory<Dim>::sort(const GridView<Dim>& grid) {
  grid_ = grid;
  first_.assign(std::bit_ceil(2 * records_.size() + 1), -1);
  next_.resize(records_.size());
  for (std::size_t k = records_.size(); k-- > 0;) {
    int& first = first_[bin_of(cell_of(records_[k].position))];
    next_[k] = first;
    first = static_cast<int>(k);
  }
}

template <int Dim>
NodeIndex<Dim> PointMemory<Dim>::cell_of(const Vec<Dim>& position) const {
  NodeIndex<Dim> cell;
  for (int d = 0; d < Dim; ++d)
    cell[d] = static_cast<int>(std::floor((position[d] - grid_.origin[d]) * grid_.inverse_cell));
  return cell;
}

template <int Dim>
std::size_t PointMemory<Dim>::bin_of(const NodeIndex<Dim>& cell) const {
  std::uint64_t mixed = 0;
  for (int d = 0; d < Dim; ++d)
    mixed = (mixed ^ static_cast<std::uint32_t>(cell[d])) * std::uint64_t{0x9e3779b97f4a7c15};
  return (mixed >> 32) & (first_.size() - 1);
}

template <int Dim>
const PointRecord<Dim>* PointMemory<Dim>::nearest(const Vec<Dim>& position, int field_a, int field_b,
                                                  double cells) const {
  const PointRecord<Dim>* found = nullptr;
  double least = cells * cells * grid_.cell * grid_.cell;
  const NodeIndex<Dim> middle = cell_of(position);
  for (int m = 0; m < power(3, Dim); ++m) {
    NodeIndex<Dim> cell = middle;
    for (int d = 0, digits = m; d < Dim; ++d, digits /= 3) cell[d] += digits % 3 - 1;
    for (int k = first_[bin_of(cell)]; k >= 0; k = next_[static_cast<std::size_t>(k)]) {
      const PointRecord<Dim>& record = records_[static_cast<std::size_t>(k)];
      if (record.field_a != field_a || record.field_b != field_b) continue;
      const double distance = (record.position - position).squaredNorm();
      if (distance < least) least = distance, found = &record;
    }
  }
  return found;
}

template <int Dim>
void PointMemory<Dim>::visit(Archive& archive, int fields) {
  constexpr std::size_t kWidth = kRecordWidth<Dim>;
  std::vector<double> table(kWidth * records_.size());
  for (std::size_t k = 0; k < records_.size(); ++k) put(records_[k], table.data() + kWidth * k);
  archive.list("contact/points", table);
  if (!archive.reading()) return;
  if (table.size() % kWidth != 0) refuse_checkpoint("contact/points has no whole number of points");
  check_finite("contact/points", table.data(), table.size());
  records_.clear();
  for (std::size_t k = 0; k < table.size(); k += kWidth)
    records_.push_back(take<Dim>(table.data() + k, fields));
}

template class PointMemory<2>;
template class PointMemory<3>;

}  // namespace mpmfast
