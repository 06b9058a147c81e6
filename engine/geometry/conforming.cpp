#include "engine/geometry/conforming.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/geometry/clip.hpp"
#include "engine/geometry/outline.hpp"

namespace mpmfast {

namespace {

using Point = std::array<double, 2>;

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1]}; }
double length(const Point& a) { return std::hypot(a[0], a[1]); }
Point unit(const Point& a) { return (1 / length(a)) * a; }
Point direction(double angle) { return {std::cos(angle), std::sin(angle)}; }
/// The angle from a to b, −π to π.
double angle_between(const Point& a, const Point& b) {
  return std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

/// Least angle between two segments at a corner, rad. A larger one lets the layer's end fold at corners that
/// pass for bends; a smaller one takes the bends of coarse arcs for corners. Range: 0.15 to kCrease.
constexpr double kCorner = 0.2;

/// Largest turn of a corner in the layer, rad. Beyond it, whole domains would stand out of the tip by more
/// than half of their size. Range: 2 to 2.8.
constexpr double kSharpest = 2.65;

struct Corner {
  double turn = 0;  ///< rad; positive: convex
  double area = 0;  ///< m², of a convex one: what the layer has between the lines that meet there
};

/// A part of an outline between two corners, or a whole loop without any. The material is on its left.
struct SmoothLine {
  std::vector<Point> points;   ///< m; of a loop the first one again at the end
  std::vector<Point> normals;  ///< outward, at the points
  std::vector<double> arc;     ///< m, from the first point
  bool closed = false;
  Corner before, after;
  double begin = 0, end = 0;  ///< m, arc lengths between which the layer's end runs beside the line

  double length() const { return arc.back(); }
};

/// A place on a line.
struct Spot {
  Point point, normal;
};

/// The place at an arc length. Points lie on the segments; normals turn evenly along each.
Spot spot_at(const SmoothLine& line, double s) {
  const auto next = std::upper_bound(line.arc.begin() + 1, line.arc.end() - 1, s);
  const auto k = static_cast<std::size_t>(next - line.arc.begin());
  const double share = (s - line.arc[k - 1]) / (line.arc[k] - line.arc[k - 1]);
  return {line.points[k - 1] + share * (line.points[k] - line.points[k - 1]),
          unit((1 - share) * line.normals[k - 1] + share * line.normals[k])};
}

/// What a line turns by between two arc lengths, rad. Positive where it is convex.
double turning(const SmoothLine& line, double from, double to) {
  Point last = spot_at(line, from).normal;
  double sum = 0;
  for (auto s = std::upper_bound(line.arc.begin(), line.arc.end(), from); s != line.arc.end() && *s < to;
       ++s) {
    const Point& normal = line.normals[static_cast<std::size_t>(s - line.arc.begin())];
    sum += angle_between(last, normal);
    last = normal;
  }
  return sum + angle_between(last, spot_at(line, to).normal);
}

/// Lines in the order of their loops; those of a loop that has corners follow each other.
std::vector<SmoothLine> smooth_lines(const Outline& outline) {
  std::vector<SmoothLine> lines;
  const auto at = [&](const Outline::Facet& facet, std::size_t k) -> Point {
    const Vec3& x = outline.points[static_cast<std::size_t>(facet.point[k])];
    return {x[0], x[1]};
  };
  const auto corner_between = [&](const Outline::Facet& a, const Outline::Facet& b) {
    return std::abs(angle_between(at(a, 1) - at(a, 0), at(b, 1) - at(b, 0))) > kCorner;
  };
  std::size_t begin = 0;  // of the line, a facet
  for (std::size_t f = 0; f < outline.facets.size(); ++f) {
    const Outline::Facet& facet = outline.facets[f];
    if (f == 0 || facet.patch != outline.facets[f - 1].patch ||
        corner_between(outline.facets[f - 1], facet)) {
      begin = f;
      lines.emplace_back();
      lines.back().points.push_back(at(facet, 0));
    }
    lines.back().points.push_back(at(facet, 1));
    const Outline::Facet& first = outline.facets[begin];
    lines.back().closed = facet.point[1] == first.point[0] && !corner_between(facet, first);
  }
  for (SmoothLine& line : lines) {
    const std::size_t n = line.points.size();
    std::vector<Point> outward;  // of the segments
    line.arc.assign(1, 0.0);
    for (std::size_t k = 1; k < n; ++k) {
      const Point along = line.points[k] - line.points[k - 1];
      outward.push_back(unit({along[1], -along[0]}));
      line.arc.push_back(line.arc.back() + length(along));
    }
    const Point seam = line.closed ? unit(outward.back() + outward.front()) : Point{};
    line.normals.push_back(line.closed ? seam : outward.front());
    for (std::size_t k = 1; k + 1 < n; ++k) line.normals.push_back(unit(outward[k - 1] + outward[k]));
    line.normals.push_back(line.closed ? seam : outward.back());
    line.end = line.length();
  }
  return lines;
}

/// Calls visit(line, next) for every corner: of the line that ends there and the one that begins.
template <class Visit>
void each_corner(std::vector<SmoothLine>& lines, Visit visit) {
  std::size_t first = 0;  // of the loop
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const bool ends = k + 1 == lines.size() || lines[k].points.back() != lines[k + 1].points.front();
    if (!lines[k].closed) visit(lines[k], lines[ends ? first : k + 1]);
    if (ends) first = k + 1;
  }
}

/// The area between two lines that meet at a convex corner and the corner of the layer's end, m².
double kite_area(const SmoothLine& line, const SmoothLine& next, const Point& inner) {
  const Point& tip = line.points.back();
  double twice = 0;
  Point last = spot_at(line, line.end).point - tip;
  const auto go_to = [&](const Point& point) {
    const Point to = point - tip;
    twice += last[0] * to[1] - to[0] * last[1];
    last = to;
  };
  for (std::size_t k = 0; k < line.arc.size(); ++k)
    if (line.arc[k] > line.end) go_to(line.points[k]);
  for (std::size_t k = 0; k < next.arc.size() && next.arc[k] < next.begin; ++k) go_to(next.points[k]);
  go_to(spot_at(next, next.begin).point);
  go_to(inner);
  go_to(spot_at(line, line.end).point);
  return 0.5 * twice;
}

/// The place beside a line at the depth of the layer, and how it moves with the arc length.
struct Inner {
  Point point, tangent;
};

Inner inner_at(const SmoothLine& line, double s, double depth) {
  const double step = 1e-3 * depth;  // a small part of the distance between two points
  const auto point = [&](double at) {
    const Spot spot = spot_at(line, at);
    return spot.point - depth * spot.normal;
  };
  return {point(s), (0.5 / step) * (point(s + step) - point(s - step))};
}

/// Finds the turn and the area of a corner, and where the layer's end has it: as far from both lines as the
/// layer is deep, by Newton's method. @return false if there is no such place
bool find_corner(SmoothLine& line, SmoothLine& next, double depth) {
  constexpr int kMost = 50;           // steps; straight lines take one
  constexpr double kRoundOff = 1e-8;  // of the depth; coordinates may be 1e7 depths
  const double turn = angle_between(line.normals.back(), next.normals.front());
  line.after.turn = next.before.turn = turn;
  if (turn <= 0) return true;
  if (turn > kSharpest) return false;
  for (int step = 0; step < kMost; ++step) {
    const Inner here = inner_at(line, line.end, depth), there = inner_at(next, next.begin, depth);
    const Point gap = there.point - here.point;
    if (length(gap) <= kRoundOff * depth) {
      line.after.area = next.before.area = kite_area(line, next, here.point);
      return true;
    }
    const Point &t = here.tangent, &u = there.tangent;  // steps s and s' close the gap: s t − s' u = gap
    const double cross = t[0] * u[1] - t[1] * u[0];
    line.end += (gap[0] * u[1] - gap[1] * u[0]) / cross;
    next.begin += (gap[0] * t[1] - gap[1] * t[0]) / cross;
  }
  return false;
}

/// Particles along the outline, and the line where the layer ends.
class Layer {
 public:
  Layer(double depth, double spacing) : depth_(depth), spacing_(spacing) {}

  /// Adds the particles of a line and of the corner behind it. @return false if its corners overlap
  bool add(const SmoothLine& line) {
    if (!(line.end >= line.begin - kRoundOff * depth_)) return false;
    add_strip(line);
    if (has_particle(line.after)) add_corner(line);
    return true;
  }

  /// The points of the line at the depth of the layer, with an arc about a reentrant corner behind it.
  std::vector<Point> inner_line(const SmoothLine& line) const {
    const double begin = line.begin, end = line.end;
    std::vector<Point> out;
    const auto push = [&](const Spot& spot) { out.push_back(spot.point - depth_ * spot.normal); };
    push(spot_at(line, begin));
    for (std::size_t k = 0; k < line.arc.size(); ++k)
      if (line.arc[k] > begin && line.arc[k] < end) push({line.points[k], line.normals[k]});
    if (!line.closed) push(spot_at(line, end));
    const double reentrant = std::max(-line.after.turn, 0.0);
    const auto steps = static_cast<int>(std::ceil(reentrant * kConformingPoints));
    const double from = std::atan2(line.normals.back()[1], line.normals.back()[0]);
    for (int k = 1; k < steps; ++k) push({line.points.back(), direction(from - reentrant * k / steps)});
    return out;
  }

  Seeds seeds;

 private:
  static constexpr double kRoundOff = 1e-9;
  /// Least area of a corner that has a particle of its own, in domains. A smaller value lets domains reach
  /// beyond blunt corners; above 0.75, a strip's last particle may be shorter than its corner. Range: 0.5 to
  /// 0.75.
  static constexpr double kLeastCorner = 0.75;

  /// Has a corner a particle of its own? Others belong to the ends of the lines that meet there.
  bool has_particle(const Corner& corner) const { return corner.area >= kLeastCorner * depth_ * spacing_; }

  void push(const Point& place, double angle, double area) {
    seeds.position.push_back({place[0], place[1], 0});
    seeds.angle.push_back(angle);
    seeds.share.push_back(area / (depth_ * spacing_));
  }

  void add_strip(const SmoothLine& line) {
    const double begin = has_particle(line.before) ? line.begin : 0,
                 end = has_particle(line.after) ? line.end : line.length();
    const double extent = end - begin;
    if (extent <= kRoundOff * depth_ && line.before.turn >= 0 && line.after.turn >= 0) return;
    // A loop has a multiple of four, so that the particles of an ellipse are mirrored at its axes.
    const long group = line.closed ? 4 : 1;
    const double wanted = extent / spacing_ / static_cast<double>(group);
    const long count = group * std::max(std::lround(wanted), 1L);
    const auto at = [&](double share) { return begin + extent * share / static_cast<double>(count); };
    for (long k = 0; k < count; ++k) {
      const Spot middle = spot_at(line, at(static_cast<double>(k) + 0.5));
      double area = strip_area(line, at(static_cast<double>(k)), at(static_cast<double>(k) + 1));
      if (k == 0) area += corner_share(line.before);
      if (k + 1 == count) area += corner_share(line.after);
      push(middle.point - 0.5 * depth_ * middle.normal, std::atan2(middle.normal[1], middle.normal[0]), area);
    }
  }

  /// The area of the layer between two arc lengths, as far as the layer's end runs beside them, m².
  double strip_area(const SmoothLine& line, double from, double to) const {
    from = std::max(from, line.begin);
    to = std::min(to, line.end);
    return to > from ? depth_ * (to - from) - 0.5 * depth_ * depth_ * turning(line, from, to) : 0;
  }

  /// What the last particle of a strip has of the corner beside it, m²: half of the sector, or of the kite
  /// that has no particle.
  double corner_share(const Corner& corner) const {
    if (corner.turn <= 0) return -0.25 * depth_ * depth_ * corner.turn;
    return has_particle(corner) ? 0 : 0.5 * corner.area;
  }

  /// The kite between the outline and the layer's end at a convex corner, in slices of equal area along its
  /// axis: one at a right angle, several at the tip of a wedge.
  void add_corner(const SmoothLine& line) {
    const double turn = line.after.turn, area = line.after.area;
    const double widest = depth_ * std::tan(0.5 * turn) * std::sin(0.5 * turn),
                 whole = depth_ / std::cos(0.5 * turn);
    // Distances along the axis from the tip: the kite is widest at `widest` and ends at `whole`.
    const double axis = std::atan2(line.normals.back()[1], line.normals.back()[0]) + 0.5 * turn;
    const long slices = std::max(std::lround(area / (depth_ * spacing_)), 1L);
    const auto reach = [&](double share) {  // where that share of the area ends
      const double bend = widest / whole;
      return share < bend ? whole * std::sqrt(share * bend)
                          : whole * (1 - std::sqrt((1 - share) * (1 - bend)));
    };
    for (long k = 0; k < slices; ++k) {
      constexpr int kParts = 16;  // of a slice, for its centroid
      double along = 0;
      for (int part = 0; part < kParts; ++part)
        along +=
            reach((static_cast<double>(k) + (part + 0.5) / kParts) / static_cast<double>(slices)) / kParts;
      if (slices == 1) along = (widest + whole) / 3;
      push(line.points.back() - along * direction(axis), axis - std::numbers::pi / 4,
           area / static_cast<double>(slices));
    }
  }

  double depth_, spacing_;  ///< m, across and along the outline
};

/// Is each of the points at least this far from all points of an outline?
bool keeps_distance(const std::vector<Vec3>& points, const Outline& outline, double distance) {
  std::array<double, 2> low{points[0][0], points[0][1]}, high = low;
  for (const auto* list : {&points, &outline.points})
    for (const Vec3& x : *list)
      for (std::size_t d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], x[d]);
        high[d] = std::max(high[d], x[d]);
      }
  const auto bin = [&](double x, std::size_t d) { return static_cast<long>((x - low[d]) / distance) + 1; };
  const long columns = bin(high[0], 0) + 2, rows = bin(high[1], 1) + 2;
  std::vector<int> newest(static_cast<std::size_t>(columns * rows), -1), before(outline.points.size());
  const auto index = [&](long i, long j) { return static_cast<std::size_t>(j * columns + i); };
  for (std::size_t k = 0; k < outline.points.size(); ++k) {
    int& head = newest[index(bin(outline.points[k][0], 0), bin(outline.points[k][1], 1))];
    before[k] = head;
    head = static_cast<int>(k);
  }
  return std::all_of(points.begin(), points.end(), [&](const Vec3& x) {
    const long column = bin(x[0], 0), row = bin(x[1], 1);
    for (long j = row - 1; j <= row + 1; ++j)
      for (long i = column - 1; i <= column + 1; ++i)
        for (int k = newest[index(i, j)]; k >= 0; k = before[static_cast<std::size_t>(k)]) {
          const Vec3& other = outline.points[static_cast<std::size_t>(k)];
          if (std::hypot(x[0] - other[0], x[1] - other[1]) < distance) return false;
        }
    return true;
  });
}

/// The line where the layer ends, as an outline.
Outline inner_outline(const std::vector<SmoothLine>& lines, const Layer& layer) {
  Outline out;
  std::size_t begin = 0;  // of the loop
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (const Point& p : layer.inner_line(lines[k])) out.points.push_back({p[0], p[1], 0});
    const bool ends = k + 1 == lines.size() || lines[k].closed || lines[k + 1].closed ||
                      lines[k].points.back() != lines[k + 1].points.front();
    if (!ends) continue;
    for (std::size_t i = begin; i < out.points.size(); ++i) {
      const std::size_t next = i + 1 < out.points.size() ? i + 1 : begin;
      out.facets.push_back({{static_cast<int>(i), static_cast<int>(next), -1}, {}, 0});
    }
    begin = out.points.size();
  }
  return out;
}

/// Gives remainders of the lattice to the particle of the layer that is next to each.
void merge_remainders(Seeds& inside, Seeds& layer) {
  constexpr double kRemainder = 0.05;  // of a domain
  std::size_t kept = 0;
  for (std::size_t k = 0; k < inside.position.size(); ++k) {
    const Vec3 x = inside.position[k];
    if (inside.share[k] < kRemainder) {
      const auto nearer = [&](const Vec3& a, const Vec3& b) {
        return std::hypot(a[0] - x[0], a[1] - x[1]) < std::hypot(b[0] - x[0], b[1] - x[1]);
      };
      const auto next = std::min_element(layer.position.begin(), layer.position.end(), nearer);
      layer.share[static_cast<std::size_t>(next - layer.position.begin())] += inside.share[k];
      continue;
    }
    inside.position[kept] = x;
    inside.share[kept++] = inside.share[k];
  }
  inside.position.resize(kept);
  inside.share.resize(kept);
  inside.angle.resize(kept);
}

/// The lattice inside an outline, cut off there.
Seeds cut_lattice(const Outline& outline, const CellLattice& grid) {
  Seeds seeds;
  for (std::size_t d = 0; d < 2; ++d) seeds.half_size[d] = 0.5 * grid.cell / grid.particles_per_cell[d];
  clip(outline, grid.origin, seeds);
  seeds.angle.assign(seeds.position.size(), 0);
  return seeds;
}

/// Do the domains add up to the outline's area? Layers that overlap leave more. Chords in place of arcs make
/// up to a tenth of a domain at a small hole, and a thousandth at each bend of a smooth line.
bool has_area(const Seeds& seeds, double depth, double spacing, const Outline& outline) {
  constexpr double kDomains = 0.1, kEverySpacing = 1e-3;
  double along = 0;
  for (const Outline::Facet& facet : outline.facets) {
    const Vec3 &a = outline.points[static_cast<std::size_t>(facet.point[0])],
               &b = outline.points[static_cast<std::size_t>(facet.point[1])];
    along += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  const double filled = std::accumulate(seeds.share.begin(), seeds.share.end(), 0.0);
  return std::abs(filled - plane_area(outline) / (depth * spacing)) <=
         kDomains + kEverySpacing * along / spacing;
}

}  // namespace

std::optional<Seeds> fill_conforming(const Outline& outline, const CellLattice& grid) {
  // Least distance of the layer's inner line from the outline, over the depth. Below it, two layers overlap.
  constexpr double kClear = 0.95;
  const double depth = grid.cell / grid.particles_per_cell[0],
               spacing = grid.cell / grid.particles_per_cell[1];
  std::vector<SmoothLine> lines = smooth_lines(outline);
  bool fits = true;
  each_corner(lines,
              [&](SmoothLine& line, SmoothLine& next) { fits = fits && find_corner(line, next, depth); });
  if (!fits) return {};
  Layer layer(depth, spacing);
  for (const SmoothLine& line : lines)
    if (!layer.add(line)) return {};
  const Outline inner = inner_outline(lines, layer);
  if (!keeps_distance(inner.points, outline, kClear * depth)) return {};
  Seeds seeds = cut_lattice(inner, grid);
  merge_remainders(seeds, layer.seeds);
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(seeds.position, layer.seeds.position);
  append(seeds.angle, layer.seeds.angle);
  append(seeds.share, layer.seeds.share);
  if (!has_area(seeds, depth, spacing, outline)) return {};
  return seeds;
}

}  // namespace mpmfast
