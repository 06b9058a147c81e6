// Surfaces, polygons and lines that cross, against each triangle, edge and pair of segments looked at alone;
// files of surfaces with a fault at each of their words.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/geometry/crossing.hpp"
#include "engine/geometry/load.hpp"
#include "engine/geometry/outline.hpp"
#include "engine/geometry/polygon.hpp"
#include "engine/geometry/surface.hpp"
#include "tests/unit/geometry_solids.hpp"

namespace mpmfast {
namespace {

using namespace test;
using Draw = std::mt19937_64;
using Point = std::array<double, 2>;

double drawn(Draw& draw, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(draw);
}

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

Surface placed_anyhow(Draw& draw, const Solid& solid) {
  const Vec3 axis = *unit_vector({drawn(draw, -1, 1), drawn(draw, -1, 1), drawn(draw, -1, 1)});
  return Surface(solid.points, solid.triangles)
      .placed(drawn(draw, 0.5, 2), axis, drawn(draw, -3, 3),
              {drawn(draw, -1, 1), drawn(draw, -1, 1), drawn(draw, -1, 1)});
}

Solid ball(double spacing) {
  const Outline around = outline(EllipsoidShape{{0, 0, 0}, {1, 0.7, 0.5}, 0}, spacing, 3);
  Solid out;
  out.points = around.points;
  for (const auto& f : around.facets)
    out.triangles.push_back({static_cast<std::uint32_t>(f.point[0]), static_cast<std::uint32_t>(f.point[1]),
                             static_cast<std::uint32_t>(f.point[2])});
  return out;
}

TEST_CASE("a line along x meets a surface in the triangles over which it passes, and nowhere else") {
  Draw draw(51);
  for (int round = 0; round < 24; ++round) {
    CAPTURE(round);
    const Surface surface = placed_anyhow(draw, round % 3 == 0   ? ball(0.2)
                                                : round % 3 == 1 ? star_prism(3 + round / 3)
                                                                 : thread_of(1 + round));
    const Bounds box = surface.bounds();
    std::vector<Crossing> got{{5, 5}};
    for (int k = 0; k < 60; ++k) {
      const double margin = k % 4 == 0 ? 0.2 : 0;
      const double y = drawn(draw, box.lower[1] - margin, box.upper[1] + margin),
                   z = drawn(draw, box.lower[2] - margin, box.upper[2] + margin);
      std::vector<Crossing> wanted;
      for (const auto& t : surface.triangles()) {
        const Vec3 &a = surface.points()[t[0]], &b = surface.points()[t[1]], &c = surface.points()[t[2]];
        const auto twice = [&](const Vec3& p, const Vec3& q) {
          return (p[1] - y) * (q[2] - z) - (p[2] - z) * (q[1] - y);
        };
        const double u = twice(b, c), v = twice(c, a), w = twice(a, b);
        if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
        wanted.push_back({(u * a[0] + v * b[0] + w * c[0]) / (u + v + w), u > 0 ? -1 : 1});
      }
      std::sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
      surface.crossings(y, z, got);
      REQUIRE(got.size() == wanted.size());
      int sum = 0;
      for (std::size_t n = 0; n < got.size(); ++n) {
        REQUIRE(got[n].x == doctest::Approx(wanted[n].x).epsilon(1e-9));
        REQUIRE(got[n].winding == wanted[n].winding);
        sum += got[n].winding;
      }
      CHECK(sum == 0);
      for (int n = 0; n < 3; ++n) {
        const double x = drawn(draw, box.lower[0] - 0.1, box.upper[0] + 0.1);
        int winding = 0;
        for (const Crossing& c : wanted) winding += c.x < x ? c.winding : 0;
        CHECK(wound_round(got, x) == (winding != 0));
      }
    }
  }
}

TEST_CASE("a surface is scaled, turned about its axis, then moved") {
  Draw draw(52);
  const Solid solid = star_prism(4);
  const Surface start(solid.points, solid.triangles);
  for (int round = 0; round < 20; ++round) {
    const Vec3 axis = *unit_vector({drawn(draw, -1, 1), drawn(draw, -1, 1), drawn(draw, -1, 1)});
    const double angle = round == 0 ? 0 : drawn(draw, -4, 4), scale = drawn(draw, 0.1, 3);
    const Vec3 way{drawn(draw, -1, 1), drawn(draw, -1, 1), drawn(draw, -1, 1)};
    const Surface end = start.placed(scale, axis, angle, way);
    CHECK(end.triangles() == start.triangles());
    // The turn as a quaternion.
    const double w = std::cos(angle / 2), s = std::sin(angle / 2);
    const Vec3 v{s * axis[0], s * axis[1], s * axis[2]};
    for (std::size_t p = 0; p < solid.points.size(); ++p) {
      const Vec3& x = solid.points[p];
      const Vec3 t{2 * (v[1] * x[2] - v[2] * x[1]), 2 * (v[2] * x[0] - v[0] * x[2]),
                   2 * (v[0] * x[1] - v[1] * x[0])};
      const Vec3 turned{x[0] + w * t[0] + v[1] * t[2] - v[2] * t[1],
                        x[1] + w * t[1] + v[2] * t[0] - v[0] * t[2],
                        x[2] + w * t[2] + v[0] * t[1] - v[1] * t[0]};
      for (std::size_t k = 0; k < 3; ++k)
        CHECK(std::abs(end.points()[p][k] - (scale * turned[k] + way[k])) < 1e-14);
    }
    CHECK(enclosed_volume(end.points(), end.triangles()) ==
          doctest::Approx(scale * scale * scale * enclosed_volume(solid.points, solid.triangles)));
  }
  // Six tips of a star prism of height 1.2, each of two triangles about the middle.
  const Solid six = star_prism(6);
  CHECK(enclosed_volume(six.points, six.triangles) ==
        doctest::Approx(12 * 0.5 * 0.55 * std::sin(std::numbers::pi / 6) * 1.2));
}

TEST_CASE(
    "edges without a second triangle, and those between triangles that face different ways, are counted") {
  Draw draw(53);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    Solid solid = round % 2 ? star_prism(3) : ball(0.6);
    for (int k = whole(draw, 0, 3); k > 0; --k) {
      auto& of = solid.triangles;
      const auto t = static_cast<std::size_t>(whole(draw, 0, static_cast<int>(of.size()) - 1));
      const int kind = whole(draw, 0, 2);
      if (kind == 0) of.erase(of.begin() + static_cast<std::ptrdiff_t>(t));
      if (kind == 1) std::swap(of[t][0], of[t][1]);
      if (kind == 2) of.push_back(of[t]);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>>
        edges;  // how often, upwards less down
    for (const auto& t : solid.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = t[k], b = t[(k + 1) % 3];
        auto& edge = edges[std::minmax(a, b)];
        ++edge.first;
        edge.second += a < b ? 1 : -1;
      }
    int open = 0, crossed = 0;
    std::pair<std::uint32_t, std::uint32_t> first_open, first_crossed;
    for (const auto& [edge, n] : edges) {
      if (n.second == 0) continue;
      if (n.first % 2 == 1 && open++ == 0) first_open = edge;
      if (n.first % 2 == 0 && crossed++ == 0) first_crossed = edge;
    }
    const auto text = [&](std::uint32_t p) {
      const Vec3& x = solid.points[p];
      return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
    };
    std::string wanted;
    if (crossed > 0)
      wanted = fmt::format("{} edges have triangles that face different ways, the first from {} to {}",
                           crossed, text(first_crossed.first), text(first_crossed.second));
    if (open > 0)
      wanted = fmt::format("not a closed surface: {} edges have no second triangle, the first from {} to {}",
                           open, text(first_open.first), text(first_open.second));
    CHECK(Surface::fault(solid.points, solid.triangles) == wanted);
  }
  // As thin as round-off, and less: of a box whose lid leans by a little.
  Solid thin = thread_of(1);
  for (const double height : {1e-11, 1e-14}) {
    Solid flat = thin;
    for (Vec3& p : flat.points) p[2] = p[0] + p[1];
    flat.points[3][2] += height;
    CHECK(Surface::fault(flat.points, flat.triangles) ==
          (height > 1e-12 ? "" : "the surface encloses no volume"));
    for (auto& t : flat.triangles) std::swap(t[0], t[1]);
    CHECK(Surface::fault(flat.points, flat.triangles) ==
          (height > 1e-12 ? "" : "the surface encloses no volume"));
  }
  for (Vec3& p : thin.points)
    for (double& x : p) x *= 1e110;
  CHECK(Surface::fault(thin.points, thin.triangles) == "the surface encloses no volume");
}

std::string fault_of(const std::string& content) {
  std::string why;
  const auto got = decode_stl({reinterpret_cast<const unsigned char*>(content.data()), content.size()}, why);
  return got ? "read" : why;
}

std::shared_ptr<const Surface> decoded(const std::string& content) {
  std::string why;
  const auto got = decode_stl({reinterpret_cast<const unsigned char*>(content.data()), content.size()}, why);
  REQUIRE_MESSAGE(got, why);
  return got;
}

void check_holds(const Surface& surface, const Solid& solid, bool single) {
  const auto stored = [&](double x) {
    const volatile float near = static_cast<float>(x);  // which optimisation does not take away
    return single ? static_cast<double>(near) : x;
  };
  std::set<Vec3> points;
  for (const Vec3& p : solid.points) points.insert({stored(p[0]), stored(p[1]), stored(p[2])});
  CHECK(surface.points() == std::vector<Vec3>(points.begin(), points.end()));
  REQUIRE(surface.triangles().size() == solid.triangles.size());
  for (std::size_t t = 0; t < solid.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = solid.points[solid.triangles[t][k]];
      REQUIRE(surface.points()[surface.triangles()[t][k]] == Vec3{stored(p[0]), stored(p[1]), stored(p[2])});
    }
}

/// A word of a text, and what is said to be expected where another stands.
struct Expected {
  std::string word, what;
};

std::vector<Expected> words_of(const Solid& solid) {
  std::vector<Expected> out{{"solid", ""}};
  for (const auto& t : solid.triangles) {
    out.push_back({"facet", "'facet' or 'endsolid'"});
    out.push_back({"normal", "'normal'"});
    for (const char* n : {"0", "-1e0", "+.5"}) out.push_back({n, "a number"});
    out.push_back({"outer", "'outer'"});
    out.push_back({"loop", "'loop'"});
    for (const std::uint32_t p : t) {
      out.push_back({"vertex", "'vertex'"});
      for (const double x : solid.points[p]) out.push_back({fmt::format("{}", x), "a number"});
    }
    out.push_back({"endloop", "'endloop'"});
    out.push_back({"endfacet", "'endfacet'"});
  }
  out.push_back({"endsolid", "'facet' or 'endsolid'"});
  return out;
}

TEST_CASE("a text of a surface is read in any spelling, and a wrong or missing word is told with its line") {
  const Solid solid = thread_of(1.3);
  const std::vector<Expected> words = words_of(solid);
  // Each word on a line of its own, but for the first, whose line is its name's.
  const auto text_of = [&](std::size_t count, std::size_t wrong) {
    std::string out;
    for (std::size_t k = 0; k < count; ++k) out += (k == wrong ? "wrong" : words[k].word) + "\n";
    return out;
  };
  check_holds(*decoded(text_of(words.size(), 999)), solid, false);
  for (std::size_t k = 1; k < words.size(); ++k) {
    CHECK(fault_of(text_of(words.size(), k)) ==
          fmt::format("line {}: {} was expected, got 'wrong'", k + 1, words[k].what));
    CHECK(fault_of(text_of(k, 999)) ==
          fmt::format("line {}: {} was expected, got the end of the file", k + 1, words[k].what));
  }
  std::string loud = "solid facet normal of a name\r\n";
  for (std::size_t k = 1; k < words.size(); ++k) {
    for (const char c : words[k].word) loud += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    loud += k % 3 == 0 ? " \t" : k % 3 == 1 ? "\r\n\n" : "\t";
  }
  while (std::isspace(static_cast<unsigned char>(loud.back()))) loud.pop_back();
  check_holds(*decoded(loud + " a name\n\n"), solid, false);
  // Two solids in a file.
  std::string two = text_of(words.size(), 999) + "solid again\n";
  for (std::size_t k = 1; k < words.size(); ++k) {
    const bool moved = words[k].what == "a number" && words[k].word.find("e0") == std::string::npos;
    two += (moved ? fmt::format("{}", 10 + std::stod(words[k].word)) : words[k].word) + " ";
  }
  CHECK(decoded(two)->triangles().size() == 8);
  CHECK(decoded(two)->points().size() == 8);
  CHECK(fault_of(text_of(words.size(), 999) + "\nmore\n") ==
        fmt::format("line {}: 'solid' was expected, got 'more'", words.size() + 2));
  const auto with = [&](const std::string& number) {
    std::string out = text_of(words.size(), 999);
    const std::size_t at = out.find("vertex\n0.1\n") + 7;
    return out.replace(at, 3, number);
  };
  REQUIRE(fault_of(with("0.1")) == "read");
  for (const char* bad : {"1e999", "-1e999", "nan", "inf", "-inf", "0.1x", "+", "++1", "1,0", "0x1", "e5"})
    CHECK_MESSAGE(fault_of(with(bad)) == fmt::format("line 10: a number was expected, got '{}'", bad), bad);
  for (const char* good : {"1e-999", "-1e-999", "+0.1", "-0.125e0", "1.e-1"}) {
    const std::string said = fault_of(with(good));  // of a corner that moved alone the surface is open
    CHECK_MESSAGE(said.find("line") != 0, good);
  }
  CHECK(decoded(with("0.1"))->points().front() == Vec3{0, 0.8, -0.1});
  CHECK(fault_of("solid\n" + std::string(70, 'x')) ==
        "line 2: 'facet' or 'endsolid' was expected, got '" + std::string(60, 'x') + "'");
  CHECK(fault_of(text_of(words.size(), 999) + std::string(1, '\0')).find("not an STL file, or cut short") ==
        0);
  CHECK(fault_of("soli").find("not an STL file (text that begins") == 0);
}

std::string binary_of(const Solid& solid) {
  std::string out(80, ' ');
  const auto put = [&](auto value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
  };
  put(static_cast<std::uint32_t>(solid.triangles.size()));
  for (const auto& t : solid.triangles) {
    for (int k = 0; k < 3; ++k) put(std::numeric_limits<float>::quiet_NaN());  // normals are not read
    for (const std::uint32_t p : t)
      for (const double x : solid.points[p]) put(static_cast<float>(x));
    put(std::uint16_t{0xFFFF});
  }
  return out;
}

TEST_CASE("a binary surface is read to the bit, at its own length alone, with finite corners alone") {
  const Solid solid = star_prism(3);
  const std::string good = binary_of(solid);
  check_holds(*decoded(good), solid, true);
  const std::size_t triangles = solid.triangles.size();
  for (std::size_t size = 0; size < good.size() + 60; size += size < 90 ? 1 : 7) {
    if (size == good.size()) continue;
    std::string cut = good;
    cut.resize(size);
    CAPTURE(size);
    CHECK(fault_of(cut) ==
          (size < 84
               ? std::string("not an STL file (text that begins with 'solid', or 84 bytes and 50 for each "
                             "triangle)")
               : fmt::format("not an STL file, or cut short: {} bytes, but {} triangles, as its head says, "
                             "have {}",
                             size, triangles, good.size())));
  }
  for (std::size_t t = 0; t < triangles; ++t)
    for (std::size_t k = 0; k < 9; ++k)
      for (const float x :
           {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        std::string bad = good;
        std::memcpy(bad.data() + 84 + 50 * t + 12 + 4 * k, &x, 4);
        CHECK(fault_of(bad) == fmt::format("triangle {} has a corner at {} (finite numbers)", t, x));
      }
  // Triangles that are a line or a point hold nothing together and nothing apart.
  Solid more = solid;
  more.triangles.insert(more.triangles.begin() + 3, {{{0, 1, 0}}, {{2, 2, 2}}, {{4, 4, 5}}, {{4, 5, 5}}});
  check_holds(*decoded(binary_of(more)), solid, true);
}

using Whole = std::array<int, 2>;

long turn_of(const Whole& a, const Whole& b, const Whole& c) {
  return long{b[0] - a[0]} * (c[1] - a[1]) - long{b[1] - a[1]} * (c[0] - a[0]);
}

bool on_segment(const Whole& a, const Whole& b, const Whole& c) {
  if (a == b) return c == a;
  if (turn_of(a, b, c) != 0) return false;
  const long along = long{c[0] - a[0]} * (b[0] - a[0]) + long{c[1] - a[1]} * (b[1] - a[1]);
  const long all = long{b[0] - a[0]} * (b[0] - a[0]) + long{b[1] - a[1]} * (b[1] - a[1]);
  return along >= 0 && along <= all;
}

bool share_a_point(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
  if (on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)) return true;
  const auto sign = [](long x) { return (x > 0) - (x < 0); };
  return sign(turn_of(a, b, c)) * sign(turn_of(a, b, d)) < 0 &&
         sign(turn_of(c, d, a)) * sign(turn_of(c, d, b)) < 0;
}

/// Whether two segments that follow each other overlap.
bool goes_back(const Whole& a, const Whole& b, const Whole& c) {
  return turn_of(a, b, c) == 0 && long{a[0] - b[0]} * (c[0] - b[0]) + long{a[1] - b[1]} * (c[1] - b[1]) > 0;
}

TEST_CASE("the first fault of a polygon is found among all pairs of its edges") {
  Draw draw(54);
  std::map<char, int> kinds;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Whole> points(static_cast<std::size_t>(whole(draw, 3, 6)));
    for (Whole& p : points) p = {whole(draw, -2, 2), whole(draw, -2, 2)};
    std::vector<Point> real;
    for (const Whole& p : points) real.push_back({0.25 * p[0], 0.25 * p[1]});
    const std::size_t n = points.size();
    const auto wanted = [&]() -> std::string {
      if (points.front() == points.back())
        return "a polygon closes by itself: leave out the last point, it repeats the first";
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        if (points[i] == points[next]) return fmt::format("points {} and {} are the same", i, next);
        if (goes_back(points[i], points[next], points[(i + 2) % n]))
          return fmt::format("the outline folds back at point {}", next);
        for (std::size_t j = i + 2; j < n - (i == 0); ++j)
          if (share_a_point(points[i], points[next], points[j], points[(j + 1) % n]))
            return fmt::format("the outline crosses itself: the edges from point {} and from point {} meet",
                               i, j);
      }
      return "";
    }();
    CHECK(polygon_fault(real) == wanted);
    ++kinds[wanted.empty() ? ' ' : wanted[12]];
  }
  CHECK(kinds[' '] > 300);
  CHECK(polygon_fault({{0, 0}, {1, 0}}) == "a polygon has three or more points");
  std::vector<Point> round;
  for (int k = 0; k < 5001; ++k)
    round.push_back({std::cos(2 * std::numbers::pi * k / 5001), std::sin(2 * std::numbers::pi * k / 5001)});
  CHECK(polygon_fault(round) == "5001 points (at most 5000)");
}

TEST_CASE(
    "a polygon holds the points round which it turns, those on an edge as if a little to the right and up") {
  Draw draw(55);
  for (int round = 0; round < 300; ++round) {
    std::vector<Point> points(static_cast<std::size_t>(whole(draw, 3, 6)));
    for (Point& p : points)
      p = {static_cast<double>(whole(draw, 0, 8)), static_cast<double>(whole(draw, 0, 8))};
    if (!polygon_fault(points).empty()) continue;
    for (int x = -1; x <= 9; ++x)
      for (int y = -1; y <= 9; ++y)
        REQUIRE(polygon_contains(points, x, y) == (std::abs(turns_round(points, x + 1e-4, y + 1e-8)) > 0.5));
  }
}

TEST_CASE("an open line crosses or touches itself where two of its segments do, or one goes back") {
  Draw draw(56);
  int clear = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Whole> points(static_cast<std::size_t>(whole(draw, 2, 6)));
    for (std::size_t k = 0; k < points.size(); ++k) do
        points[k] = {whole(draw, -2, 2), whole(draw, -2, 2)};
      while (k > 0 && points[k] == points[k - 1]);
    bool wanted = false;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      if (k + 2 < points.size() && goes_back(points[k], points[k + 1], points[k + 2])) wanted = true;
      for (std::size_t m = k + 2; m + 1 < points.size(); ++m)
        wanted = wanted || share_a_point(points[k], points[k + 1], points[m], points[m + 1]);
    }
    std::vector<Point> real;
    for (const Whole& p : points) real.push_back({0.5 * p[0], 0.5 * p[1]});
    CHECK(crosses_itself(real) == wanted);
    clear += !wanted;
  }
  CHECK(clear > 500);
}

TEST_CASE("ways between places of a grid cross segments of it as if their ends were moved a little") {
  const auto moved = [](const Point& x) { return Point{x[0] + 1e-4, x[1] + 1e-8}; };
  const auto left = [](const Point& a, const Point& b, const Point& x) {
    return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]) > 0;
  };
  std::vector<Point> grid;
  for (int k = 0; k < 12; ++k)
    grid.push_back({static_cast<double>(k % 4) - 1, static_cast<double>(k / 4) - 1});
  for (const Point& a : grid)
    for (const Point& b : grid)
      for (const Point& p : grid) {
        if (a == b || p == a || p == b) continue;
        LineCrossings lines;
        lines.start(p);
        for (const Point& n : grid) lines.add(n);
        const LineCrossings::Bits of_a = lines.point_is_left(a), of_b = lines.point_is_left(b);
        const auto ends = lines.ends(a, b);
        for (std::size_t k = 0; k < grid.size(); ++k) {
          const Point &n = grid[k], to = moved(n);
          if (n == p) continue;
          const bool a_left = left(p, to, a), b_left = left(p, to, b), n_left = left(a, b, to),
                     p_left = left(a, b, moved(p));
          REQUIRE((of_a >> k & 1) == a_left);
          REQUIRE((of_b >> k & 1) == b_left);
          REQUIRE((ends.left >> k & 1) == n_left);
          REQUIRE((ends.other_side >> k & 1) == (n_left != p_left));
          REQUIRE(is_left(a, b, n) == n_left);
          const int wanted = a_left == b_left || n_left == p_left ? 0 : n_left ? 1 : -1;
          REQUIRE(crossing(p, n, a, b) == wanted);
        }
        REQUIRE(((of_a | of_b | ends.left | ends.other_side) >> grid.size()) == 0);
      }
}

TEST_CASE("a direction is its vector over its length, whatever that is, and one of length 1 stays as it is") {
  Draw draw(57);
  for (const double size : {1e-300, 1e-101, 1e-99, 1e-3, 1.0, 7.0, 1e99, 1e101, 1e300})
    for (int k = 0; k < 20; ++k) {
      Vec3 x{drawn(draw, -1, 1), drawn(draw, -1, 1), drawn(draw, -1, 1)};
      if (k < 6) x[static_cast<std::size_t>(k) % 3] = 0;
      const double length = std::hypot(x[0], x[1], x[2]);
      const auto got = unit_vector({size * x[0], size * x[1], size * x[2]});
      REQUIRE(got);
      for (std::size_t d = 0; d < 3; ++d) CHECK(std::abs((*got)[d] - x[d] / length) < 1e-14);
      CHECK(unit_vector(*got) == got);
    }
  CHECK(!unit_vector({0, 0, 0}));
  GreyImage image;
  image.pixel = {0, 7, 255, 7};
  for (std::size_t k = 0; k < 256; ++k) CHECK(image.levels()[k] == (k == 0 || k == 7 || k == 255));
}

}  // namespace
}  // namespace mpmfast
