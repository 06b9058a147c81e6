#include <fmt/format.h>

#include <cmath>

#include "engine/geometry/load.hpp"
#include "engine/geometry/polygon.hpp"
#include "engine/geometry/surface.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

constexpr const char* kMiddle = "Its middle.";

/// `shape` as one of this kind, which it becomes where it is another.
template <class S>
S& as(Shape& shape) {
  return std::holds_alternative<S>(shape) ? std::get<S>(shape) : shape.emplace<S>();
}

Vector lengths(const Scene& scene, const Limit& limit = kAny) {
  return {Measure::length, scene.dimension(), limit};
}

}  // namespace

void describe_corners(Slot& slot, int dimension, Vec3& lower, Vec3& upper) {
  const Vector corner{Measure::length, dimension};
  slot.map("a map {from, to}", [&](Keys& map) {
    map.need("from", "The corner that is lower in every direction.", lower, corner);
    map.need("to", "The corner that is upper in every direction.", upper, corner);
  });
}

void describe_region(Slot& slot, int dimension, Vec3& lower, Vec3& upper) {
  describe_corners(slot, dimension, lower, upper);
  const bool good = slot.reads() && slot.good();
  for (std::size_t k = 0; good && k < 3; ++k)
    if (lower[k] > upper[k]) slot.report(fmt::format("'to' lies below 'from' in {}", "xyz"[k]));
}

namespace {

void describe_box(Slot& slot, Shape& shape, const Scene& scene) {
  auto& box = as<BoxShape>(shape);
  describe_corners(slot, scene.dimension(), box.lower, box.upper);
  for (std::size_t k = 0; slot.reads() && slot.good() && k < static_cast<std::size_t>(scene.dimension()); ++k)
    if (box.lower[k] >= box.upper[k])
      slot.report(fmt::format("'to' must lie above 'from' in {}, but {} m is not above {} m", "xyz"[k],
                              box.upper[k], box.lower[k]));
}

void describe_round(Slot& slot, Shape& shape, const Scene& scene) {
  auto& round = as<EllipsoidShape>(shape);
  slot.map("a map {centre, radius}", [&](Keys& map) {
    map.need("centre", kMiddle, round.centre, lengths(scene));
    map.need("radius", "Its radius.", round.radii[0], Number{Measure::length, kPositive});
  });
  round.radii = {round.radii[0], round.radii[0], scene.dimension() == 3 ? round.radii[0] : 0.0};
}

void describe_ellipsoid(Slot& slot, Shape& shape, const Scene& scene) {
  auto& round = as<EllipsoidShape>(shape);
  slot.map("a map {centre, radii, angle}", [&](Keys& map) {
    map.need("centre", kMiddle, round.centre, lengths(scene));
    map.need("radii", "Its radii along the axes, before it is turned.", round.radii,
             lengths(scene, kPositive));
    map.key("angle", "Turns it about z.", round.angle, Number{Measure::angle});
  });
}

void describe_ring(Slot& slot, Shape& shape, const Scene& scene) {
  auto& ring = as<RingShape>(shape);
  const bool tube = scene.dimension() == 3;
  slot.map(tube ? "a map {centre, inner, outer, length}" : "a map {centre, inner, outer}", [&](Keys& map) {
    map.need("centre", kMiddle, ring.centre, lengths(scene));
    map.need("inner", "Inner radius.", ring.inner, Number{Measure::length, kNotNegative});
    map.need("outer", "Outer radius.", ring.outer, Number{Measure::length, kPositive});
    double length = 2 * ring.half_length;
    if (tube) map.need("length", "Along z.", length, Number{Measure::length, kPositive});
    ring.half_length = length / 2;
  });
  if (slot.reads() && slot.good() && ring.inner >= ring.outer)
    slot.report(fmt::format("the inner radius must be smaller than the outer, but {} m is not below {} m",
                            ring.inner, ring.outer));
}

void describe_points(Slot& slot, Points2& points) {
  if (!take_points(slot, 3, "a list of three or more points [x, y]", points)) return;
  if (const std::string fault = polygon_fault(points); !fault.empty()) slot.report(fault);
}

void describe_heights(Slot& slot, PolygonShape& polygon) {
  Vec3 ends{polygon.z_lower, polygon.z_upper, 0};
  if (slot.take(ends, Vector{Measure::length, 2}) && slot.reads() && ends[0] >= ends[1])
    slot.report("the upper end must lie above the lower");
  polygon.z_lower = ends[0];
  polygon.z_upper = ends[1];
}

void describe_polygon(Slot& slot, Shape& shape, const Scene& scene) {
  auto& polygon = as<PolygonShape>(shape);
  const bool prism = scene.dimension() == 3;
  if (!prism && (slot.describes() || (slot.reads() && slot.value()->is(Node::Kind::list)))) {
    describe_points(slot, polygon.points);
    if (!slot.describes()) return;
  }
  slot.map(prism ? "a map {points, z: [lower, upper]}" : "a list of points or a map {points}",
           [&](Keys& map) {
             map.need_at("points", "The corners.", "a list of points [x, y]",
                         [&](Slot& list) { describe_points(list, polygon.points); });
             map.under("3d", prism, [&] {
               map.need_at("z", "Lower and upper end.", "a list [lower, upper]",
                           [&](Slot& ends) { describe_heights(ends, polygon); });
             });
           });
}

/// The surface of a file that was read, where it lies in the scene.
void place_surface(Slot& slot, StlShape& shape, const Surface& surface) {
  auto placed =
      std::make_shared<Surface>(surface.placed(shape.scale, shape.axis, shape.angle, shape.translate));
  for (std::size_t k = 0; k < 3; ++k)
    if (!std::isfinite(placed->bounds().lower[k]) || !std::isfinite(placed->bounds().upper[k]))
      return slot.report("the surface is out of range once scaled and moved (finite places)");
  shape.surface = std::move(placed);
}

void describe_stl(Slot& slot, Shape& shape, const Scene& scene) {
  auto& stl = as<StlShape>(shape);
  std::shared_ptr<const Surface> surface;
  slot.map("a map {file, scale, angle, axis, translate}", [&](Keys& map) {
    map.need_at("file", "Path, counted from the folder of the scene.", "an STL file, text or binary",
                [&](Slot& file) {
                  describe_file(file, scene, stl.file);
                  if (!file.reads() || !file.good()) return;
                  std::string why_not;
                  surface = load_stl(stl.file, why_not);
                  if (!surface)
                    file.complain(fmt::format("cannot read the surface {}: {}", stl.file.string(), why_not));
                });
    // The format knows no units, and metres are rarely meant.
    map.need("scale", "Length of the file's unit.", stl.scale, Number{Measure::length, kPositive});
    map.key("angle", "Turns it about `axis` through the origin of the file.", stl.angle,
            Number{Measure::angle});
    map.at("axis", "The axis that `angle` turns it about.",
           [&](Slot& axis) { describe_direction(axis, 3, true, stl.axis); });
    map.key("translate", "Moves it, after it is turned.", stl.translate, Vector{Measure::length, 3});
  });
  if (slot.reads() && slot.good()) place_surface(slot, stl, *surface);
}

}  // namespace

const std::vector<ShapeKind>& shape_kinds() {
  static const std::vector<ShapeKind> kKinds{
      {"box", 0, "edges along the axes; its volume is exact", "A box along the axes.", describe_box,
       BoxShape{}, true},
      {"disk", 2, "2-D", "A disk, in 2-D.", describe_round, EllipsoidShape{}, false},
      {"sphere", 3, "3-D", "A sphere, in 3-D.", describe_round, EllipsoidShape{}, false},
      {"ellipse", 2, "2-D, turned by angle", "An ellipse, in 2-D.", describe_ellipsoid, EllipsoidShape{},
       true},
      {"ellipsoid", 3, "3-D, turned by angle about z", "An ellipsoid, in 3-D.", describe_ellipsoid,
       EllipsoidShape{}, true},
      {"ring", 2, "2-D", "A ring, in 2-D.", describe_ring, RingShape{}, true},
      {"tube", 3, "3-D, along z; a cylinder when inner is 0", "A tube or a cylinder along z, in 3-D.",
       describe_ring, RingShape{}, true},
      {"polygon", 0, "simple, closed by itself; in 3-D extruded along z",
       "A polygon by its corners, closed by itself; in 3-D a map, extruded along z.", describe_polygon,
       PolygonShape{}, true},
      {"bitmap", 2,
       "2-D, an 8-bit grey PNG (beside it extent, origin, skip, materials): each grey level is a body "
       "NAME_LEVEL",
       "A grey PNG with 8 bits, in 2-D: each grey level is a body NAME_LEVEL.", nullptr, BitmapShape{}, true},
      {"stl", 3,
       "3-D, a closed surface: scale is the length of the file's unit; turned about its origin, then moved",
       "A closed surface from a file, in 3-D.", describe_stl, StlShape{}, true},
  };
  return kKinds;
}

bool take_points(Slot& slot, int least, const char* expected, Points2& points) {
  Points2 read;
  std::size_t count = points.size();
  slot.list(expected, least, Form::kNoEnd, count, [&](Slot& item, std::size_t k) {
    Vec3 point = item.writes() ? Vec3{points[k][0], points[k][1], 0} : Vec3{};
    item.take(point, Vector{Measure::length, 2});
    if (item.reads()) read.push_back({point[0], point[1]});
  });
  if (!slot.reads() || !slot.good()) return false;
  points = std::move(read);
  return true;
}

}  // namespace mpmfast
