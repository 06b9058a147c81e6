#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

/// Double quotes with the escapes of YAML, and one for what would be an expression; everything else stands as
/// it is.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      if (c == '{' && out.back() == '$')
        out += "${";  // "$${" is read as "${"
      else
        out += c;
    }
  }
  return out + '"';
}

/// Names that YAML would read as nothing, or as the start of a list, need quotes.
std::string name_text(const std::string& name) {
  const bool null = name == "null" || name == "Null" || name == "NULL";
  return null || name.front() == '-' ? quoted(name) : name;
}

/// The extent that, added to `lower`, rounds to `upper` again.
double extent_between(double lower, double upper) {
  const double extent = upper - lower;
  double more = extent, less = extent;
  for (int tries = 0; tries < 8; ++tries) {
    if (lower + more == upper) return more;
    if (lower + less == upper) return less;
    more = std::nextafter(more, std::numeric_limits<double>::infinity());
    less = std::nextafter(less, 0.0);
  }
  return extent;
}

/// A table that is one value at time zero is written as that value.
std::string table_text(const TimeTable& table, Measure kind = Measure::velocity) {
  if (table.time.size() == 1 && table.time[0] == 0) return quantity_text(table.value[0], kind);
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < table.time.size(); ++k) {
    parts.push_back(fmt::format("[{}, {}]", quantity_text(table.time[k], Measure::time),
                                quantity_text(table.value[k], kind)));
  }
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

std::string head_text(const Scene& scene) {
  std::string out = fmt::format("title: {}\nspace: {}\n", quoted(scene.title), name_of(kSpaces, scene.space));
  const int d = scene.dimension();
  if (d == 2 && scene.space != Space::axisymmetric)
    out += fmt::format("thickness: {}\n", quantity_text(scene.thickness, Measure::length));
  out += fmt::format("grid:\n  origin: {}\n  size: {}\n  cell: {}\n  leaving: {}\n",
                     vector_text(scene.grid.origin, Measure::length, d),
                     vector_text(scene.grid.size, Measure::length, d),
                     quantity_text(scene.grid.cell, Measure::length), name_of(kLeaving, scene.grid.leaving));
  out += fmt::format(
      "time:\n  end: {}\n  cfl: {}\n  max_step: {}\n  collapse: {}\n",
      quantity_text(scene.time.end, Measure::time), scene.time.cfl,
      std::isinf(scene.time.max_step) ? "none" : quantity_text(scene.time.max_step, Measure::time),
      scene.time.collapse);
  return out;
}

std::string method_text(const MethodSpec& method) {
  const bool ordered = method.update == UpdateKind::xpic || method.update == UpdateKind::fmpm;
  const std::string update =
      ordered ? fmt::format("{}({})", method.update == UpdateKind::xpic ? "xpic" : "fmpm", method.xpic_order)
              : std::string(name_of(kUpdates, method.update));
  return fmt::format(
      "method:\n  basis: {}\n  update: {}\n{}  strain: {}\n  position: {}\n  contact_correction: {}\n  "
      "own_filter: {}\n"
      "  deformation_terms: {}\n",
      name_of(kBases, method.basis), update,
      method.filter_every > 1 ? fmt::format("  every: {}\n", method.filter_every) : "",
      name_of(kStrains, method.strain), name_of(kPositions, method.position), method.contact_correction,
      method.own_filter, name_of(kDeformationTerms, method.deformation_terms));
}

struct ModelText {
  std::string operator()(const NeoHookeanSpec& m) const {
    return fmt::format("model: neo_hookean, density: {}, bulk: {}, shear: {}",
                       quantity_text(m.density, Measure::density), quantity_text(m.bulk, Measure::pressure),
                       quantity_text(m.shear, Measure::pressure));
  }
  std::string operator()(const LinearElasticSpec& m) const {
    return fmt::format("model: linear_elastic, density: {}, young: {}, poisson: {}",
                       quantity_text(m.density, Measure::density), quantity_text(m.young, Measure::pressure),
                       m.poisson);
  }
  std::string operator()(const LogarithmicNeoHookeanSpec& m) const {
    return fmt::format("model: logarithmic_neo_hookean, density: {}, lambda: {}, shear: {}",
                       quantity_text(m.density, Measure::density), quantity_text(m.lambda, Measure::pressure),
                       quantity_text(m.shear, Measure::pressure));
  }
  std::string operator()(const MetalSpec& m) const { return metal_text(m); }
  std::string operator()(const RigidSpec& m) const {
    return fmt::format("model: rigid, density: {}", quantity_text(m.density, Measure::density));
  }
};

struct ShapeText {
  int d;

  std::string length(double value) const { return quantity_text(value, Measure::length); }
  std::string lengths(const Vec3& value) const { return vector_text(value, Measure::length, d); }

  std::string operator()(const BoxShape& s) const {
    return fmt::format("box: {{from: {}, to: {}}}", lengths(s.lower), lengths(s.upper));
  }
  std::string operator()(const EllipsoidShape& s) const {
    return fmt::format("{}: {{centre: {}, radii: {}, angle: {}}}", d == 3 ? "ellipsoid" : "ellipse",
                       lengths(s.centre), lengths(s.radii), quantity_text(s.angle, Measure::angle));
  }
  std::string operator()(const RingShape& s) const {
    const std::string extra = d == 3 ? ", length: " + length(2 * s.half_length) : "";
    return fmt::format("{}: {{centre: {}, inner: {}, outer: {}{}}}", d == 3 ? "tube" : "ring",
                       lengths(s.centre), length(s.inner), length(s.outer), extra);
  }
  std::string operator()(const PolygonShape& s) const {
    std::vector<std::string> points;
    for (const auto& point : s.points)
      points.push_back(fmt::format("[{}, {}]", length(point[0]), length(point[1])));
    const std::string z = d == 3 ? fmt::format(", z: [{}, {}]", length(s.z_lower), length(s.z_upper)) : "";
    return fmt::format("polygon: {{points: [{}]{}}}", fmt::join(points, ", "), z);
  }
  std::string operator()(const StlShape& s) const {
    return fmt::format("stl: {{file: {}, scale: {}, angle: {}, axis: {}, translate: {}}}",
                       quoted(s.file.string()), length(s.scale), quantity_text(s.angle, Measure::angle),
                       vector_text(s.axis, Measure::number, 3), lengths(s.translate));
  }
  std::string operator()(const BitmapShape& s) const { return "bitmap: " + quoted(s.file.string()); }
};

/// Bodies first … last − 1 came from one entry of the scene: one body, or the grey levels of one bitmap.
std::size_t end_of_entry(const Scene& scene, std::size_t first) {
  const auto* bitmap = std::get_if<BitmapShape>(&scene.bodies[first].shape);
  std::size_t last = first + 1;
  if (!bitmap) return last;
  for (; last < scene.bodies.size(); ++last) {
    const auto* next = std::get_if<BitmapShape>(&scene.bodies[last].shape);
    if (!next || next->image != bitmap->image) break;
  }
  return last;
}

/// The keys that only a bitmap has.
std::string bitmap_text(const Scene& scene, std::size_t first, std::size_t last) {
  const auto& shape = std::get<BitmapShape>(scene.bodies[first].shape);
  std::array<bool, 256> skipped{};
  for (const unsigned char grey : shape.image->pixel) skipped[grey] = true;
  std::vector<std::string> materials;
  for (std::size_t b = first; b < last; ++b) {
    const int grey = std::get<BitmapShape>(scene.bodies[b].shape).grey;
    skipped[static_cast<std::size_t>(grey)] = false;
    const auto material = static_cast<std::size_t>(scene.bodies[b].material);
    materials.push_back(fmt::format("{}: {}", grey, name_text(scene.materials[material].name)));
  }
  std::vector<int> skip;
  for (int grey = 0; grey < 256; ++grey) {
    if (skipped[static_cast<std::size_t>(grey)]) skip.push_back(grey);
  }
  const Vec3 extent{extent_between(shape.lower[0], shape.upper[0]),
                    extent_between(shape.lower[1], shape.upper[1]), 0};
  return fmt::format("    origin: {}\n    extent: {}\n    skip: [{}]\n    materials: {{{}}}\n",
                     vector_text(shape.lower, Measure::length, 2), vector_text(extent, Measure::length, 2),
                     fmt::join(skip, ", "), fmt::join(materials, ", "));
}

std::string velocity_text(const BodySpec& body, int d) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
    parts.push_back(body.rigid_velocity[k] ? table_text(*body.rigid_velocity[k])
                                           : quantity_text(body.velocity[k], Measure::velocity));
  }
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

std::string seeding_text(const SeedingSpec& seeding) {
  if (seeding.rings) return "rings";
  if (seeding.angle == 0) return "lattice";
  return fmt::format("{{angle: {}}}", quantity_text(seeding.angle, Measure::angle));
}

std::string entry_text(const Scene& scene, std::size_t first, std::size_t last) {
  const BodySpec& body = scene.bodies[first];
  const int d = scene.dimension();
  std::string out;
  if (const auto* bitmap = std::get_if<BitmapShape>(&body.shape)) {
    const std::string suffix = fmt::format("_{}", bitmap->grey);
    out += fmt::format("  - name: {}\n", name_text(body.name.substr(0, body.name.size() - suffix.size())));
    out += fmt::format("    {}\n{}", ShapeText{d}(*bitmap), bitmap_text(scene, first, last));
    if (body.field != body.name) out += fmt::format("    field: {}\n", name_text(body.field));
  } else {
    out += fmt::format("  - name: {}\n    {}\n", name_text(body.name), std::visit(ShapeText{d}, body.shape));
    out += fmt::format("    material: {}\n    field: {}\n",
                       name_text(scene.materials[static_cast<std::size_t>(body.material)].name),
                       name_text(body.field));
  }
  const std::vector<int> counts(body.particles_per_cell.begin(), body.particles_per_cell.begin() + d);
  out += fmt::format("    particles_per_cell: [{}]\n    seeding: {}\n    velocity: {}\n",
                     fmt::join(counts, ", "), seeding_text(body.seeding), velocity_text(body, d));
  if (!body.rotation) return out;
  const std::string axis =
      d == 3 ? fmt::format(", axis: {}", vector_text(body.rotation->axis, Measure::number, d)) : "";
  return out + fmt::format("    rotation: {{about: {}{}, speed: {}}}\n",
                           vector_text(body.rotation->about, Measure::length, d), axis,
                           table_text(body.rotation->speed, Measure::angular_velocity));
}

struct BoundaryText {
  int d;

  std::string operator()(const WallSpec& wall) const {
    const std::string position = quantity_text(wall.position, Measure::length);
    const bool still = wall.speed.time.size() == 1 && wall.speed.time[0] == 0 && wall.speed.value[0] == 0;
    std::string at = std::string(name_of(kWallPlaces, wall.place));
    if (wall.place == WallPlace::surface && !wall.held) at += fmt::format(", friction: {}", wall.friction);
    if (still)
      return fmt::format("{{wall: {}, position: {}, at: {}}}", wall.held ? "held" : "sliding", position, at);
    return fmt::format("{{piston: {}, direction: {}, held: {}, position: {}, at: {}}}",
                       table_text(wall.speed), "xyz"[wall.axis], wall.held, position, at);
  }
  std::string operator()(const VelocityBoxSpec& box) const {
    return fmt::format("{{box: {{from: {}, to: {}}}, direction: {}, speed: {}}}",
                       vector_text(box.lower, Measure::length, d), vector_text(box.upper, Measure::length, d),
                       vector_text(box.direction, Measure::number, d), table_text(box.speed));
  }
};

std::string boundaries_text(const Scene& scene) {
  std::string out = "boundaries:\n";
  const int d = scene.dimension();
  for (const BoundarySpec& boundary : scene.boundaries) {
    out +=
        fmt::format("  {}: {}\n", name_text(boundary.name), std::visit(BoundaryText{d}, boundary.condition));
  }
  for (const FaceName& face : kFaces) {
    const bool given = std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                                   [&](const BoundarySpec& boundary) { return boundary.name == face.name; });
    if (!given && face.axis < d) out += fmt::format("  {}: free\n", face.name);
  }
  return out;
}

/// The law and the parameters that it has; friction always, so that another law can be set from outside.
std::vector<std::string> law_lines(const LawSpec& law) {
  std::vector<std::string> lines{fmt::format("law: {}", name_of(kLaws, law.law))};
  for (const LawParameter& parameter : law_parameters()) {
    if (!has_parameter(law.law, parameter) && parameter.value != &LawSpec::friction) continue;
    lines.push_back(
        fmt::format("{}: {}", parameter.name, quantity_text(law.*parameter.value, parameter.measure)));
  }
  return lines;
}

std::string pairs_text(const Scene& scene) {
  if (scene.contact.pairs.empty()) return "";
  std::string out = "  pairs:\n";
  for (const ContactPair& pair : scene.contact.pairs) {
    const auto name = [&](int index) {
      const auto k = static_cast<std::size_t>(index);
      return name_text(pair.materials ? scene.materials[k].name : scene.bodies[k].name);
    };
    out += fmt::format("    - {{{}: [{}, {}], {}}}\n", pair.materials ? "materials" : "between",
                       name(pair.between[0]), name(pair.between[1]), fmt::join(law_lines(pair.law), ", "));
  }
  return out;
}

std::string contact_text(const Scene& scene) {
  const ContactSpec& contact = scene.contact;
  if (!contact.active) return "contact: none\n";
  std::string out = fmt::format("contact:\n  normal: {}\n", name_of(kNormals, contact.normal));
  if (contact.specified_normal != Vec3{}) {
    out += fmt::format("  specified_normal: {}\n",
                       vector_text(contact.specified_normal, Measure::number, scene.dimension()));
  }
  out += fmt::format("  separation: {}\n  position_offset: {}\n  piecewise_particles: {}\n  detection: {}\n",
                     name_of(kSeparations, contact.separation), contact.position_offset,
                     contact.piecewise_particles, name_of(kDetections, contact.detection));
  out += fmt::format("  {}\n", fmt::join(law_lines(contact), "\n  "));
  out += fmt::format(
      "  penalty: {}\n  offset_penalty: {}\n  tolerance: {}\n  max_iterations: {}\n  warm_start: {}\n",
      contact.penalty, contact.offset_penalty, contact.tolerance, contact.max_iterations, contact.warm_start);
  out += fmt::format(
      "  rigid_bias: {}\n  advance_separation: {}\n  persistent: {}\n  first_correction_share: {}\n"
      "  hysteresis: {}\n  mass_screen: {}\n  volume_screen: {}\n",
      contact.rigid_bias, contact.advance_separation, contact.persistent, contact.first_correction_share,
      contact.hysteresis, contact.mass_screen, contact.volume_screen);
  out += fmt::format("  corrections: {}\n  area: {}\n  fields: {}\n", contact.corrections,
                     name_of(kAreas, contact.area), name_of(kManyFields, contact.fields));
  return out + pairs_text(scene);
}

std::string output_text(const OutputSpec& output) {
  const CheckpointSpec& c = output.checkpoint;
  const std::string every = c.every > 0 ? quantity_text(c.every, Measure::time) : "none",
                    steps = c.steps > 0 ? fmt::format("{}", c.steps) : "none",
                    checkpoint = c.active ? fmt::format("{{every: {}, steps: {}}}", every, steps)
                                          : std::string("none");
  return fmt::format(
      "output:\n  frames: {}\n  history: {}\n  overlap: {}\n  grid: {}\n  checkpoint: {}\n  picture: {}\n",
      output.frames, output.history, output.overlap, output.grid, checkpoint, output.picture);
}

}  // namespace

std::string write_scene(const Scene& scene) {
  const int d = scene.dimension();
  std::string out = head_text(scene) + method_text(scene.method) + "materials:\n";
  for (const MaterialSpec& material : scene.materials) {
    out += fmt::format("  {}: {{{}}}\n", name_text(material.name), std::visit(ModelText{}, material.model));
  }
  out += "bodies:\n";
  for (std::size_t first = 0; first < scene.bodies.size();) {
    const std::size_t last = end_of_entry(scene, first);
    out += entry_text(scene, first, last);
    first = last;
  }
  out += boundaries_text(scene);
  out += fmt::format("gravity:\n  acceleration: {}\n  ramp: {}\n",
                     vector_text(scene.gravity.acceleration, Measure::acceleration, d),
                     quantity_text(scene.gravity.ramp, Measure::time));
  out += contact_text(scene);
  return out + output_text(scene.output);
}

}  // namespace mpmfast
