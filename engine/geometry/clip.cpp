#include "engine/geometry/clip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpmfast {

namespace {

constexpr double kRoundOff = 1e-9;          ///< of a domain
constexpr double kLeast = 0.5 - kRoundOff;  ///< of a domain

/// Area and first moments, in cells from the lattice's corner.
struct Part {
  double area = 0, x = 0, y = 0;

  Part times(double share) const { return {share * area, share * x, share * y}; }
  void add(const Part& other) {
    area += other.area;
    x += other.x;
    y += other.y;
  }
};

/// What an outline holds of each cell of a lattice, by Green's theorem: of a closed line with the material on
/// its left, each stretch adds what lies between it and the lower end of the x axis times its dy.
class Coverage {
 public:
  Coverage(long first_x, long first_y, long columns, long rows)
      : first_x_(first_x),
        first_y_(first_y),
        columns_(columns),
        rows_(rows),
        own_(static_cast<std::size_t>(columns * rows)),
        left_(own_.size()) {}

  /// A straight stretch from (ax, ay) to (bx, by), in cells.
  void add(double ax, double ay, double bx, double by) {
    std::vector<double> cuts{0, 1};
    const auto cut_along = [&](double a, double b) {
      for (double line = std::floor(std::min(a, b)) + 1; line < std::max(a, b); ++line)
        cuts.push_back((line - a) / (b - a));
    };
    cut_along(ax, bx);
    cut_along(ay, by);
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 1; k < cuts.size(); ++k) {
      const double s = cuts[k - 1], t = cuts[k];
      add_in_cell(ax + s * (bx - ax), ay + s * (by - ay), ax + t * (bx - ax), ay + t * (by - ay));
    }
  }

  /// After the last stretch: calls visit(i, j, part, whether the outline runs through the cell).
  template <class Visit>
  void each(Visit visit) const {
    for (long j = 0; j < rows_; ++j) {
      double dy = 0, ydy = 0;  // of the stretches further right
      for (long i = columns_ - 1; i >= 0; --i) {
        const auto c = static_cast<std::size_t>(j * columns_ + i);
        const double middle = static_cast<double>(first_x_ + i) + 0.5;
        Part part = own_[c].part;
        part.add({dy, middle * dy, ydy});
        visit(first_x_ + i, first_y_ + j, part, own_[c].crossed);
        dy += left_[c].dy;
        ydy += left_[c].ydy;
      }
    }
  }

 private:
  struct Own {
    Part part;
    bool crossed = false;
  };
  struct Left {
    double dy = 0, ydy = 0;
  };

  void add_in_cell(double ax, double ay, double bx, double by) {
    const double dy = by - ay, y = 0.5 * (ay + by);
    const double cell_x = std::floor(0.5 * (ax + bx)), cell_y = std::floor(y);
    const long i = static_cast<long>(cell_x) - first_x_, j = static_cast<long>(cell_y) - first_y_;
    if (i < 0 || i >= columns_ || j < 0 || j >= rows_) return;
    const auto c = static_cast<std::size_t>(j * columns_ + i);
    const double a = ax - cell_x, b = bx - cell_x;
    // ∫ x dy, ∫ ½x² dy and ∫ x y dy along a straight line, x from the cell's lower side
    const double area = 0.5 * (a + b) * dy;
    own_[c].part.add({area, cell_x * area + dy * (a * a + a * b + b * b) / 6,
                      dy * (a * (2 * ay + by) + b * (ay + 2 * by)) / 6});
    own_[c].crossed = true;
    left_[c].dy += dy;
    left_[c].ydy += y * dy;
  }

  long first_x_, first_y_, columns_, rows_;
  std::vector<Own> own_;
  std::vector<Left> left_;
};

}  // namespace

void clip(const Outline& outline, const Vec3& origin, Seeds& seeds) {
  const double side[2] = {2 * seeds.half_size[0], 2 * seeds.half_size[1]};
  const auto in_cells = [&](const Vec3& x, std::size_t d) { return (x[d] - origin[d]) / side[d]; };
  constexpr double kFar = std::numeric_limits<double>::infinity();
  double low[2] = {kFar, kFar}, high[2] = {-kFar, -kFar};
  for (const Vec3& point : outline.points)
    for (std::size_t d = 0; d < 2; ++d) {
      low[d] = std::min(low[d], in_cells(point, d));
      high[d] = std::max(high[d], in_cells(point, d));
    }
  const long first_x = static_cast<long>(std::floor(low[0])) - 1,
             first_y = static_cast<long>(std::floor(low[1])) - 1;
  const long columns = static_cast<long>(std::ceil(high[0])) + 1 - first_x,
             rows = static_cast<long>(std::ceil(high[1])) + 1 - first_y;
  Coverage coverage(first_x, first_y, columns, rows);
  for (const auto& facet : outline.facets) {
    const Vec3 &a = outline.points[static_cast<std::size_t>(facet.point[0])],
               &b = outline.points[static_cast<std::size_t>(facet.point[1])];
    coverage.add(in_cells(a, 0), in_cells(a, 1), in_cells(b, 0), in_cells(b, 1));
  }
  std::vector<Part> parts(static_cast<std::size_t>(columns * rows));
  std::vector<std::uint8_t> crossed(parts.size());
  const auto index = [&](long i, long j) {
    return static_cast<std::size_t>((j - first_y) * columns + i - first_x);
  };
  coverage.each([&](long i, long j, const Part& part, bool runs_through) {
    parts[index(i, j)] = part;
    crossed[index(i, j)] = runs_through;
  });
  const std::vector<std::uint8_t> crossed_by_outline = crossed;
  const std::vector<Part> before = parts;
  const std::ptrdiff_t beside[] = {-1, 1, -columns, columns},
                       diagonal[] = {-columns - 1, -columns + 1, columns - 1, columns + 1};
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (!crossed_by_outline[c] || before[c].area >= kLeast) continue;
    for (const auto& steps : {beside, diagonal}) {
      double largest = kLeast;
      std::vector<std::size_t> takers;  // those that are equal take equal parts
      for (int k = 0; k < 4; ++k) {
        const auto n = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(c) + steps[k]);
        if (n >= before.size() || before[n].area < largest - kRoundOff || before[n].area < kLeast) continue;
        if (before[n].area > largest + kRoundOff) takers.clear();
        largest = std::max(largest, before[n].area);
        takers.push_back(n);
      }
      if (takers.empty()) continue;
      for (const std::size_t n : takers) {
        parts[n].add(before[c].times(1.0 / static_cast<double>(takers.size())));
        crossed[n] = 1;
      }
      parts[c] = {};
      break;
    }
  }
  seeds.position.clear();
  seeds.share.clear();
  for (long j = first_y; j < first_y + rows; ++j)
    for (long i = first_x; i < first_x + columns; ++i) {
      const Part& part = parts[index(i, j)];
      const bool whole = !crossed[index(i, j)];
      if (whole ? part.area < 0.5 : !(part.area > kRoundOff)) continue;
      const double x = whole ? static_cast<double>(i) + 0.5 : part.x / part.area,
                   y = whole ? static_cast<double>(j) + 0.5 : part.y / part.area;
      seeds.position.push_back({origin[0] + side[0] * x, origin[1] + side[1] * y, 0});
      seeds.share.push_back(whole ? 1 : part.area);
    }
}

}  // namespace mpmfast
