#include <fmt/format.h>

#include <algorithm>

#include "engine/scene/polygon.hpp"
#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

std::optional<Vec3> need_vector(MapReader& map, const char* key, int dimension, const Limit& limit = kAny) {
  const auto value = map.need(key, fmt::format("a list of {} lengths", dimension));
  map.expects(key, {Form::Kind::vector, Measure::length, limit, dimension, dimension});
  return value ? value->vector(Measure::length, dimension, limit) : std::nullopt;
}

std::optional<Shape> read_box(const Value& value, const Scene& scene) {
  const int dimension = scene.dimension();
  MapReader map(value, "a map {from, to}");
  const auto from = need_vector(map, "from", dimension);
  const auto to = need_vector(map, "to", dimension);
  map.finish();
  if (!from || !to) return std::nullopt;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    if ((*from)[k] < (*to)[k]) continue;
    value.report(fmt::format("'to' must lie above 'from' in {}, but {} m is not above {} m", "xyz"[k],
                             (*to)[k], (*from)[k]));
    return std::nullopt;
  }
  return BoxShape{*from, *to};
}

std::optional<Shape> read_round(const Value& value, const Scene& scene) {
  const int dimension = scene.dimension();
  MapReader map(value, "a map {centre, radius}");
  const auto centre = need_vector(map, "centre", dimension);
  double radius = 0;
  map.need_quantity("radius", Measure::length, kPositive, radius);
  map.finish();
  if (!centre || radius <= 0) return std::nullopt;
  return EllipsoidShape{*centre, {radius, radius, dimension == 3 ? radius : 0.0}, 0};
}

std::optional<Shape> read_ellipsoid(const Value& value, const Scene& scene) {
  const int dimension = scene.dimension();
  MapReader map(value, "a map {centre, radii, angle}");
  const auto centre = need_vector(map, "centre", dimension);
  const auto radii = need_vector(map, "radii", dimension, kPositive);
  double angle = 0;
  map.quantity("angle", Measure::angle, kAny, angle);
  map.finish();
  if (!centre || !radii) return std::nullopt;
  return EllipsoidShape{*centre, *radii, angle};
}

std::optional<Shape> read_ring(const Value& value, const Scene& scene) {
  const int dimension = scene.dimension();
  MapReader map(value,
                dimension == 3 ? "a map {centre, inner, outer, length}" : "a map {centre, inner, outer}");
  const auto centre = need_vector(map, "centre", dimension);
  double inner = -1, outer = -1, length = dimension == 3 ? -1 : 0;
  map.need_quantity("inner", Measure::length, kNotNegative, inner);
  map.need_quantity("outer", Measure::length, kPositive, outer);
  if (dimension == 3) map.need_quantity("length", Measure::length, kPositive, length);
  map.finish();
  if (!centre || inner < 0 || outer < 0 || length < 0) return std::nullopt;
  if (inner >= outer) {
    value.report(fmt::format("the inner radius must be smaller than the outer, but {} m is not below {} m",
                             inner, outer));
    return std::nullopt;
  }
  return RingShape{*centre, inner, outer, length / 2};
}

std::optional<std::vector<std::array<double, 2>>> read_points(const Value& list) {
  if (!list.is_list(3)) {
    list.complain("not a list of three or more points [x, y]");
    return std::nullopt;
  }
  std::vector<std::array<double, 2>> points;
  bool good = true;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const auto point = list.item(k).vector(Measure::length, 2);
    good = good && point;
    if (point) points.push_back({(*point)[0], (*point)[1]});
  }
  if (!good) return std::nullopt;
  if (const std::string fault = polygon_fault(points); !fault.empty()) {
    list.report(fault);
    return std::nullopt;
  }
  return points;
}

std::optional<Shape> read_polygon(const Value& value, const Scene& scene) {
  const int dimension = scene.dimension();
  PolygonShape shape;
  if (dimension == 2 && value.is(Node::Kind::list)) {
    const auto points = read_points(value);
    if (!points) return std::nullopt;
    shape.points = *points;
    return shape;
  }
  MapReader map(value,
                dimension == 3 ? "a map {points, z: [lower, upper]}" : "a list of points or a map {points}");
  const auto list = map.need("points", "a list of points [x, y]");
  const auto points = list ? read_points(*list) : std::nullopt;
  bool good = points.has_value();
  if (dimension == 3) {
    const When solid(value, "3d");
    const auto range = map.need("z", "a list [lower, upper]");
    const auto ends = range ? range->vector(Measure::length, 2) : std::nullopt;
    if (ends && (*ends)[0] >= (*ends)[1]) range->report("the upper end must lie above the lower");
    good = good && ends && (*ends)[0] < (*ends)[1];
    if (ends) {
      shape.z_lower = (*ends)[0];
      shape.z_upper = (*ends)[1];
    }
  }
  map.finish();
  if (!good) return std::nullopt;
  shape.points = *points;
  return shape;
}

}  // namespace

const std::vector<ShapeKind>& shape_kinds() {
  static const std::vector<ShapeKind> kKinds{
      {"box", 0, "edges along the axes; its volume is exact", read_box},
      {"disk", 2, "2-D", read_round},
      {"sphere", 3, "3-D", read_round},
      {"ellipse", 2, "2-D, turned by angle", read_ellipsoid},
      {"ellipsoid", 3, "3-D, turned by angle about z", read_ellipsoid},
      {"ring", 2, "2-D", read_ring},
      {"tube", 3, "3-D, along z; a cylinder when inner is 0", read_ring},
      {"polygon", 0, "simple, closed by itself; in 3-D extruded along z", read_polygon},
      {"bitmap", 2,
       "2-D, an 8-bit grey PNG (beside it extent, origin, skip, materials): each grey level is a body "
       "NAME_LEVEL",
       nullptr},
      {"stl", 3,
       "3-D, a closed surface: scale is the length of the file's unit; turned about its origin, then moved",
       read_stl},
  };
  return kKinds;
}

}  // namespace mpmfast
