#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "engine/geometry/shapes.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

std::string_view article_of(std::string_view shape) { return shape[0] == 'e' || shape == "stl" ? "an" : "a"; }

/// A body has one of them.
KeyGroups shape_keys() {
  KeyGroups groups;
  for (const ShapeKind& kind : shape_kinds()) groups.push_back({kind.name});
  return groups;
}

/// "Did you mean 'sphere'?" for a disk: the same in the other dimension.
std::string counterpart(const ShapeKind& kind) {
  for (const ShapeKind& other : shape_kinds())
    if (other.describe == kind.describe && other.dimension != kind.dimension)
      return fmt::format("Did you mean '{}'?", other.name);
  return "";
}

bool fits(const ShapeKind& kind, int dimension) { return kind.dimension == 0 || kind.dimension == dimension; }

/// The kind that a shape is written as.
int written_kind(const Shape& shape, int dimension) {
  const auto& kinds = shape_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const ShapeKind& kind) {
    return kind.written && fits(kind, dimension) && kind.standard.index() == shape.index();
  });
  return static_cast<int>(found - kinds.begin());
}

/// A body with no shape, or with several.
void report_shapes(Keys& map) {
  std::vector<std::string> chosen;
  for (const ShapeKind& kind : shape_kinds())
    if (map.stated(kind.name)) chosen.emplace_back(kind.name);
  if (chosen.empty())
    map.report(fmt::format("a body needs a shape (one of {})", fmt::join(names_of(shape_kinds()), ", ")));
  else
    map.check(chosen[1], [&](Slot& slot) {
      slot.report(
          fmt::format("a body has one shape, and it is already {} {}", article_of(chosen[0]), chosen[0]));
    });
}

void describe_shape(Slot& slot, const ShapeKind& kind, const Scene& scene, BodyEntry& entry) {
  if (slot.reads() && !fits(kind, scene.dimension())) {
    slot.report(fmt::format("{} {} exists in {}-D only", article_of(kind.name), kind.name, kind.dimension),
                counterpart(kind));
    return;
  }
  if (!kind.describe)
    describe_bitmap(slot, scene, entry.bitmap);
  else
    kind.describe(slot, entry.body.shape, scene);
  entry.shaped = slot.good();
}

/// How many particles lie along a cell's side: alike in all directions, or for each.
void describe_counts(Slot& slot, int dimension, std::array<int, 3>& counts) {
  constexpr Whole kCount{1, 8};
  const auto last = counts.begin() + dimension;
  const bool alike = std::all_of(counts.begin(), last, [&](int count) { return count == counts[0]; });
  std::size_t size = static_cast<std::size_t>(dimension);
  const std::string expected =
      fmt::format("a whole number or a list of {} (particles along a cell's side)", dimension);
  if (slot.is_list(!alike, expected, dimension, dimension, size,
                   [&](Slot& item, std::size_t k) { item.take(counts[k], kCount); }))
    return;
  if (slot.take(counts[0], kCount)) std::fill(counts.begin(), last, counts[0]);
}

void describe_seeding(Slot& slot, Seeding& seeding) {
  for (const auto& choice : kSeedings) {
    const bool chosen = seeding.kind == choice.value && seeding.angle == 0;
    if (!slot.is_keyword(choice.name, chosen, choice.description)) continue;
    seeding.kind = choice.value;
    return;
  }
  const bool map = slot.is_map(true, [&](Keys& keys) {
    keys.need("angle", "Of the lattice, about z: along the edges of a body that lies across the grid.",
              seeding.angle, Number{Measure::angle});
  });
  if (!map) slot.complain("not lattice, rings, conforming or {angle: …}");
}

void describe_velocity(Slot& slot, int dimension, BodySpec& body) {
  const std::string expected = fmt::format("a list of {} (velocities: m/s, mm/s, km/s)", dimension);
  if (slot.reads() && !slot.value()->is_list(dimension, dimension))
    return slot.complain("not " + expected, slot.value()->vector_hint(Measure::velocity, dimension));
  std::size_t size = static_cast<std::size_t>(dimension);
  slot.list(expected, dimension, dimension, size, [&](Slot& item, std::size_t k) {
    TimeTable table = body.rigid_velocity[k].value_or(TimeTable{{0}, {body.velocity[k]}});
    if (!item.take(table, Table{Measure::velocity}) || !item.reads()) return;
    body.velocity[k] = table.value.front();
    if (table.time.size() > 1) body.rigid_velocity[k] = table;  // one point is a constant
  });
}

void describe_rotation(Slot& slot, int dimension, BodySpec& body) {
  if (slot.writes() && !body.rotation) return;
  RotationSpec rotation = body.rotation.value_or(RotationSpec{{}, {0, 0, 1}, {{0}, {0}}});
  slot.map(dimension == 2 ? "a map {about, speed}" : "a map {about, axis, speed}", [&](Keys& map) {
    map.need_at("about", "A point of the axis at time 0; it moves with the body's velocity.", "a point",
                [&](Slot& about) {
                  about.take(rotation.about, Vector{Measure::length, dimension});
                });
    map.under("3d", dimension == 3, [&] {
      map.need_at("axis", "Direction of the axis; in the plane it is z.", "x, y, z or a vector",
                  [&](Slot& axis) { describe_direction(axis, 3, true, rotation.axis); });
    });
    map.key("speed", "Right-handed about the axis.", rotation.speed, Table{Measure::angular_velocity});
  });
  if (slot.reads() && slot.value()->is(Node::Kind::map)) body.rotation = rotation;
}

/// The shape and the material, with what a bitmap has beside it.
void describe_substance(Keys& map, const Scene& scene, const std::vector<std::string>& materials,
                        BodyEntry& entry) {
  constexpr const char* kMaterial =
      "One of `materials`; of a bitmap, of every level that its `materials` leave out.";
  const auto& kinds = shape_kinds();
  const int written = written_kind(entry.body.shape, scene.dimension());
  const auto choice = map.one_of(shape_keys(), written);
  if (choice.none()) report_shapes(map);
  bool bitmap = false;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (!choice.takes(static_cast<int>(k)) || (map.describes() && !fits(kinds[k], scene.dimension())))
      continue;
    map.need_at(kinds[k].name, kinds[k].note, "",
                [&](Slot& slot) { describe_shape(slot, kinds[k], scene, entry); });
    bitmap = !kinds[k].describe && fits(kinds[k], scene.dimension());
  }
  const auto material = [&](Slot& slot) { entry.made = slot.reference(entry.body.material, materials); };
  map.under("bitmap", bitmap, [&] {
    describe_bitmap_keys(map, scene, materials, entry.bitmap);
    map.at("material", kMaterial, [&](Slot& slot) {
      if (!slot.writes()) material(slot);
    });
  });
  map.under("!bitmap", !bitmap,
            [&] { map.need_at("material", kMaterial, "the name of a material", material); });
  if (map.reads() && !bitmap && map.stated("bitmap"))  // these keys are known, whatever else is wrong
    for (const char* key : {"extent", "origin", "skip", "materials"}) map.stated(key);
}

void describe_body(Slot& slot, const Scene& scene, const std::vector<std::string>& materials,
                   BodyEntry& entry) {
  BodySpec& body = entry.body;
  const int dimension = scene.dimension();
  slot.map("a map {box | disk | …, material, …}", [&](Keys& map) {
    map.derived("name", "Heads its columns in history.csv; body1, body2, … if not given.", body.name, Name{});
    describe_substance(map, scene, materials, entry);
    map.derived("field", "Bodies that name one velocity field share it: they move as one and do not touch.",
                body.field, Name{});
    map.at("particles_per_cell", "Particles along the side of a cell, for all directions or for each.",
           [&](Slot& counts) { describe_counts(counts, dimension, body.particles_per_cell); });
    map.derived_at(
        "seeding",
        "How the particles lie; a map turns their lattice. If not given, in the plane: conforming for "
        "whatever is no box, with as many particles along both sides of a cell; else: lattice.",
        [&](Slot& seeding) { describe_seeding(seeding, body.seeding); });
    map.at("velocity", "At the start; of a rigid body always, and each component may be a table in time.",
           [&](Slot& velocity) { describe_velocity(velocity, dimension, body); });
    map.at("acceleration", "A body force over mass of its own, beside gravity and with its ramp.",
           [&](Slot& acceleration) {
             if (acceleration.writes() && body.acceleration == Vec3{}) return;
             acceleration.take(body.acceleration, Vector{Measure::acceleration, dimension});
           });
    map.at("temperature",
           "At the start, in scenes with `heat`; that of `heat` or of its material if not given.",
           [&](Slot& temperature) {
             if (temperature.writes() && !body.temperature) return;
             double value = body.temperature.value_or(scene.heat.temperature);
             if (temperature.take(value, kTemperature) && temperature.reads()) body.temperature = value;
           });
    map.at("rotation", "Turns a rigid body; of one that deforms, its spin at the start.",
           [&](Slot& rotation) { describe_rotation(rotation, dimension, body); });
  });
}

void add(BodySpec body, const BodyLocation& location, Scene& scene, std::vector<BodyLocation>& locations) {
  if (body.field.empty()) body.field = body.name;
  if (!location.entry.find("seeding")) body.seeding.kind = usual_seeding(scene, body);
  check_tables(location.entry, scene, body);
  scene.bodies.push_back(std::move(body));
  locations.push_back(location);
}

/// The bodies of a bitmap.
void add_levels(const BodyEntry& entry, const BodyLocation& location, Scene& scene,
                std::vector<BodyLocation>& locations) {
  const BitmapEntry& bitmap = entry.bitmap;
  if (bitmap.levels.empty() && bitmap.shape.image)
    location.entry.find("bitmap")->report("every grey level of the image is skipped");
  if (!bitmap.shape.image || bitmap.extent == Vec3{}) return;
  for (const int level : bitmap.levels) {
    BodySpec body = entry.body;
    BitmapShape shape = bitmap.shape;
    shape.lower[2] = 0;
    shape.upper = {shape.lower[0] + bitmap.extent[0], shape.lower[1] + bitmap.extent[1], 0};
    shape.grey = level;
    body.shape = shape;
    body.name = fmt::format("{}_{}", entry.body.name, level);
    const auto own = std::find_if(bitmap.materials.begin(), bitmap.materials.end(),
                                  [&](const auto& one) { return one.first == std::to_string(level); });
    const bool has_own = own != bitmap.materials.end();
    if (!has_own && !location.entry.find("material")) {
      location.entry.report(fmt::format(
          "no material for the grey level {} (material: NAME, or materials: {{GREY: NAME}})", level));
      continue;
    }
    if (has_own) body.material = own->second;
    if (has_own ? own->second >= 0 : entry.made) add(body, location, scene, locations);
  }
}

/// For those who name the bodies by keys, or forgot the dashes.
std::string list_hint(const Node& bodies) {
  if (bodies.kind != Node::Kind::map || bodies.keys.empty()) return "";
  const bool names = find_value(bodies.items[0], "material");
  return names ? fmt::format("A body begins with '- name: {}'", bodies.keys[0].text)
               : fmt::format("A body begins with a dash, '- {}: …'", bodies.keys[0].text);
}

void describe_list(Slot& slot, Scene& scene, std::vector<BodyLocation>& locations) {
  constexpr const char* kExpected = "a list of maps {box | disk | …, material, …}";
  if (slot.reads() && !slot.value()->is(Node::Kind::list))
    return slot.complain(std::string("not ") + kExpected, list_hint(slot.value()->node()));
  if (slot.reads() && slot.value()->size() == 0) return slot.report("no bodies");
  const std::vector<std::string> materials = names_of(scene.materials);
  const std::vector<BodyEntry> entries = entries_of(scene);  // none when it is read
  std::size_t count = entries.size();
  slot.list(kExpected, 1, Form::kNoEnd, count, [&](Slot& item, std::size_t k) {
    BodyEntry entry = item.writes() ? entries[k] : BodyEntry{};
    if (item.reads()) entry.body.name = fmt::format("body{}", k + 1);
    if (scene.dimension() == 2) entry.body.particles_per_cell[2] = 1;
    describe_body(item, scene, materials, entry);
    if (!item.reads() || !entry.shaped) return;
    const Value& value = *item.value();
    const BodyLocation location{value, value.find("name").value_or(value)};
    if (entry.bitmap.shape.image)
      add_levels(entry, location, scene, locations);
    else if (entry.made)
      add(entry.body, location, scene, locations);
  });
}

}  // namespace

std::vector<BodyLocation> describe_bodies(Keys& top, Scene& scene) {
  std::vector<BodyLocation> locations;
  top.need_at("bodies", "The bodies, each a shape of one material with a velocity field of its own.",
              "a list of maps {box | disk | …, material, …}",
              [&](Slot& slot) { describe_list(slot, scene, locations); });
  return locations;
}

}  // namespace mpmfast
