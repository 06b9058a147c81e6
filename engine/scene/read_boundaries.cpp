#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/sections.hpp"
#include "engine/scene/suggest.hpp"

namespace mpmfast {

namespace {

const FaceName* face_named(const std::string& name) {
  for (const FaceName& face : kFaces) {
    if (name == face.name) return &face;
  }
  return nullptr;
}

/// The wall without friction on a face of the grid.
WallSpec wall_on(const FaceName& face, const GridSpec& grid) {
  WallSpec wall;
  const auto axis = static_cast<std::size_t>(face.axis);
  wall.axis = face.axis;
  wall.upper = face.upper;
  wall.position = grid.origin[axis] + (face.upper ? grid.size[axis] : 0);
  wall.speed = TimeTable{{0}, {0}};
  return wall;
}

/// Reads `boundaries`, one entry at a time.
class BoundaryReader {
 public:
  BoundaryReader(bool grid_known, Scene& scene) : grid_known_(grid_known), scene_(scene) {}

  void read(const std::string& name, const Value& value) {
    const FaceName* face = face_named(name);
    if (face && face->axis >= scene_.dimension()) return value.report("exists in 3-D only");
    if (face) return read_face(*face, value);
    if (!value.is(Node::Kind::map)) {
      std::vector<std::string> faces;
      for (const FaceName& known : kFaces) faces.emplace_back(known.name);
      const std::string meant = did_you_mean(name, faces);
      return value.complain(
          "not a face of the grid, and not a map {box | node, direction, speed}",
          meant.empty() ? "The faces are left, right, bottom, top, in 3-D also back and front" : meant);
    }
    if (!is_name(name)) value.report("not a name (letters, digits, '_' and '-')");
    read_box(name, value);
  }

 private:
  void add(const std::string& name, const Value& value, std::variant<WallSpec, VelocityBoxSpec> condition) {
    for (const BodySpec& body : scene_.bodies) {
      if (body.name == name && is_rigid(scene_, body)) {
        value.report(
            fmt::format("a rigid body is also called '{}': their forces would share a column", name));
      }
    }
    scene_.boundaries.push_back({name, std::move(condition)});
  }

  void read_face(const FaceName& face, const Value& value) {
    WallSpec wall = wall_on(face, scene_.grid);
    if (value.is(Node::Kind::map)) return read_wall_map(face, value, wall);
    if (!value.is(Node::Kind::scalar)) {
      return value.complain("not a wall (wall, symmetry, fixed, free, or a map {piston, direction, …})");
    }
    const auto kind = value.word(kFaceKinds);
    if (!kind || *kind == FaceKind::free) return;
    wall.held = *kind == FaceKind::fixed;
    add(face.name, value, wall);
  }

  /// {piston: speed, direction, held, position, at} or {wall: held | sliding, position, at}.
  void read_wall_map(const FaceName& face, const Value& value, WallSpec wall) {
    MapReader map(value);
    const auto piston = map.find("piston");
    const auto kind = map.find("wall");
    if (map.one_of({{"wall"}, {"piston"}}) < 0) {
      map.finish();
      return value.report("needs either piston (a speed) or wall (held or sliding)");
    }
    if (kind) {
      wall.held = kind->word(kWallKinds).value_or(false);
    } else {
      if (const auto speed = piston->table(Measure::velocity)) wall.speed = *speed;
      const When beside(value, "piston");
      const double sign = read_sense(face, map);
      for (double& speed : wall.speed.value) speed = sign * speed + 0.0;  // no −0
      map.boolean("held", wall.held);
    }
    if (const auto position = map.find("position")) {
      wall.position = position->quantity(Measure::length).value_or(wall.position);
      check_position(face, *position, wall.position);
    }
    if (const auto at = map.find("at")) wall.place = at->word(kWallPlaces).value_or(wall.place);
    if (wall.place == WallPlace::surface && !wall.held) {
      const When at_surface(value, "at=surface");
      map.quantity("friction", Measure::number, kNotNegative, wall.friction);
    }
    map.finish();
    add(face.name, value, wall);
  }

  /// +1 or −1 along the face's axis; inwards when the scene does not say.
  double read_sense(const FaceName& face, MapReader& map) const {
    const double inwards = face.upper ? -1 : 1;
    const auto value = map.find("direction");
    if (!value) return inwards;
    const auto direction = read_direction(*value, scene_.dimension(), false);
    if (!direction) return inwards;
    const double along = (*direction)[static_cast<std::size_t>(face.axis)];
    if (along == 0)
      value->complain(fmt::format("the {} face moves along {} only", face.name, "xyz"[face.axis]));
    return along == 0 ? inwards : along;
  }

  void check_position(const FaceName& face, const Value& value, double position) const {
    if (!grid_known_) return;
    const auto axis = static_cast<std::size_t>(face.axis);
    const double lower = scene_.grid.origin[axis], upper = lower + scene_.grid.size[axis];
    const double slack = 1e-6 * scene_.grid.cell;
    if (position < lower - slack || position > upper + slack) {
      value.complain(fmt::format("outside the grid (from {} m to {} m in {})", lower, upper, "xyz"[axis]));
    }
  }

  void read_box(const std::string& name, const Value& value) {
    MapReader map(value);
    VelocityBoxSpec spec;
    spec.speed = TimeTable{{0}, {0}};
    const int which = map.one_of({{"box"}, {"node"}});
    if (which < 0) value.report("needs either box (a map {from, to}) or node (a point)");
    if (which == 0) read_corners(*map.find("box"), spec);
    if (which == 1) read_node(*map.find("node"), spec);
    if (const auto direction = map.need("direction", "x, y, z, left, up, … or a vector")) {
      spec.direction = read_direction(*direction, scene_.dimension(), true).value_or(Vec3{});
    }
    if (const auto speed = map.need("speed", "a velocity: m/s, mm/s, km/s; or a table")) {
      if (const auto table = speed->table(Measure::velocity)) spec.speed = *table;
    }
    map.finish();
    add(name, value, spec);
  }

  /// The node nearest to a point, as a box without extent.
  void read_node(const Value& node, VelocityBoxSpec& spec) const {
    const auto point = node.vector(Measure::length, scene_.dimension());
    if (!point || !grid_known_) return;
    const auto& grid = scene_.grid;
    for (std::size_t k = 0; k < static_cast<std::size_t>(scene_.dimension()); ++k) {
      const double at = std::round(((*point)[k] - grid.origin[k]) / grid.cell);
      if (at < 0 || at > std::round(grid.size[k] / grid.cell))
        node.report(fmt::format("no node of the grid lies there in {}", "xyz"[k]));
      spec.lower[k] = spec.upper[k] = grid.origin[k] + at * grid.cell;
    }
  }

  void read_corners(const Value& box, VelocityBoxSpec& spec) const {
    const int dimension = scene_.dimension();
    MapReader map(box, "a map {from, to}");
    const auto from = map.need("from", "a corner"), to = map.need("to", "a corner");
    if (from) spec.lower = from->vector(Measure::length, dimension).value_or(Vec3{});
    if (to) spec.upper = to->vector(Measure::length, dimension).value_or(spec.lower);
    map.finish();
    for (std::size_t k = 0; k < 3; ++k) {
      if (spec.lower[k] > spec.upper[k]) {  // equal is a row of nodes
        box.report(fmt::format("'to' lies below 'from' in {}", "xyz"[k]));
      }
    }
  }

  bool grid_known_;
  Scene& scene_;
};

}  // namespace

void close_faces(MapReader& top, Scene& scene) {
  const auto section = top.find("boundaries");
  for (const FaceName& face : kFaces) {
    if (face.axis >= scene.dimension()) continue;
    const auto has_its_name = [&](const auto& named) { return named.name == face.name; };
    const bool stated = section && std::any_of(section->node().keys.begin(), section->node().keys.end(),
                                               [&](const Key& key) { return key.text == face.name; });
    if (stated || std::any_of(scene.boundaries.begin(), scene.boundaries.end(), has_its_name)) continue;
    const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(), has_its_name);
    if (body != scene.bodies.end() && is_rigid(scene, *body))
      MapReader(*top.find("grid"))
          .find("leaving")
          ->report(fmt::format(
              "a rigid body is called '{}' as a wall here: their forces would share a column", face.name));
    scene.boundaries.push_back({face.name, wall_on(face, scene.grid)});
  }
}

void read_boundaries(MapReader& top, bool grid_known, Scene& scene) {
  const auto section = top.find("boundaries");
  if (!section) return;
  MapReader map(*section, "a map {left: wall, …}");
  if (!map.valid()) return;
  BoundaryReader reader(grid_known, scene);
  for (std::size_t k = 0; k < section->size(); ++k) {
    const std::string& name = section->node().keys[k].text;
    reader.read(name, section->entry(k, face_named(name) ? "FACE" : "NAME"));
  }
  if (grid_known && section->problems().empty()) check_walls(map, scene);
}

}  // namespace mpmfast
