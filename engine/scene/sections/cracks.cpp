#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/geometry/crossing.hpp"
#include "engine/geometry/shapes.hpp"
#include "engine/scene/crack_tips.hpp"
#include "engine/scene/sections/describe.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {

namespace {

using Points = std::vector<std::array<double, 2>>;

/// The corners of a crack, from one end to the other.
void describe_line(Slot& slot, Points& points) {
  if (!take_points(slot, 2, "a list of two or more points [x, y]", points)) return;
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k] == points[k - 1])
      return slot.refuse_item(k, "a point apart from the one before was expected");
  if (crosses_itself(points)) slot.report("a crack must not cross or touch itself");
}

/// Does any part of a line lie in a shape? It is looked at where it passes through the box around that.
bool runs_through(const Shape& shape, const Points& points) {
  constexpr int kSamples = 400;  // along each segment
  const Bounds box = bounds(shape);
  for (std::size_t k = 1; k < points.size(); ++k) {
    double first = 0, last = 1;
    for (std::size_t d = 0; d < 2; ++d) {
      const double from = points[k - 1][d], way = points[k][d] - from;
      if (way == 0 && (from < box.lower[d] || from > box.upper[d])) last = -1;
      if (way == 0) continue;
      const double low = (box.lower[d] - from) / way, high = (box.upper[d] - from) / way;
      first = std::max(first, std::min(low, high));
      last = std::min(last, std::max(low, high));
    }
    for (int sample = 0; first <= last && sample <= kSamples; ++sample) {
      const double share = first + (last - first) * sample / kSamples;
      const auto at = [&](std::size_t d) {  // (along an axis exactly on it: edges belong to one side alone)
        return points[k - 1][d] + share * (points[k][d] - points[k - 1][d]);
      };
      if (contains(shape, {at(0), at(1), 0})) return true;
    }
  }
  return false;
}

double length_of(const Points& points) {
  double sum = 0;
  for (std::size_t k = 1; k < points.size(); ++k)
    sum += std::hypot(points[k][0] - points[k - 1][0], points[k][1] - points[k - 1][1]);
  return sum;
}

/// Does one crack go on where another ends, or lie on it?
bool go_on(const Points& one, const Points& other, double cell) {
  const double near = 1e-3 * cell;
  const auto apart = [](const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); };
  for (const Point2& a : {one.front(), one.back()})
    for (const Point2& b : {other.front(), other.back()})
      if (apart(a, b) < near) return true;
  const auto on = [&](const Point2& a, const Point2& b, const Point2& x) {
    const double length = apart(a, b),
                 along = ((x[0] - a[0]) * (b[0] - a[0]) + (x[1] - a[1]) * (b[1] - a[1])) / length;
    return std::abs(turn(a, b, x)) < near * length && along > near && along < length - near;
  };
  for (std::size_t k = 1; k < one.size(); ++k)
    for (std::size_t m = 1; m < other.size(); ++m) {
      const Point2 &a = one[k - 1], &b = one[k], &c = other[m - 1], &d = other[m];
      const bool parallel =
          std::abs(turn(a, b, c)) < near * apart(a, b) && std::abs(turn(a, b, d)) < near * apart(a, b);
      if (parallel && (on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b))) return true;
    }
  return false;
}

/// As corners, in steps of at most five degrees.
void describe_arc(Slot& slot, Points& points) {
  constexpr double kStep = std::numbers::pi / 36;
  Vec3 centre{};
  double radius = 0, from = 0, to = 0;
  slot.map("a map {centre, radius, from, to}", [&](Keys& map) {
    map.need("centre", "Its middle.", centre, Vector{Measure::length, 2});
    map.need("radius", "Its radius.", radius, Number{Measure::length, kPositive});
    map.need("from", "Angle of its first end, from x towards y.", from, Number{Measure::angle});
    map.need("to", "Angle of the other end.", to, Number{Measure::angle});
  });
  if (!slot.reads() || !slot.good()) return;
  if (from == to || std::abs(to - from) >= 2 * std::numbers::pi)
    return slot.report("an arc of more than nothing and less than a full turn was expected");
  const int steps = static_cast<int>(std::ceil(std::abs(to - from) / kStep));
  points.clear();
  for (int k = 0; k <= steps; ++k) {
    const double angle = from + (to - from) * k / steps;
    points.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
  }
}

/// What a crack must be by itself and in its body.
void check_crack(Slot& slot, const Scene& scene, const CrackSpec& crack) {
  constexpr double kFinest = 0.01;  // cells
  constexpr double kMost = 1e6;     // points
  const BodySpec& body = scene.bodies[static_cast<std::size_t>(crack.body)];
  const auto shares = [&](const BodySpec& other) {
    return &other != &body && !is_rigid(scene, other) && (!scene.contact.active || other.field == body.field);
  };
  if (is_rigid(scene, body)) slot.report(fmt::format("'{}' is rigid: nothing in it opens", body.name));
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), shares))
    slot.report(
        fmt::format("'{}' shares its velocity field with other bodies, which it would part too", body.name));
  const double cell = scene.grid.cell;  // 0 where the grid has a fault of its own
  if (cell > 0 && (crack.spacing > cell || crack.spacing < kFinest * cell))
    slot.report(fmt::format("a spacing of a hundredth of a cell to a cell ({} m) was expected", cell));
  else if (cell > 0 && length_of(crack.points) / crack.spacing > kMost)
    slot.report("a crack of at most a million points was expected");
  if (!runs_through(body.shape, crack.points))
    slot.report(fmt::format("no part of it lies in '{}'", body.name));
  for (const CrackSpec& other : scene.cracks) {
    if (other.name == crack.name) slot.report(fmt::format("a crack is called '{}' already", crack.name));
    if (other.body == crack.body && go_on(other.points, crack.points, scene.grid.cell))
      slot.report(
          fmt::format("it goes on where '{}' ends, or lies on it: one line was expected", other.name));
  }
}

/// What new sides take to part. Where the crack's law has no bond they have one of that toughness, whose
/// strength makes the zone in which it softens, E′ G/σ², as long as cells can follow.
void describe_growth(Keys& map, const Scene& scene, CrackSpec& crack) {
  GrowthSpec& growth = crack.growth;
  auto* own = std::get_if<Cohesive>(&crack.law.acts);
  growth.active = true;
  if (own) growth.toughness = own->normal_toughness;
  const bool stated = map.derived("toughness",
                                  "What it takes to grow, of its area: G_c = K_c^2/E'; that of its law, if "
                                  "that is cohesive.",
                                  growth.toughness, Number{Measure::surface_energy, kPositive});
  map.key("rule", "When it grows, and whereto.", growth.rule, kGrowthRules);
  map.key("advance", "By how much at once, in cells.", growth.advance,
          Number{Measure::number, {"between 0.25 and 1", 0.25, 1}});
  map.key("zone", "Over so many cells new sides soften, where the law of the crack is not cohesive.",
          growth.zone, Number{Measure::number, {"1 or more", 1}});
  if (!map.reads() || !map.good() || !stated || crack.body < 0) return;
  const auto& body = scene.bodies[static_cast<std::size_t>(crack.body)];
  if (body.material < 0) return;
  const double modulus =
      std::visit([&](const auto& law) { return plane_modulus(law, scene.space == Space::plane_stress); },
                 scene.materials[static_cast<std::size_t>(body.material)].model);
  if (modulus == 0)
    return map.report(fmt::format("'{}' has no shear modulus: cracks grow in solids", body.name));
  if (own && growth.toughness != own->normal_toughness)
    return map.report("where the crack is cohesive its normal_toughness is the toughness");
  if (own) return;
  if (growth.toughness == 0)
    return map.report("toughness: missing (an energy of a surface: J/m^2, N/m, N/mm)");
  if (!std::holds_alternative<Frictionless>(crack.law.acts) &&
      !std::holds_alternative<Coulomb>(crack.law.acts))
    return map.report("the sides of a crack that grows are frictionless, coulomb or cohesive");
  Cohesive bond;
  if (const auto* coulomb = std::get_if<Coulomb>(&crack.law.acts)) {
    bond.friction = coulomb->friction;
    bond.static_friction = coulomb->static_friction;
  }
  bond.normal_toughness = bond.shear_toughness = growth.toughness;
  bond.normal_strength = bond.shear_strength =
      std::sqrt(modulus * growth.toughness / (growth.zone * scene.grid.cell));
  crack.law.acts = bond;
}

void describe_crack(Slot& slot, const Scene& scene, CrackSpec& crack) {
  slot.map("a map {body, line: [[x, y], …], law, …}", [&](Keys& map) {
    map.derived("name", "Heads its columns; crack1, crack2, … if not given.", crack.name, Name{});
    map.need_at("body", "Which body it is in.", "the name of a body",
                [&](Slot& body) { body.reference(crack.body, names_of(scene.bodies)); });
    const auto choice = map.one_of({{"line"}, {"arc"}}, 0);
    if (choice.none()) map.report("a crack is a line or an arc");
    if (choice.takes(0))
      map.need_at("line", "Its corners, from one end to the other.", "a list of points [x, y]",
                  [&](Slot& line) { describe_line(line, crack.points); });
    if (choice.takes(1))
      map.need_at("arc", "Part of a circle.", "a map {centre, radius, from, to}",
                  [&](Slot& arc) { describe_arc(arc, crack.points); });
    map.derived("spacing", "Of the points that follow it; half a cell if not given.", crack.spacing,
                Number{Measure::length, kPositive});
    map.key("contour", "Radius about its ends in which J and stress intensities are found, in cells.",
            crack.contour, Number{Measure::number, kPositive});
    describe_tractions(map, "What its sides do that touch; what it leaves out is that of `contact`.",
                       crack.law);
    map.at("growth", "Lets its ends grow that lie in the body.", [&](Slot& growth) {
      if (growth.writes() && !crack.growth.active) return;
      if (growth.reads() && growth.is_keyword("none", false)) return;
      growth.map("a map {toughness, rule, …}", [&](Keys& keys) { describe_growth(keys, scene, crack); });
    });
  });
}

}  // namespace

void describe_cracks(Keys& top, Scene& scene) {
  constexpr int kMostCracks = 10000;
  top.at("cracks", "Surfaces inside of bodies, closed at the start, whose sides come apart, touch and slide.",
         [&](Slot& slot) {
           std::size_t count = scene.cracks.size();
           if (slot.writes() && count == 0) return;
           if (slot.reads() && slot.is_keyword("none", false)) return;
           slot.list("a list of maps {body, line | arc, law, …}", 0, kMostCracks, count,
                     [&](Slot& entry, std::size_t k) {
                       CrackSpec crack;
                       if (entry.writes()) crack = scene.cracks[k];
                       if (entry.reads()) {
                         crack.name = fmt::format("crack{}", k + 1);
                         crack.spacing = 0.5 * scene.grid.cell;
                         crack.law = scene.contact.law;
                       }
                       describe_crack(entry, scene, crack);
                       if (!entry.reads() || !entry.good()) return;
                       check_crack(entry, scene, crack);
                       scene.cracks.push_back(crack);
                       const auto tips = crack_tips(scene);
                       if (crack.growth.active &&
                           (tips.empty() || tips.back().crack + 1 != static_cast<int>(scene.cracks.size())))
                         entry.report("neither of its ends lies in its body: nothing grows");
                     });
         });
}

std::vector<CrackTip> crack_tips(const Scene& scene) {
  std::vector<CrackTip> tips;
  for (std::size_t c = 0; c < scene.cracks.size(); ++c) {
    const CrackSpec& crack = scene.cracks[c];
    const auto& points = crack.points;
    for (const bool end : {false, true}) {
      const auto& at = end ? points.back() : points.front();
      const auto& before = end ? points[points.size() - 2] : points[1];
      const double dx = at[0] - before[0], dy = at[1] - before[1],
                   ahead = 0.5 * scene.grid.cell / std::hypot(dx, dy);
      if (contains(scene.bodies[static_cast<std::size_t>(crack.body)].shape,
                   {at[0] + ahead * dx, at[1] + ahead * dy, 0}))
        tips.push_back({static_cast<int>(c), end, crack.name + (end ? ".end" : ".start")});
    }
  }
  return tips;
}

void check_cracks(const Value& top, const Scene& scene) {
  const Value stated = *top.find("cracks");
  const auto refuse = [&](bool wrong, const char* what) {
    if (wrong) stated.report(fmt::format("cracks do not know {} yet", what));
  };
  refuse(scene.dimension() == 3, "space: 3d");
  refuse(scene.space == Space::axisymmetric, "space: axisymmetric");
  refuse(scene.heat.active, "heat");
  refuse(scene.method.extended, "extended splines (method.extension)");
  refuse(scene.contact.family == ContactFamily::penalty,
         "surfaces that are followed (contact.family: penalty)");
  refuse(scene.grid.outflow == OutflowKind::outflow, "bodies that flow out (grid.leaving)");
  if (scene.contact.fields != ManyFields::simultaneous)
    stated.report("the sides of cracks meet in pairs: contact.fields: simultaneous was expected");
  if (scene.contact.normal == NormalKind::own_gradient)
    stated.report("the sides of cracks want one normal for both (not contact.normal: own_gradient)");
}

}  // namespace mpmfast
