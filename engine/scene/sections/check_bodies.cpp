#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/geometry/shapes.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// Particles may only lie in the grid.
void check_inside(const Scene& scene, const BodySpec& body, const BodyLocation& location) {
  const Bounds box = bounds(body.shape);
  const double slack = 1e-6 * scene.grid.cell;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.dimension()); ++k) {
    const double below = k == 0 && is_halved(scene, body) ? 0 : scene.grid.origin[k] - box.lower[k];
    const double above = box.upper[k] - (scene.grid.origin[k] + scene.grid.size[k]);
    const auto report = [&](double by, const char* where) {
      const double size = scene.grid.size[k];
      location.entry.report(
          fmt::format("body '{}' lies {:.6g} m outside the grid, {} in {} (the body is at {:.6g} to "
                      "{:.6g} m, the grid at {:.6g} to {:.6g} m)",
                      body.name, by, where, "xyz"[k], box.lower[k], box.upper[k], scene.grid.origin[k],
                      scene.grid.origin[k] + size),
          by > 10 * size ? "A bare number is in metres" : "");
    };
    if (below > slack) report(below, "below");
    if (above > slack) report(above, "above");
  }
}

/// A round shape in the plane: a disk, or a ring.
bool is_round(const Scene& scene, const Shape& shape) {
  if (scene.dimension() != 2) return false;
  const auto* ellipse = std::get_if<EllipsoidShape>(&shape);
  return std::holds_alternative<RingShape>(shape) || (ellipse && ellipse->radii[0] == ellipse->radii[1]);
}

/// Why particles cannot lie as a seeding says; nothing where they can.
const char* obstacle(const Scene& scene, const BodySpec& body, const Seeding& seeding) {
  if (!seeding.turned()) return nullptr;
  const bool own_lattice = std::holds_alternative<BoxShape>(body.shape) && scene.dimension() == 2;
  if (own_lattice && seeding.kind == SeedingKind::conforming) return nullptr;
  const auto& model = scene.materials[static_cast<std::size_t>(body.material)].model;
  if (std::holds_alternative<LinearElastic>(model))
    return "linear_elastic takes turned particles for strained ones (neo_hookean does not)";
  if (std::holds_alternative<BitmapShape>(body.shape))
    return "the levels of a bitmap share the grid's lattice";
  if (scene.space == Space::axisymmetric)
    return "the particles of an axisymmetric scene lie along the radius";
  if (scene.dimension() == 3 && seeding.kind == SeedingKind::conforming)
    return "conforming particles are for shapes in the plane";
  if (seeding.kind == SeedingKind::rings && !is_round(scene, body.shape))
    return "rings are for disks and rings in the plane";
  return nullptr;
}

/// Particles have indices of 32 bits, and nobody means a billion of them.
void check_count(const Scene& scene, const BodySpec& body, const BodyLocation& location) {
  constexpr double kMost = 1e9;
  const Bounds box = bounds(body.shape);
  double count = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.dimension()); ++k) {
    count *= (box.upper[k] - box.lower[k]) / scene.grid.cell * body.particles_per_cell[k];
  }
  if (count > kMost)
    location.entry.report(fmt::format("body '{}' would have about {:.2g} particles", body.name, count));
}

/// A rigid body's velocity is given, so nothing may move in one velocity field with it.
void check_rigid(const Scene& scene, const std::vector<BodyLocation>& locations) {
  std::map<std::string, int> sharers;
  for (const BodySpec& body : scene.bodies) ++sharers[body.field];
  std::size_t rigid = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (!is_rigid(scene, body)) continue;
    ++rigid;
    const bool shared = scene.contact.active ? sharers[body.field] > 1 : scene.bodies.size() > 1;
    if (!shared) continue;
    locations[b].entry.report(fmt::format("the rigid body '{}' shares a velocity field with another body{}",
                                          body.name,
                                          scene.contact.active ? "" : ", because of contact: none"));
  }
  const bool all_read = !locations.empty() && locations[0].entry.problems().empty();
  if (all_read && rigid == scene.bodies.size())
    locations[0].entry.report("every body is rigid: there is nothing to compute");
}

/// One velocity field has one acceleration.
void check_accelerations(const Scene& scene, const std::vector<BodyLocation>& locations) {
  std::map<std::string, Vec3> known;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (is_rigid(scene, body) && body.acceleration != Vec3{})
      locations[b].entry.find("acceleration")->report("a rigid body moves as it is told");
    if (is_rigid(scene, body)) continue;
    const auto one = known.emplace(scene.contact.active ? body.field : "", body.acceleration).first;
    if (one->second != body.acceleration)
      locations[b].entry.report(
          fmt::format("'{}' shares a velocity field with a body of another acceleration", body.name));
  }
}

}  // namespace

void check_bodies(const Scene& scene, const std::vector<BodyLocation>& locations, bool grid_known) {
  std::set<std::string> names, fields;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (!names.insert(body.name).second)
      locations[b].name.report(fmt::format("another body is called '{}'", body.name));
    if (body.name == "all")
      locations[b].name.report("history.csv calls the means over all bodies 'all': they would share columns",
                               "Give the body another name");
    fields.insert(body.field);
    const char* why = obstacle(scene, body, body.seeding);
    if (const auto seeding = locations[b].entry.find("seeding"); seeding && why) seeding->complain(why);
    if (!grid_known) continue;
    check_inside(scene, body, locations[b]);
    check_count(scene, body, locations[b]);
  }
  if (names.size() == scene.bodies.size())
    check_rigid(scene, locations);  // two of one name share a field too
  check_accelerations(scene, locations);
  constexpr std::size_t kMostBodies = 65535;  // particles carry their body in 16 bits
  if (scene.bodies.size() > kMostBodies) {
    locations[0].entry.report(fmt::format("{} bodies (at most {})", scene.bodies.size(), kMostBodies));
  }
}

SeedingKind usual_seeding(const Scene& scene, const BodySpec& body) {
  const bool box = std::holds_alternative<BoxShape>(body.shape);
  const bool alike = body.particles_per_cell[0] == body.particles_per_cell[1];
  return !box && alike && !obstacle(scene, body, {SeedingKind::conforming}) ? SeedingKind::conforming
                                                                            : SeedingKind::lattice;
}

void check_tables(const Value& entry, const Scene& scene, const BodySpec& body) {
  if (is_rigid(scene, body)) return;
  const auto refuse = [&](const char* key, const char* what) {
    entry.find(key)->report(fmt::format("{} is for rigid bodies only", what));
  };
  const auto& tables = body.rigid_velocity;
  if (std::any_of(tables.begin(), tables.end(), [](const auto& table) { return table.has_value(); }))
    refuse("velocity", "a table of velocities");
  if (body.rotation && body.rotation->speed.time.size() > 1) refuse("rotation", "a table of rotations");
}

}  // namespace mpmfast
