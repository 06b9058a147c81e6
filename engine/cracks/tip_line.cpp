#include "engine/cracks/tip_line.hpp"

#include <algorithm>
#include <cstddef>

#include "engine/constants.hpp"

namespace mpmfast {

template <int Dim>
TipLine line_behind(const CrackLine<Dim>& line, bool end, double distance) {
  TipLine out;
  for (std::size_t k = 0; k < line.points.size(); ++k) {
    out.push_back(line.point_from(end, k).template head<2>());
    if (out.size() > 1 && (out.back() - out.front()).norm() > distance) break;
  }
  return out;
}

Vec<2> end_direction(const TipLine& line, double cell, double straight) {
  const double length =
      std::min(crack_constants::kDirection * cell, straight) * (1 - crack_constants::kLengthRoundOff);
  std::size_t back = 1;
  while (back + 1 < line.size() && (line[0] - line[back]).norm() < length) ++back;
  return (line[0] - line[back]).normalized();
}

void shorten(TipLine& line, double length) {
  while (line.size() > 2) {
    const double piece = (line[0] - line[1]).norm();
    if (piece > length) break;
    length -= piece;
    line.erase(line.begin());
  }
  line[0] += length * (line[1] - line[0]).normalized();
}

template TipLine line_behind(const CrackLine<2>&, bool, double);

}  // namespace mpmfast
