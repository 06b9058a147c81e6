#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "engine/scene/sections.hpp"

namespace mpmfast {

const std::vector<LawParameter>& law_parameters() {
  using enum LawKind;
  static const std::vector<LawParameter> kParameters{
      {"friction",
       Measure::number,
       kNotNegative,
       &LawSpec::friction,
       {coulomb, adhesion, velocity_friction},
       false},
      {"static_friction",
       Measure::number,
       kNotNegative,
       &LawSpec::static_friction,
       {coulomb, velocity_friction},
       false},
      {"decay_speed", Measure::velocity, kPositive, &LawSpec::decay_speed, {velocity_friction}, true},
      {"normal_strength", Measure::pressure, kPositive, &LawSpec::normal_strength, {adhesion}, true},
      {"shear_strength", Measure::pressure, kPositive, &LawSpec::shear_strength, {adhesion}, true},
      {"reach", Measure::number, kNotNegative, &LawSpec::reach, {adhesion}, false},
      {"viscosity", Measure::viscosity, kNotNegative, &LawSpec::viscosity, {viscous}, true},
      {"film", Measure::length, kPositive, &LawSpec::film, {viscous}, true},
  };
  return kParameters;
}

bool has_parameter(LawKind law, const LawParameter& parameter) {
  return std::find(parameter.laws.begin(), parameter.laws.end(), law) != parameter.laws.end();
}

/// Friction may stand beside any law, so that --set can choose another; the other parameters may not.
void read_law(MapReader& map, LawSpec& law) {
  const LawKind inherited = law.law;
  map.word("law", kLaws, law.law);
  for (const LawParameter& parameter : law_parameters()) {
    const bool owns = has_parameter(law.law, parameter);
    const bool missing_allowed = !parameter.needed || law.law == inherited;
    const auto value = map.find(parameter.name);
    if (!value && owns && !missing_allowed) {
      const Silence conditional(map.value().problems().recorder());  // the schema has it from the table
      map.need(parameter.name, expected_of(parameter.measure));
    }
    map.expects(parameter.name, {Form::Kind::quantity, parameter.measure, parameter.limit});
    if (owns && !parameter.needed) map.otherwise(parameter.name, law.*parameter.value, parameter.measure);
    if (!value) continue;
    if (!owns && parameter.value != &LawSpec::friction) {
      value->report(fmt::format("the law '{}' has no {}", name_of(kLaws, law.law), parameter.name));
      continue;
    }
    if (const auto number = value->quantity(parameter.measure, parameter.limit))
      law.*parameter.value = *number;
  }
  const bool has_both = law.law == LawKind::coulomb || law.law == LawKind::velocity_friction;
  if (has_both && law.static_friction > 0 && law.static_friction < law.friction) {
    const auto at = map.find("static_friction");
    (at ? *at : map.value())
        .report(fmt::format("static friction {} is less than sliding friction {}", law.static_friction,
                            law.friction));
  }
}

namespace {

/// Reads `contact.pairs`, one entry at a time.
class PairReader {
 public:
  /// @param unread  names of bodies that the scene states but that could not be read
  PairReader(Scene& scene, std::vector<std::string> unread) : scene_(scene), unread_(std::move(unread)) {
    for (const MaterialSpec& material : scene.materials) materials_.push_back(material.name);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) name(scene.bodies[b].name, b);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) name(scene.bodies[b].field, b);
  }

  void read(const Value& entry) {
    MapReader map(entry, "a map {between: [BODY, BODY] or materials: [NAME, NAME], law, …}");
    if (!map.valid()) return;
    ContactPair pair;
    pair.law = scene_.contact;
    const auto bodies = map.find("between"), materials = map.find("materials");
    read_law(map, pair.law);
    map.finish();
    if (map.one_of({{"between"}, {"materials"}}) < 0)
      return entry.report("a pair is either between two bodies or of two materials");
    pair.materials = materials.has_value();
    const Value& who = materials ? *materials : *bodies;
    if (!read_two(who, pair)) return;
    if (pair.materials)
      check_mixed(who, pair);
    else if (field(pair.between[0]) == field(pair.between[1]))
      return who.report(fmt::format("the velocity field '{}' does not meet itself", field(pair.between[0])),
                        "A pair is of two bodies; two parts of one body that meet must be two bodies");
    check_twin(who, pair);
    check_columns(who, pair);
    scene_.contact.pairs.push_back(pair);
  }

 private:
  /// A velocity field is named by any of its bodies, or by its own name.
  void name(const std::string& text, std::size_t body) {
    if (std::find(names_.begin(), names_.end(), text) != names_.end()) return;
    names_.push_back(text);
    body_.push_back(static_cast<int>(body));
  }
  const std::string& field(int body) const { return scene_.bodies[static_cast<std::size_t>(body)].field; }

  bool read_two(const Value& who, ContactPair& pair) const {
    if (!who.is_list(2, 2)) {
      who.complain(pair.materials ? "not a list of two materials" : "not a list of two bodies");
      return false;
    }
    bool good = true;
    for (std::size_t k = 0; k < 2; ++k) {
      if (!pair.materials && states_unread(who.item(k).node())) {
        good = false;  // told where the body stands
        continue;
      }
      const int index = who.item(k).reference(pair.materials ? materials_ : names_);
      good &= index >= 0;
      if (index >= 0) pair.between[k] = pair.materials ? index : body_[static_cast<std::size_t>(index)];
    }
    return good;
  }

  /// Also a level of a bitmap, NAME_LEVEL.
  bool states_unread(const Node& node) const {
    return std::any_of(unread_.begin(), unread_.end(), [&](const std::string& name) {
      return node.scalar == name || node.scalar.rfind(name + "_", 0) == 0;
    });
  }

  /// A field of several materials has no single one that a pair of materials could mean.
  void check_mixed(const Value& who, const ContactPair& pair) const {
    std::map<std::string, int> material;
    for (const BodySpec& body : scene_.bodies) {
      const auto [known, first] = material.emplace(body.field, body.material);
      if (first || known->second == body.material) continue;
      for (int one : pair.between)
        if (one == known->second || one == body.material)
          return who.report(fmt::format(
              "the velocity field '{}' holds several materials: name its bodies (between: …)", body.field));
    }
  }

  void check_twin(const Value& who, const ContactPair& pair) const {
    const auto key = [&](int k) {
      return pair.materials ? scene_.materials[static_cast<std::size_t>(k)].name : field(k);
    };
    for (const ContactPair& other : scene_.contact.pairs) {
      if (other.materials != pair.materials) continue;
      const auto same = [&](std::size_t i, std::size_t j) {
        return key(other.between[0]) == key(pair.between[i]) && key(other.between[1]) == key(pair.between[j]);
      };
      if (same(0, 1) || same(1, 0)) return who.report("this pair has a law already");
    }
  }

  /// history.csv calls a pair NAME+NAME. No other name has a '+'.
  void check_columns(const Value& who, const ContactPair& pair) const {
    const auto name = [&](const ContactPair& of, std::size_t k) {
      const auto index = static_cast<std::size_t>(of.between[k]);
      return of.materials ? scene_.materials[index].name : scene_.bodies[index].name;
    };
    for (const ContactPair& other : scene_.contact.pairs)
      if (other.materials != pair.materials && name(other, 0) == name(pair, 0) &&
          name(other, 1) == name(pair, 1))
        return who.report(
            fmt::format(
                "a pair of bodies and a pair of materials are both called '{}+{}': their forces would "
                "share a column",
                name(pair, 0), name(pair, 1)),
            "Name the two of this pair in the other order");
  }

  Scene& scene_;
  std::vector<std::string> materials_, names_, unread_;
  std::vector<int> body_;  ///< of each name
};

/// Names of bodies that are stated and have not become bodies.
std::vector<std::string> unread_bodies(MapReader& top, const Scene& scene) {
  std::vector<std::string> out;
  const auto bodies = top.find("bodies");
  if (!bodies || !bodies->is(Node::Kind::list)) return out;
  std::set<std::string> read;
  for (const BodySpec& body : scene.bodies) read.insert(body.name);
  for (const Node& entry : bodies->node().items) {
    const int index = index_of(entry, "name");
    if (index < 0) continue;
    const std::string& name = entry.items[static_cast<std::size_t>(index)].scalar;
    if (is_name(name) && !read.contains(name) && index_of(entry, "bitmap") < 0) out.push_back(name);
    if (index_of(entry, "bitmap") >= 0 && is_name(name) &&
        std::none_of(read.begin(), read.end(),
                     [&](const auto& one) { return one.rfind(name + "_", 0) == 0; }))
      out.push_back(name);
  }
  return out;
}

}  // namespace

void read_contact_pairs(MapReader& top, Scene& scene) {
  const auto section = top.find("contact");
  if (!section || !section->is(Node::Kind::map)) return;
  const int index = index_of(section->node(), "pairs");
  if (index < 0) return;
  const Value pairs(section->node().items[static_cast<std::size_t>(index)], join(section->path(), "pairs"),
                    section->problems());
  if (!pairs.is_list()) return pairs.complain("not a list of maps {between: …, law: …}");
  PairReader reader(scene, unread_bodies(top, scene));
  for (std::size_t k = 0; k < pairs.size(); ++k) reader.read(pairs.item(k));
}

void read_rotation(MapReader& body, int dimension, BodySpec& spec) {
  const auto section = body.find("rotation");
  if (!section) return;
  MapReader map(*section, dimension == 2 ? "a map {about, speed}" : "a map {about, axis, speed}");
  if (!map.valid()) return;
  RotationSpec rotation;
  rotation.speed = TimeTable{{0}, {0}};
  if (const auto about = map.need("about", "a point"))
    rotation.about = about->vector(Measure::length, dimension).value_or(Vec3{});
  if (dimension == 3) {
    const When solid(*section, "3d");
    if (const auto axis = map.need("axis", "x, y, z or a vector"))
      rotation.axis = read_direction(*axis, dimension, true).value_or(Vec3{0, 0, 1});
  }
  map.otherwise("speed", 0, Measure::angular_velocity);
  if (const auto speed = map.find("speed"))
    rotation.speed = speed->table(Measure::angular_velocity).value_or(rotation.speed);
  map.finish();
  spec.rotation = rotation;
}

}  // namespace mpmfast
