// Outlines point by point and edge by edge, against what their shapes say of them.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "engine/geometry/outline.hpp"
#include "engine/geometry/surface.hpp"
#include "tests/unit/geometry_solids.hpp"

namespace mpmfast {
namespace {

using namespace test;
using Draw = std::mt19937_64;
using Point = std::array<double, 2>;
using Loop = std::vector<Point>;

double uniform(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

double area_of(const Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += 0.5 * (a[0] * b[1] - b[0] * a[1]);
  }
  return sum;
}

Joint joint_of(double turning) {
  return std::abs(turning) <= 0.5 ? Joint::smooth : turning > 0 ? Joint::convex : Joint::reentrant;
}

/// Loop after loop: points in their order, segments that follow each other from one crease to the next, the
/// first behind a crease where there is one, and patches from crease to crease.
void check_plane(const Outline& got, const std::vector<Loop>& loops, double tolerance) {
  std::size_t all = 0;
  for (const Loop& loop : loops) all += loop.size();
  REQUIRE(got.points.size() == all);
  REQUIRE(got.facets.size() == all);
  std::size_t base = 0;
  int patch = 0;
  for (const Loop& loop : loops) {
    const std::size_t n = loop.size();
    std::vector<Joint> joints;
    for (std::size_t k = 0; k < n; ++k) {
      const Point &a = loop[(k + n - 1) % n], &b = loop[k], &c = loop[(k + 1) % n];
      double turning = std::atan2(c[1] - b[1], c[0] - b[0]) - std::atan2(b[1] - a[1], b[0] - a[0]);
      turning = std::remainder(turning, 2 * std::numbers::pi);
      joints.push_back(joint_of(turning));
      REQUIRE(std::abs(got.points[base + k][0] - b[0]) < tolerance);
      REQUIRE(std::abs(got.points[base + k][1] - b[1]) < tolerance);
      REQUIRE(got.points[base + k][2] == 0);
    }
    std::size_t first = 0;
    while (first < n && joints[first] == Joint::smooth) ++first;
    first %= n;
    for (std::size_t k = 0; k < n; ++k) {
      const auto& facet = got.facets[base + k];
      const std::size_t i = (first + k) % n, j = (first + k + 1) % n;
      REQUIRE(facet.point == std::array<int, 3>{static_cast<int>(base + i), static_cast<int>(base + j), -1});
      REQUIRE(facet.joint[0] == joints[i]);
      REQUIRE(facet.joint[1] == joints[j]);
      REQUIRE(facet.joint[2] == Joint::smooth);
      if (k > 0 && joints[i] != Joint::smooth) ++patch;
      REQUIRE(facet.patch == patch);
    }
    ++patch;
    base += n;
  }
  CHECK(got.patches == patch);
}

Loop divided(Loop corners, double spacing) {
  if (area_of(corners) < 0) std::reverse(corners.begin(), corners.end());
  Loop out;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Point &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const int n = std::max(1, static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1]) / spacing + 0.5));
    for (int i = 0; i < n; ++i)
      out.push_back({(a[0] * (n - i) + b[0] * i) / n, (a[1] * (n - i) + b[1] * i) / n});
  }
  return out;
}

Loop star(Draw& draw, bool backwards) {
  Loop out;
  const int corners = whole(draw, 3, 9);
  const double x = uniform(draw, -2, 2), y = uniform(draw, -2, 2);
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * (k + uniform(draw, 0, 0.4)) / corners;
    const double radius = uniform(draw, 0.3, 1);
    out.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  if (backwards) std::reverse(out.begin(), out.end());
  return out;
}

/// Angles between points that lie at equal distances along an ellipse, by sums over a million of steps' worth
/// of its first quarter.
Loop ellipse(const Vec3& centre, double a, double b, double angle, double spacing) {
  constexpr int kSteps = 20000;
  const auto speed = [&](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); };
  const double dt = std::numbers::pi / 2 / kSteps;
  std::vector<double> path{0};
  for (int k = 0; k < kSteps; ++k)  // Simpson's rule
    path.push_back(path.back() + dt / 6 * (speed(k * dt) + 4 * speed((k + 0.5) * dt) + speed((k + 1) * dt)));
  const int quarter = std::max(2, static_cast<int>(path.back() / spacing + 0.5));
  std::vector<double> t{0};
  for (int k = 1; k < quarter; ++k) {
    const double wanted = path.back() * k / quarter;
    const auto next = std::lower_bound(path.begin(), path.end(), wanted) - path.begin();
    const double low = path[static_cast<std::size_t>(next - 1)], high = path[static_cast<std::size_t>(next)];
    t.push_back((static_cast<double>(next - 1) + (wanted - low) / (high - low)) * dt);
  }
  Loop out;
  const double pi = std::numbers::pi;
  for (int k = 0; k < 4 * quarter; ++k) {
    const int q = k / quarter, i = k % quarter;
    const double first = t[static_cast<std::size_t>(i)],
                 back = i == 0 ? pi / 2 : t[static_cast<std::size_t>(quarter - i)];
    const double at = q == 0 ? first : q == 1 ? pi - back : q == 2 ? pi + first : 2 * pi - back;
    const double u = a * std::cos(at), v = b * std::sin(at);
    out.push_back({centre[0] + u * std::cos(angle) - v * std::sin(angle),
                   centre[1] + u * std::sin(angle) + v * std::cos(angle)});
  }
  return out;
}

TEST_CASE(
    "boxes and polygons are outlined counter-clockwise, each edge in even parts, with creases at corners") {
  Draw draw(41);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const double spacing = uniform(draw, 0.05, 0.9);
    const Loop polygon = star(draw, round % 2 == 1);
    check_plane(outline(PolygonShape{polygon, 0, 0}, spacing, 2), {divided(polygon, spacing)}, 1e-14);
    const Vec3 low{uniform(draw, -1, 1), uniform(draw, -1, 1), 0},
        high{low[0] + uniform(draw, 0.1, 1), low[1] + uniform(draw, 0.1, 1), 0};
    check_plane(
        outline(BoxShape{low, high}, spacing, 2),
        {divided({{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}, spacing)},
        1e-14);
  }
}

TEST_CASE("round shapes are outlined at equal distances along them, holes the other way round") {
  Draw draw(42);
  for (int round = 0; round < 20; ++round) {
    CAPTURE(round);
    const double spacing = uniform(draw, 0.05, 0.5), angle = uniform(draw, -3, 3);
    const Vec3 centre{uniform(draw, -2, 2), uniform(draw, -2, 2), 0};
    const double a = uniform(draw, 0.3, 1), b = round % 4 == 0 ? a : uniform(draw, 0.3, 1);
    check_plane(outline(EllipsoidShape{centre, {a, b, 0}, angle}, spacing, 2),
                {ellipse(centre, a, b, angle, spacing)}, 1e-6);
    const double outer = uniform(draw, 0.5, 1), inner = round % 3 == 0 ? 0 : uniform(draw, 0.1, 0.4);
    std::vector<Loop> loops{ellipse(centre, outer, outer, 0, spacing)};
    if (inner > 0) {
      loops.push_back(ellipse(centre, inner, inner, 0, spacing));
      std::reverse(loops.back().begin(), loops.back().end());
    }
    check_plane(outline(RingShape{centre, inner, outer, 0}, spacing, 2), loops, 1e-12);
  }
}

using EdgeAt = std::array<int, 3>;  ///< pixel x, y, whether it leads upwards

/// The level where a picture, softened twice by 1 2 1 each way, is one half: cell by cell out of the sixteen
/// ways in which the corners of one can be in or out, then led from edge to edge.
std::vector<Loop> level_lines(const BitmapShape& shape, double spacing) {
  const GreyImage& image = *shape.image;
  const auto share = [&](int x, int y) {
    constexpr double kWeight[5] = {1. / 16, 4. / 16, 6. / 16, 4. / 16, 1. / 16};
    double sum = 0;
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        const int u = x + i, v = image.height - 1 - (y + j);
        if (u < 0 || u >= image.width || v < 0 || v >= image.height) continue;
        if (image.pixel[static_cast<std::size_t>(v * image.width + u)] == shape.grey)
          sum += kWeight[i + 2] * kWeight[j + 2];
      }
    return sum;
  };
  std::map<EdgeAt, EdgeAt> next;
  for (int y = -3; y < image.height + 2; ++y)
    for (int x = -3; x < image.width + 2; ++x) {
      const double s[4] = {share(x, y), share(x + 1, y), share(x + 1, y + 1), share(x, y + 1)};
      const EdgeAt edge[4] = {{x, y, 0}, {x + 1, y, 1}, {x, y + 1, 0}, {x, y, 1}};
      const bool joined = (s[0] + s[1] + s[2] + s[3]) / 4 > 0.5;
      int in = 0;
      for (int k = 0; k < 4; ++k) in |= (s[k] > 0.5) << k;
      const auto go = [&](int from, int to) { next[edge[from]] = edge[to]; };
      switch (in) {
        case 1:
          go(0, 3);
          break;
        case 2:
          go(1, 0);
          break;
        case 3:
          go(1, 3);
          break;
        case 4:
          go(2, 1);
          break;
        case 5:
          joined ? (go(0, 1), go(2, 3)) : (go(0, 3), go(2, 1));
          break;
        case 6:
          go(2, 0);
          break;
        case 7:
          go(2, 3);
          break;
        case 8:
          go(3, 2);
          break;
        case 9:
          go(0, 2);
          break;
        case 10:
          joined ? (go(1, 2), go(3, 0)) : (go(1, 0), go(3, 2));
          break;
        case 11:
          go(1, 2);
          break;
        case 12:
          go(3, 1);
          break;
        case 13:
          go(0, 1);
          break;
        case 14:
          go(3, 0);
          break;
        default:
          break;
      }
    }
  const auto position = [&](const EdgeAt& e) {
    const double a = share(e[0], e[1]), b = e[2] ? share(e[0], e[1] + 1) : share(e[0] + 1, e[1]),
                 t = (0.5 - a) / (b - a);
    const Point pixel{e[0] + 0.5 + (e[2] ? 0 : t), e[1] + 0.5 + (e[2] ? t : 0)};
    const int count[2] = {image.width, image.height};
    Point out;
    for (std::size_t d = 0; d < 2; ++d)
      out[d] = std::clamp(shape.lower[d] + pixel[d] * (shape.upper[d] - shape.lower[d]) / count[d],
                          shape.lower[d], shape.upper[d]);
    return out;
  };
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop line;
    for (EdgeAt at = next.begin()->first; next.count(at);) {
      line.push_back(position(at));
      const EdgeAt on = next.at(at);
      next.erase(at);
      at = on;
    }
    const std::size_t n = line.size();
    double length = 0;
    for (std::size_t k = 0; k < n; ++k)
      length += std::hypot(line[(k + 1) % n][0] - line[k][0], line[(k + 1) % n][1] - line[k][1]);
    const int count = static_cast<int>(length / spacing + 0.5);
    if (count < 4) continue;
    Loop even;
    for (int i = 0; i < count; ++i) {
      double rest = length * i / count;
      for (std::size_t k = 0; k < n; ++k) {
        const Point &a = line[k], &b = line[(k + 1) % n];
        const double step = std::hypot(b[0] - a[0], b[1] - a[1]);
        if (rest < step || k + 1 == n) {
          even.push_back({a[0] + rest / step * (b[0] - a[0]), a[1] + rest / step * (b[1] - a[1])});
          break;
        }
        rest -= step;
      }
    }
    loops.push_back(even);
  }
  return loops;
}

TEST_CASE("a level of a picture is outlined where its softened share is one half, at even distances") {
  Draw draw(43);
  int lines = 0;
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    auto image = std::make_shared<GreyImage>();
    image->width = whole(draw, 3, 14);
    image->height = whole(draw, 3, 14);
    const int coarse = whole(draw, 2, 5);  // pixels of a patch
    for (int y = 0; y < image->height; ++y)
      for (int x = 0; x < image->width; ++x)
        image->pixel.push_back(static_cast<unsigned char>(
            (x / coarse * 7 + y / coarse * 11 + (x / coarse) * (y / coarse) * 5 + round) % 3));
    BitmapShape shape{"", {uniform(draw, -2, 2), uniform(draw, -2, 2), 0}, {}, 1, image};
    shape.upper = {shape.lower[0] + uniform(draw, 0.5, 2), shape.lower[1] + uniform(draw, 0.5, 2), 0};
    const double spacing = uniform(draw, 0.02, 0.15);
    const std::vector<Loop> wanted = level_lines(shape, spacing);
    lines += static_cast<int>(wanted.size());
    const Outline got = outline(shape, spacing, 2);
    std::size_t points = 0;
    for (const Loop& loop : wanted) points += loop.size();
    REQUIRE(got.points.size() == points);
    std::size_t p = 0;
    for (const Loop& loop : wanted)
      for (const Point& at : loop) {
        REQUIRE(std::abs(got.points[p][0] - at[0]) < 1e-6);
        REQUIRE(std::abs(got.points[p++][1] - at[1]) < 1e-6);
      }
    // Which joints there are follows from the points themselves.
    std::vector<Loop> exact;
    p = 0;
    for (const Loop& loop : wanted) {
      exact.emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k, ++p)
        exact.back().push_back({got.points[p][0], got.points[p][1]});
    }
    check_plane(got, exact, 1e-15);
  }
  CHECK(lines > 40);
  CHECK(outline(BitmapShape{"", {0, 0, 0}, {1, 1, 0}, 1, nullptr}, 0.1, 2).points.empty());
}

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

/// A closed surface: each edge is passed once each way, joints are those of the angles between the facets,
/// and patches are what hangs together over smooth ones, numbered as they come. Returns its volume.
double check_closed(const Outline& solid) {
  const auto at = [&](int k) -> const Vec3& { return solid.points[static_cast<std::size_t>(k)]; };
  std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> sides;  // from, to: facet, opposite
  for (std::size_t f = 0; f < solid.facets.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = solid.facets[f].point;
      REQUIRE(sides.insert({{p[(k + 1) % 3], p[(k + 2) % 3]}, {f, k}}).second);
    }
  std::vector<std::size_t> root(solid.facets.size());
  for (std::size_t f = 0; f < root.size(); ++f) root[f] = f;
  const std::function<std::size_t(std::size_t)> find = [&](std::size_t f) {
    return root[f] == f ? f : root[f] = find(root[f]);
  };
  for (const auto& [edge, side] : sides) {
    const auto other = sides.find({edge.second, edge.first});
    REQUIRE(other != sides.end());
    const auto& a = solid.facets[side.first].point;
    const auto& b = solid.facets[other->second.first].point;
    const Vec3 na = cross(minus(at(a[1]), at(a[0])), minus(at(a[2]), at(a[0]))),
               nb = cross(minus(at(b[1]), at(b[0])), minus(at(b[2]), at(b[0])));
    const double angle = std::acos(std::clamp(dot(na, nb) / length(na) / length(nb), -1.0, 1.0));
    // The tip of the other facet lies below the plane of this one where the edge sticks out.
    const double above = dot(na, minus(at(b[other->second.second]), at(a[0])));
    const Joint joint = angle <= 0.5 ? Joint::smooth : above < 0 ? Joint::convex : Joint::reentrant;
    REQUIRE(solid.facets[side.first].joint[side.second] == joint);
    if (joint == Joint::smooth) {
      const std::size_t one = find(side.first), two = find(other->second.first);
      root[std::max(one, two)] = std::min(one, two);
    }
  }
  int patches = 0;
  std::map<std::size_t, int> number;
  double volume = 0;
  for (std::size_t f = 0; f < solid.facets.size(); ++f) {
    if (find(f) == f) number[f] = patches++;
    REQUIRE(solid.facets[f].patch == number.at(find(f)));
    const auto& p = solid.facets[f].point;
    volume += dot(at(p[0]), cross(at(p[1]), at(p[2]))) / 6;
  }
  CHECK(solid.patches == patches);
  return volume;
}

using Corners = std::array<Vec3, 3>;

/// What becomes of a triangle whose long edges are halved, again and again: so many pieces, and the sum of
/// their squared areas.
struct Pieces {
  int count = 0;
  double squares = 0;
};
void halve(const Corners& t, double longest, Pieces& out) {
  const auto middle = [](const Vec3& a, const Vec3& b) {
    return Vec3{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  };
  bool cut[3];
  Vec3 m[3];
  int cuts = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    cut[k] = length(minus(b, a)) > longest;
    m[k] = middle(a, b);
    cuts += cut[k];
  }
  if (cuts == 0) {
    const Vec3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    ++out.count;
    out.squares += dot(n, n) / 4;
    return;
  }
  if (cuts == 3) {
    for (std::size_t k = 0; k < 3; ++k) halve({t[k], m[k], m[(k + 2) % 3]}, longest, out);
    return halve({m[0], m[1], m[2]}, longest, out);
  }
  std::size_t k = 0;  // the one that is cut, or the one that is not
  while (cut[k] != (cuts == 1)) ++k;
  const Vec3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
  if (cuts == 1) {
    halve({a, m[k], c}, longest, out);
    return halve({m[k], b, c}, longest, out);
  }
  halve({m[(k + 2) % 3], m[(k + 1) % 3], c}, longest, out);
  halve({a, b, m[(k + 1) % 3]}, longest, out);
  halve({a, m[(k + 1) % 3], m[(k + 2) % 3]}, longest, out);
}

/// The facets of a shape that is not cut, then those of the shape that is.
void check_cut(const Shape& shape, double spacing, double volume) {
  const Outline coarse = outline(shape, 1e9, 3), fine = outline(shape, spacing, 3);
  CHECK(check_closed(coarse) == doctest::Approx(volume).epsilon(1e-12));
  CHECK(check_closed(fine) == doctest::Approx(volume).epsilon(1e-12));
  Pieces wanted, got;
  const auto corners = [](const Outline& of, const Outline::Facet& f) {
    Corners out;
    for (std::size_t k = 0; k < 3; ++k) out[k] = of.points[static_cast<std::size_t>(f.point[k])];
    return out;
  };
  for (const auto& f : coarse.facets) halve(corners(coarse, f), 1.4 * spacing, wanted);
  for (const auto& f : fine.facets) {
    const Corners t = corners(fine, f);
    for (std::size_t k = 0; k < 3; ++k)
      REQUIRE(length(minus(t[k], t[(k + 1) % 3])) <= 1.4 * spacing * (1 + 1e-12));
    halve(t, 1e9, got);
  }
  CHECK(got.count == wanted.count);
  CHECK(got.squares == doctest::Approx(wanted.squares).epsilon(1e-10));
}

TEST_CASE("prisms and bodies of triangles are closed, keep their volume, and long edges are halved") {
  Draw draw(44);
  for (int round = 0; round < 12; ++round) {
    CAPTURE(round);
    const double spacing = uniform(draw, 0.2, 0.6);
    const Loop polygon = star(draw, round % 2 == 1);
    const double low = uniform(draw, -1, 0), high = low + uniform(draw, 0.2, 1.3);
    const Shape prism = PolygonShape{polygon, low, high};
    check_cut(prism, spacing, std::abs(area_of(polygon)) * (high - low));
    const auto corners = polygon.size();
    CHECK(outline(prism, 1e9, 3).facets.size() == 2 * corners + 2 * (corners - 2));
    CHECK(outline(prism, 1e9, 3).points.size() == 2 * corners);
    check_cut(BoxShape{{low, 2 * low, 0.1}, {high, 2 * high, 0.9}}, spacing,
              2 * (high - low) * (high - low) * 0.8);
    for (const bool turned : {false, true}) {
      Solid solid = round % 2 ? star_prism(3 + round / 4) : thread_of(1 + 0.1 * round);
      const double volume = enclosed_volume(solid.points, solid.triangles);
      CHECK(volume > 0);
      if (turned)
        for (auto& t : solid.triangles) std::swap(t[1], t[2]);
      StlShape stl;
      stl.surface = std::make_shared<Surface>(solid.points, solid.triangles);
      check_cut(stl, spacing, volume);
    }
  }
  CHECK(outline(BitmapShape{}, 0.1, 3).points.empty());
}

TEST_CASE("an ellipsoid has the triangles of a ball of as many as its largest radius has space for") {
  Draw draw(45);
  for (int round = 0; round < 10; ++round) {
    CAPTURE(round);
    const double spacing = uniform(draw, 0.15, 0.9), angle = uniform(draw, -3, 3);
    const EllipsoidShape shape{{uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1)},
                               {uniform(draw, 0.3, 1), uniform(draw, 0.3, 1), uniform(draw, 0.3, 1)},
                               angle};
    const Outline solid = outline(shape, spacing, 3);
    const double largest = std::max({shape.radii[0], shape.radii[1], shape.radii[2]});
    // The angle between two corners of an icosahedron.
    const auto n = static_cast<std::size_t>(
        std::max(2, static_cast<int>(std::acos(1 / std::sqrt(5.0)) * largest / spacing + 0.5)));
    CHECK(solid.facets.size() == 20 * n * n);
    CHECK(solid.points.size() == 10 * n * n + 2);
    const double volume = check_closed(solid),
                 full = 4 * std::numbers::pi / 3 * shape.radii[0] * shape.radii[1] * shape.radii[2];
    CHECK(volume < full);
    CHECK(volume > full * (1 - 1.2 / static_cast<double>(n * n)));
    for (const Vec3& p : solid.points) {
      const double x = p[0] - shape.centre[0], y = p[1] - shape.centre[1];
      const double u = (x * std::cos(angle) + y * std::sin(angle)) / shape.radii[0],
                   v = (y * std::cos(angle) - x * std::sin(angle)) / shape.radii[1],
                   w = (p[2] - shape.centre[2]) / shape.radii[2];
      REQUIRE(u * u + v * v + w * w == doctest::Approx(1).epsilon(1e-12));
    }
    // Of the ball itself all edges are nearly as long: the longest are less than twice the shortest.
    const Outline ball = outline(EllipsoidShape{{0, 0, 0}, {largest, largest, largest}, 0}, spacing, 3);
    double shortest = 1e9, longest = 0;
    for (const auto& f : ball.facets)
      for (std::size_t k = 0; k < 3; ++k) {
        const double edge = length(minus(ball.points[static_cast<std::size_t>(f.point[k])],
                                         ball.points[static_cast<std::size_t>(f.point[(k + 1) % 3])]));
        shortest = std::min(shortest, edge);
        longest = std::max(longest, edge);
      }
    CHECK(longest < 1.5 * shortest);
  }
}

TEST_CASE("a tube has the points of its section at each of so many turns, and the volume of their prism") {
  Draw draw(46);
  for (int round = 0; round < 16; ++round) {
    CAPTURE(round);
    const double spacing = uniform(draw, 0.1, 0.7);
    RingShape ring{{uniform(draw, -1, 1), uniform(draw, -1, 1), uniform(draw, -1, 1)}, 0, 0, 0};
    ring.outer = uniform(draw, 0.4, 1);
    ring.inner = round % 2 ? ring.outer * uniform(draw, 0.3, 0.8) : 0;
    ring.half_length = uniform(draw, 0.2, 0.8);
    const Outline solid = outline(ring, spacing, 3);
    const auto parts = [&](double of, int least) {
      return std::max(least, static_cast<int>(of / spacing + 0.5));
    };
    const int around = parts(2 * std::numbers::pi * ring.outer, 8),
              across = parts(ring.outer - ring.inner, 1), along = parts(2 * ring.half_length, 1);
    const int quads = 2 * across + (round % 2 ? 2 : 1) * along;
    const int triangles = round % 2 ? 2 * quads * around : 2 * quads * around - 2 * around;
    const int points = round % 2 ? quads * around : (quads - 1) * around + 2;
    CHECK(solid.facets.size() == static_cast<std::size_t>(triangles));
    CHECK(solid.points.size() == static_cast<std::size_t>(points));
    const double turn = 2 * std::numbers::pi / around;
    CHECK(check_closed(solid) ==
          doctest::Approx(around / 2.0 * std::sin(turn) *
                          (ring.outer * ring.outer - ring.inner * ring.inner) * 2 * ring.half_length));
    for (const Vec3& p : solid.points) {
      const double x = p[0] - ring.centre[0], y = p[1] - ring.centre[1], z = p[2] - ring.centre[2];
      const double radius = std::hypot(x, y);
      const double row = (radius - ring.inner) / (ring.outer - ring.inner) * across,
                   level = (z / ring.half_length + 1) / 2 * along, turns = std::atan2(y, x) / turn;
      REQUIRE(std::abs(row - std::round(row)) < 1e-9);
      REQUIRE(std::abs(level - std::round(level)) < 1e-9);
      if (radius > 1e-9) REQUIRE(std::abs(turns - std::round(turns)) < 1e-9);
      const bool on_end = std::abs(std::abs(z) - ring.half_length) < 1e-9,
                 on_side = std::abs(radius - ring.outer) < 1e-9 ||
                           (ring.inner > 0 && std::abs(radius - ring.inner) < 1e-9);
      REQUIRE((on_end || on_side));
    }
  }
}

}  // namespace
}  // namespace mpmfast
