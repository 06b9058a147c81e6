#include "engine/cracks/segments.hpp"

#include <algorithm>
#include <bit>

#include "engine/constants.hpp"
#include "kernels/measure.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

namespace {

using crack_constants::kSegmentsPerBox;

template <int Dim>
bool overlap(const CrackBox<Dim>& box, const CrackBox<Dim>& other) {
  for (int d = 0; d < Dim; ++d)
    if (box[0][d] > other[1][d] || box[1][d] < other[0][d]) return false;
  return true;
}

template <int Dim>
void enclose(CrackBox<Dim>& box, const CrackBox<Dim>& other) {
  box[0] = box[0].cwiseMin(other[0]);
  box[1] = box[1].cwiseMax(other[1]);
}

template <int Dim>
CrackBox<Dim> empty_box() {
  return {Vec<Dim>::Constant(kInfinity), Vec<Dim>::Constant(-kInfinity)};
}

template <int Dim>
Vec<Dim> left_normal(const Vec<Dim>& along) {
  Vec<Dim> normal = Vec<Dim>::Zero();
  normal[0] = -along[1], normal[1] = along[0];
  return normal / along.norm();
}

}  // namespace

template <int Dim>
void CrackSegments<Dim>::build(const std::vector<CrackLine<Dim>>& lines) {
  segments_.clear();
  boxes_.clear();
  all_ = empty_box<Dim>();
  for (std::size_t c = 0; c < lines.size(); ++c)
    for (std::size_t k = 1; k < lines[c].points.size(); ++k) {
      const Vec<Dim>&from = lines[c].points[k - 1], &to = lines[c].points[k];
      if (segments_.size() % kSegmentsPerBox == 0) boxes_.push_back(empty_box<Dim>());
      segments_.push_back({static_cast<int>(c), lines[c].field, from, to,
                           CrackBox<Dim>{from.cwiseMin(to), from.cwiseMax(to)}, left_normal<Dim>(to - from)});
      enclose<Dim>(boxes_.back(), segments_.back().box);
      enclose<Dim>(all_, segments_.back().box);
    }
}

template <int Dim>
void CrackSegments<Dim>::find(int field, const CrackBox<Dim>& box,
                              std::vector<const CrackSegment<Dim>*>& out) const {
  out.clear();
  if (!overlap<Dim>(all_, box)) return;
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (!overlap<Dim>(boxes_[b], box)) continue;
    const std::size_t end = std::min(segments_.size(), kSegmentsPerBox * (b + 1));
    for (std::size_t s = kSegmentsPerBox * b; s < end; ++s)
      if (segments_[s].field == field && overlap<Dim>(segments_[s].box, box)) out.push_back(&segments_[s]);
  }
}

template <int Dim>
void SegmentBoxes::build(const std::vector<const CrackSegment<Dim>*>& segments) {
  const std::size_t n = (segments.size() + kLanes - 1) / kLanes * kLanes;
  all_low_.fill(kInfinity);
  all_high_.fill(-kInfinity);
  for (std::size_t d = 0; d < 2; ++d) {
    low_[d].assign(n, kInfinity);
    high_[d].assign(n, -kInfinity);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      low_[d][k] = segments[k]->box[0][static_cast<int>(d)];
      high_[d][k] = segments[k]->box[1][static_cast<int>(d)];
      all_low_[d] = std::min(all_low_[d], low_[d][k]);
      all_high_[d] = std::max(all_high_[d], high_[d][k]);
    }
  }
}

void SegmentBoxes::find(const Point2& low, const Point2& high, std::vector<int>& out) const {
  out.clear();
  for (std::size_t d = 0; d < 2; ++d)
    if (!(all_low_[d] <= high[d] && all_high_[d] >= low[d])) return;
  for (std::size_t k = 0; k < low_[0].size(); k += kLanes) {
    const auto overlaps = [&](std::size_t d) {
      return (load_lanes(&low_[d][k]) <= high[d]) & (load_lanes(&high_[d][k]) >= low[d]);
    };
    for (unsigned bits = bits_of(overlaps(0) & overlaps(1)); bits != 0; bits &= bits - 1)
      out.push_back(static_cast<int>(k) + std::countr_zero(bits));
  }
}

template class CrackSegments<2>;
template class CrackSegments<3>;
template void SegmentBoxes::build(const std::vector<const CrackSegment<2>*>&);
template void SegmentBoxes::build(const std::vector<const CrackSegment<3>*>&);

}  // namespace mpmfast
