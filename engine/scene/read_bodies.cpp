#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

/// What the later checks need to say of a body where it stands.
struct BodyPlace {
  Value entry;
  Value name;
};

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const ShapeKind& kind : shape_kinds()) names.emplace_back(kind.name);
    return names;
  }();
  return kNames;
}

/// A body has one of them.
const KeyGroups& shape_keys() {
  static const KeyGroups kKeys = [] {
    KeyGroups groups;
    for (const std::string& name : shape_names()) groups.push_back({name});
    return groups;
  }();
  return kKeys;
}

/// The same shape's name in the other dimension.
std::string counterpart(const std::string& name) {
  static const std::map<std::string, std::string> kPairs{{"disk", "sphere"},       {"sphere", "disk"},
                                                         {"ellipse", "ellipsoid"}, {"ellipsoid", "ellipse"},
                                                         {"ring", "tube"},         {"tube", "ring"}};
  const auto found = kPairs.find(name);
  return found == kPairs.end() ? "" : fmt::format("Did you mean '{}'?", found->second);
}

/// A body with no shape, or with several.
void report_shapes(MapReader& map) {
  std::vector<Value> chosen;
  for (const ShapeKind& kind : shape_kinds())
    if (const auto value = map.find(kind.name)) chosen.push_back(*value);
  if (chosen.empty())
    map.value().report(fmt::format("a body needs a shape (one of {})", fmt::join(shape_names(), ", ")));
  else
    chosen[1].report(fmt::format("a body has one shape, and it is already a {}",
                                 chosen[0].path().substr(chosen[0].path().rfind('.') + 1)));
}

/// The one shape key of a body.
struct ChosenShape {
  const ShapeKind* kind;
  Value value;
};
std::optional<ChosenShape> choose_shape(MapReader& map, int dimension) {
  const int which = map.one_of(shape_keys());
  if (which < 0) {
    report_shapes(map);
    return std::nullopt;
  }
  const ShapeKind& kind = shape_kinds()[static_cast<std::size_t>(which)];
  const Value value = *map.find(kind.name);
  if (kind.dimension != 0 && kind.dimension != dimension) {
    const bool vowel = kind.name[0] == 'e' || std::string_view(kind.name) == "stl";
    value.report(fmt::format("{} {} exists in {}-D only", vowel ? "an" : "a", kind.name, kind.dimension),
                 counterpart(kind.name));
    return std::nullopt;
  }
  return ChosenShape{&kind, value};
}

void read_particles_per_cell(MapReader& map, int dimension, BodySpec& body) {
  constexpr int kMost = 8;
  if (dimension == 2) body.particles_per_cell[2] = 1;
  const auto value = map.find("particles_per_cell");
  map.otherwise("particles_per_cell", body.particles_per_cell[0], Measure::number);
  if (!value) return;
  const bool list = value->is(Node::Kind::list);
  if (list && !value->is_list(dimension, dimension)) {
    return value->complain(
        fmt::format("not a whole number or a list of {} (particles along a cell's side)", dimension));
  }
  const auto one = list ? std::nullopt : value->integer(1, kMost);
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const auto count = list ? value->item(k).integer(1, kMost) : one;
    if (count) body.particles_per_cell[k] = *count;
  }
}

void read_seeding(MapReader& map, BodySpec& body) {
  const auto value = map.find("seeding");
  map.otherwise("seeding", "lattice");
  if (value) value->offers(kSeedings);
  if (!value || value->is_word("lattice")) return;
  body.seeding.rings = value->is_word("rings");
  if (body.seeding.rings) return;
  if (!value->is(Node::Kind::map)) return value->complain("not lattice, rings or {angle: …}");
  MapReader angle(*value);
  angle.need_quantity("angle", Measure::angle, kAny, body.seeding.angle);
  angle.finish();
}

void read_velocity(MapReader& map, int dimension, BodySpec& body) {
  const auto value = map.find("velocity");
  map.otherwise("velocity", body.velocity, Measure::velocity, dimension);
  if (!value) return;
  if (!value->is_list(dimension, dimension)) {
    return value->complain(fmt::format("not a list of {} (velocities: m/s, mm/s, km/s)", dimension),
                           value->vector_hint(Measure::velocity, dimension));
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    if (const auto table = value->item(k).table(Measure::velocity)) {
      body.velocity[k] = table->value.front();
      if (table->time.size() > 1) body.rigid_velocity[k] = *table;  // one point is a constant
    }
  }
}

/// Tables make sense only where the body obeys them.
void check_tables(const Value& entry, const Scene& scene, const BodySpec& body) {
  if (is_rigid(scene, body)) return;
  const auto refuse = [&](const char* key, const char* what) {
    const int index = index_of(entry.node(), key);
    Value(entry.node().items[static_cast<std::size_t>(index)], join(entry.path(), key), entry.problems())
        .report(fmt::format("{} is for rigid bodies only", what));
  };
  const auto& tables = body.rigid_velocity;
  if (std::any_of(tables.begin(), tables.end(), [](const auto& table) { return table.has_value(); }))
    refuse("velocity", "a table of velocities");
  if (body.rotation && body.rotation->speed.time.size() > 1) refuse("rotation", "a table of rotations");
}

/// One entry of the list: one body, or one for each grey level of a bitmap.
class BodyReader {
 public:
  BodyReader(Scene& scene, std::vector<BodyPlace>& places) : scene_(scene), places_(places) {
    for (const MaterialSpec& material : scene.materials) materials_.push_back(material.name);
  }

  void read(const Value& entry, std::size_t number) {
    MapReader map(entry, "a map {box | disk | …, material, …}");
    if (!map.valid()) return;
    const int dimension = scene_.dimension();
    BodySpec body;
    const auto name = map.find("name");
    body.name = (name ? name->name() : std::nullopt).value_or(fmt::format("body{}", number + 1));
    const auto field = map.find("field");
    body.field = (field ? field->name() : std::nullopt).value_or("");
    read_particles_per_cell(map, dimension, body);
    read_seeding(map, body);
    read_velocity(map, dimension, body);
    read_rotation(map, dimension, body);
    if (map.find("bitmap")) {
      const When beside(entry, "bitmap");
      for (const char* key : {"extent", "origin", "skip", "materials"})
        map.find(key);  // known, whatever else is wrong
    }
    const auto chosen = choose_shape(map, dimension);
    const BodyPlace place{entry, name.value_or(entry)};
    if (chosen && !chosen->kind->read) {
      read_parts(map, chosen->value, body, place);
    } else {
      const auto index = need_material(map);
      const auto shape = chosen ? chosen->kind->read(chosen->value, scene_) : std::nullopt;
      if (index && shape) {
        body.material = *index;
        body.shape = *shape;
        add(body, place);
      }
    }
    map.finish();
  }

 private:
  std::optional<int> material_index(const Value& value) const {
    const int index = value.reference(materials_);
    return index < 0 ? std::nullopt : std::optional<int>(index);
  }

  std::optional<int> need_material(MapReader& map) const {
    const When beside(map.value(), "!bitmap");
    const auto material = map.need("material", "the name of a material");
    return material ? material_index(*material) : std::nullopt;
  }

  void read_parts(MapReader& map, const Value& bitmap, const BodySpec& common, const BodyPlace& place) {
    const std::vector<BitmapPart> parts = read_bitmap(map, bitmap, scene_);
    const When beside(map.value(), "bitmap");
    const auto shared = map.find("material");
    const auto shared_index = shared ? material_index(*shared) : std::nullopt;
    if (!shared && parts.empty()) return;
    for (const BitmapPart& part : parts) {
      BodySpec body = common;
      body.name = fmt::format("{}_{}", common.name, part.shape.grey);
      body.shape = part.shape;
      if (!part.material && !shared) {
        place.entry.report(
            fmt::format("no material for the grey level {} (material: NAME, or materials: {{GREY: NAME}})",
                        part.shape.grey));
        continue;
      }
      const auto index = part.material ? material_index(*part.material) : shared_index;
      if (!index) continue;
      body.material = *index;
      add(body, place);
    }
  }

  void add(BodySpec body, const BodyPlace& place) {
    if (body.field.empty()) body.field = body.name;
    check_tables(place.entry, scene_, body);
    scene_.bodies.push_back(std::move(body));
    places_.push_back(place);
  }

  Scene& scene_;
  std::vector<BodyPlace>& places_;
  std::vector<std::string> materials_;  ///< names
};

/// Particles may only lie in the grid. A shape across the axis of an axisymmetric scene is its right half; a
/// box can begin there.
void check_inside(const Scene& scene, const BodySpec& body, const BodyPlace& place) {
  const Bounds box = bounds(body.shape);
  const double slack = 1e-6 * scene.grid.cell;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.dimension()); ++k) {
    const bool halved = k == 0 && scene.space == Space::axisymmetric && scene.grid.origin[0] == 0 &&
                        !std::holds_alternative<BoxShape>(body.shape);
    const double below = halved ? 0 : scene.grid.origin[k] - box.lower[k];
    const double above = box.upper[k] - (scene.grid.origin[k] + scene.grid.size[k]);
    const auto report = [&](double by, const char* where) {
      const double size = scene.grid.size[k];
      place.entry.report(
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

/// Where particles cannot lie as `seeding` says.
void check_seeding(const Scene& scene, const BodySpec& body, const BodyPlace& place) {
  if (!body.seeding.turned()) return;
  const auto refuse = [&](const char* why) {
    if (const auto seeding = MapReader(place.entry).find("seeding")) seeding->complain(why);
  };
  const auto& model = scene.materials[static_cast<std::size_t>(body.material)].model;
  if (std::holds_alternative<LinearElasticSpec>(model))
    refuse("linear_elastic takes turned particles for strained ones (neo_hookean does not)");
  if (std::holds_alternative<BitmapShape>(body.shape))
    refuse("the levels of a bitmap share the grid's lattice");
  if (scene.space == Space::axisymmetric)
    refuse("the particles of an axisymmetric scene lie along the radius");
  if (body.seeding.rings && !is_round(scene, body.shape))
    refuse("rings are for disks and rings in the plane");
}

/// Particles have indices of 32 bits, and nobody means a billion of them.
void check_count(const Scene& scene, const BodySpec& body, const BodyPlace& place) {
  constexpr double kMost = 1e9;
  const Bounds box = bounds(body.shape);
  double count = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.dimension()); ++k) {
    count *= (box.upper[k] - box.lower[k]) / scene.grid.cell * body.particles_per_cell[k];
  }
  if (count > kMost)
    place.entry.report(fmt::format("body '{}' would have about {:.2g} particles", body.name, count));
}

/// A rigid body's velocity is given, so nothing may move in one velocity field with it.
void check_rigid(const Scene& scene, const std::vector<BodyPlace>& places) {
  std::map<std::string, int> sharers;
  for (const BodySpec& body : scene.bodies) ++sharers[body.field];
  std::size_t rigid = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (!is_rigid(scene, body)) continue;
    ++rigid;
    const bool shared = scene.contact.active ? sharers[body.field] > 1 : scene.bodies.size() > 1;
    if (!shared) continue;
    places[b].entry.report(fmt::format("the rigid body '{}' shares a velocity field with another body{}",
                                       body.name, scene.contact.active ? "" : ", because of contact: none"));
  }
  const bool all_read = !places.empty() && places[0].entry.problems().empty();
  if (all_read && rigid == scene.bodies.size())
    places[0].entry.report("every body is rigid: there is nothing to compute");
}

void check_bodies(const Scene& scene, const std::vector<BodyPlace>& places, bool grid_known) {
  std::set<std::string> names, fields;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (!names.insert(body.name).second)
      places[b].name.report(fmt::format("another body is called '{}'", body.name));
    if (body.name == "all")
      places[b].name.report("history.csv calls the means over all bodies 'all': they would share columns",
                            "Give the body another name");
    fields.insert(body.field);
    check_seeding(scene, body, places[b]);
    if (!grid_known) continue;
    check_inside(scene, body, places[b]);
    check_count(scene, body, places[b]);
  }
  if (names.size() == scene.bodies.size()) check_rigid(scene, places);  // two of one name share a field too
  constexpr std::size_t kMostBodies = 65535;  // particles carry their body in 16 bits
  if (scene.bodies.size() > kMostBodies) {
    places[0].entry.report(fmt::format("{} bodies (at most {})", scene.bodies.size(), kMostBodies));
  }
}

/// For those who name the bodies by keys, or forgot the dashes.
std::string list_hint(const Node& bodies) {
  if (bodies.kind != Node::Kind::map || bodies.keys.empty()) return "";
  const bool names = index_of(bodies.items[0], "material") >= 0;
  return names ? fmt::format("A body begins with '- name: {}'", bodies.keys[0].text)
               : fmt::format("A body begins with a dash, '- {}: …'", bodies.keys[0].text);
}

}  // namespace

void read_bodies(MapReader& top, bool grid_known, Scene& scene) {
  const auto section = top.need("bodies", "a list of maps {box | disk | …, material, …}");
  if (!section) return;
  if (!section->is_list(1)) {
    if (section->is(Node::Kind::list)) return section->report("no bodies");
    return section->complain("not a list of maps {box | disk | …, material, …}", list_hint(section->node()));
  }
  std::vector<BodyPlace> places;
  BodyReader reader(scene, places);
  for (std::size_t k = 0; k < section->size(); ++k) reader.read(section->item(k), k);
  check_bodies(scene, places, grid_known);
}

}  // namespace mpmfast
