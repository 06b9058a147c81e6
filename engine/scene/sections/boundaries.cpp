#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/sections/describe.hpp"
#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

/// One entry of `boundaries`: a face of the grid, free where it has no condition, or nodes by name.
struct BoundaryEntry {
  std::string name;
  std::optional<std::variant<WallSpec, VelocityBoxSpec>> condition;

  /// The condition, where it is of this kind.
  template <class Spec>
  const Spec* known() const {
    return condition ? std::get_if<Spec>(&*condition) : nullptr;
  }
};

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

bool is_still(const WallSpec& wall) {
  return wall.speed.time.size() == 1 && wall.speed.time[0] == 0 && wall.speed.value[0] == 0;
}

class Boundaries {
 public:
  Boundaries(bool grid_known, const Scene& scene) : grid_known_(grid_known), scene_(scene) {}

  void describe(Slot& slot, BoundaryEntry& entry) const {
    if (const FaceName* face = face_named(entry.name))
      describe_face(slot, *face, entry);
    else
      describe_nodes(slot, entry);
    if (!slot.reads() || !entry.condition) return;
    for (const BodySpec& body : scene_.bodies)
      if (body.name == entry.name && is_rigid(scene_, body))
        slot.report(
            fmt::format("a rigid body is also called '{}': their forces would share a column", entry.name));
  }

 private:
  void describe_face(Slot& slot, const FaceName& face, BoundaryEntry& entry) const {
    if (slot.reads() && face.axis >= scene_.dimension()) return slot.report("exists in 3-D only");
    const auto* known = entry.known<WallSpec>();
    WallSpec wall = known ? *known : wall_on(face, scene_.grid);
    FaceKind kind = FaceKind::wall;
    const bool map = slot.is_map(
        known, [&](Keys& keys) { kind = describe_wall(keys, face, wall) ? kind : FaceKind::free; });
    if (!map && slot.reads() && !slot.value()->is(Node::Kind::scalar))
      return slot.complain("not a wall (wall, symmetry, fixed, free, or a map {piston, direction, …})");
    if (!map) {
      kind = FaceKind::free;
      slot.take(kind, kFaceKinds);
      wall.fixed = kind == FaceKind::fixed;
    }
    if (slot.reads() && kind != FaceKind::free) entry.condition = wall;
  }

  /// {piston: speed, direction, held, position, at} or {wall: held | sliding, position, at}.
  /// @return whether it is one of them
  bool describe_wall(Keys& map, const FaceName& face, WallSpec& wall) const {
    const auto choice = map.one_of({{"wall"}, {"piston"}}, is_still(wall) ? 0 : 1);
    if (choice.none()) map.report("needs either piston (a speed) or wall (held or sliding)");
    if (choice.none()) return false;
    if (choice.takes(0))
      map.need("wall", "A wall, at another place than the face of the grid.", wall.fixed, kWallKinds);
    if (choice.takes(1))
      map.need("piston", "A wall that moves, and its speed.", wall.speed, Table{Measure::velocity});
    map.under("piston", choice.takes(1), [&] {
      describe_sense(map, face, wall);
      map.key("held", "The piston also holds sideways.", wall.fixed);
    });
    map.derived_at("position", "Where the wall is at time 0; the face of the grid if not given.",
                   [&](Slot& slot) {
                     if (slot.take(wall.position, Number{Measure::length}) && slot.reads())
                       check_position(slot, face, wall.position);
                   });
    map.key("at",
            "Where the wall acts: on the nodes at and beyond its plane, on its plane, which is exact for a "
            "body that stands against it, or on the surface of what reaches it.",
            wall.enforcement, kWallEnforcements);
    describe_friction(map, wall);
    return true;
  }

  /// On the surface alone; anywhere else it is answered with that.
  void describe_friction(Keys& map, WallSpec& wall) const {
    const bool there = wall.enforcement == WallEnforcement::surface;
    if (there && wall.fixed)
      map.check("friction", [](Slot& slot) {
        slot.report("a wall that is held lets nothing slide", "Friction is for wall: sliding");
      });
    if (map.reads() && !there) map.reader().begin_lacking("at: surface");
    map.under("at=surface", map.reads() || (there && !wall.fixed), [&] {
      map.key("friction", "Coulomb's coefficient of the wall on what touches it.", wall.friction,
              Number{Measure::number, kNotNegative});
    });
    if (map.reads()) map.reader().end_lacking();
  }

  /// Where the piston moves along the face's axis: inwards when the scene does not say. Written: upwards.
  void describe_sense(Keys& map, const FaceName& face, WallSpec& wall) const {
    const auto axis = static_cast<std::size_t>(face.axis);
    double sign = face.upper ? -1 : 1;
    map.derived_at("direction", "Where the piston moves, along its axis; inwards if not given.",
                   [&](Slot& slot) {
                     Vec3 direction{};
                     direction[axis] = 1;
                     describe_direction(slot, scene_.dimension(), false, direction);
                     if (!slot.reads() || !slot.good()) return;
                     if (direction[axis] == 0)
                       slot.complain(fmt::format("the {} face moves along {} only", face.name, "xyz"[axis]));
                     else
                       sign = direction[axis];
                   });
    if (!map.reads()) return;
    for (double& speed : wall.speed.value) speed = sign * speed + 0.0;  // no −0
  }

  void check_position(Slot& slot, const FaceName& face, double position) const {
    if (!grid_known_) return;
    const auto axis = static_cast<std::size_t>(face.axis);
    const double lower = scene_.grid.origin[axis], upper = lower + scene_.grid.size[axis];
    const double slack = 1e-6 * scene_.grid.cell;
    if (position < lower - slack || position > upper + slack)
      slot.complain(fmt::format("outside the grid (from {} m to {} m in {})", lower, upper, "xyz"[axis]));
  }

  void describe_nodes(Slot& slot, BoundaryEntry& entry) const {
    if (slot.reads() && !slot.value()->is(Node::Kind::map)) {
      const std::string meant = did_you_mean(entry.name, names_of(kFaces));
      return slot.complain(
          "not a face of the grid, and not a map {box | node, direction, speed}",
          meant.empty() ? "The faces are left, right, bottom, top, in 3-D also back and front" : meant);
    }
    if (slot.reads() && !is_name(entry.name)) slot.report("not a name (letters, digits, '_' and '-')");
    const auto* known = entry.known<VelocityBoxSpec>();
    VelocityBoxSpec spec = known ? *known : VelocityBoxSpec{{}, {}, {}, TimeTable{{0}, {0}}};
    slot.map("a map {box | node, direction, speed}", [&](Keys& map) {
      const auto choice = map.one_of({{"box"}, {"node"}});
      if (choice.none()) map.report("needs either box (a map {from, to}) or node (a point)");
      if (choice.takes(0))
        map.need_at("box", "All nodes in this box.", "", [&](Slot& box) { describe_nodes_in(box, spec); });
      if (choice.takes(1) && !map.writes())
        map.need_at("node", "The node nearest to this point.", "",
                    [&](Slot& node) { describe_node(node, spec); });
      map.need_at("direction", "The direction in which the velocity is given; the others are free.",
                  "x, y, z, left, up, … or a vector",
                  [&](Slot& to) { describe_direction(to, scene_.dimension(), true, spec.direction); });
      map.need("speed", "The velocity along it.", spec.speed, Table{Measure::velocity});
    });
    entry.condition = spec;
  }

  /// The node nearest to a point, as a box without extent.
  void describe_node(Slot& slot, VelocityBoxSpec& spec) const {
    Vec3 point{};
    if (!slot.take(point, Vector{Measure::length, scene_.dimension()}) || !slot.reads() || !grid_known_)
      return;
    const auto& grid = scene_.grid;
    for (std::size_t k = 0; k < static_cast<std::size_t>(scene_.dimension()); ++k) {
      const double at = std::round((point[k] - grid.origin[k]) / grid.cell);
      if (at < 0 || at > std::round(grid.size[k] / grid.cell))
        slot.report(fmt::format("no node of the grid lies there in {}", "xyz"[k]));
      spec.lower[k] = spec.upper[k] = grid.origin[k] + at * grid.cell;
    }
  }

  void describe_nodes_in(Slot& slot, VelocityBoxSpec& spec) const {
    describe_region(slot, scene_.dimension(), spec.lower, spec.upper);
  }

  bool grid_known_;
  const Scene& scene_;
};

/// What is read: names, whose conditions follow.
std::vector<BoundaryEntry> read_entries(const Node& section) {
  std::vector<BoundaryEntry> out;
  for (const Key& key : section.keys) out.push_back({key.text, {}});
  return out;
}

/// What is written: the conditions, and then the faces that have none.
std::vector<BoundaryEntry> written_entries(const Scene& scene) {
  std::vector<BoundaryEntry> out;
  for (const BoundarySpec& boundary : scene.boundaries) out.push_back({boundary.name, boundary.condition});
  for (const FaceName& face : kFaces) {
    const bool given = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                                   [&](const BoundarySpec& boundary) { return boundary.name == face.name; });
    if (!given && face.axis < scene.dimension()) out.push_back({face.name, {}});
  }
  return out;
}

/// The entries that are listed: a face, with a wall that stands still or moves, and nodes.
std::vector<BoundaryEntry> described_entries(const Scene& scene) {
  return {{kFaces[0].name, wall_on(kFaces[0], scene.grid)}, {"", {}}};
}

void describe_entry(Keys& map, std::size_t k, const Boundaries& boundaries, BoundaryEntry& entry) {
  const bool face = face_named(entry.name);
  map.entry(k, face ? "FACE" : "NAME",
            face ? "A face of the grid: a word, or a map for a wall elsewhere or one that moves."
                 : "A velocity given at some nodes, along one direction; the name heads its columns.",
            entry.name, [&](Slot& slot) { boundaries.describe(slot, entry); });
}

}  // namespace

void close_faces(const Value& top, Scene& scene) {
  const auto section = top.find("boundaries");
  for (const FaceName& face : kFaces) {
    if (face.axis >= scene.dimension()) continue;
    const auto has_its_name = [&](const auto& named) { return named.name == face.name; };
    const bool stated = section && section->find(face.name);
    if (stated || std::any_of(scene.boundaries.begin(), scene.boundaries.end(), has_its_name)) continue;
    const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(), has_its_name);
    if (body != scene.bodies.end() && is_rigid(scene, *body))
      top.find("grid")->find("leaving")->report(fmt::format(
          "a rigid body is called '{}' as a wall here: their forces would share a column", face.name));
    scene.boundaries.push_back({face.name, wall_on(face, scene.grid)});
  }
}

void describe_boundaries(Keys& top, bool grid_known, Scene& scene) {
  const Boundaries boundaries(grid_known, scene);
  top.section("boundaries", "Walls on the faces of the grid, and nodes whose velocity is given.",
              "a map {left: wall, …}", [&](Keys& map) {
                map.allow_other_keys();
                auto entries = map.reads()    ? read_entries(map.reader().value().node())
                               : map.writes() ? written_entries(scene)
                                              : described_entries(scene);
                for (std::size_t k = 0; k < entries.size(); ++k) {
                  describe_entry(map, k, boundaries, entries[k]);
                  if (map.reads() && entries[k].condition)
                    scene.boundaries.push_back({entries[k].name, *entries[k].condition});
                }
              });
}

}  // namespace mpmfast
