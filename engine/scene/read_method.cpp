#include <charconv>

#include "engine/scene/sections.hpp"
#include "engine/scene/suggest.hpp"

namespace mpmfast {

namespace {

/// flip, pic or xpic(m).
void read_update(const Value& value, MethodSpec& method) {
  constexpr const char* kExpected = "not an update (flip, pic, or xpic(m) with m = 2..20)";
  if (!value.is(Node::Kind::scalar)) return value.complain(kExpected);
  const std::string& text = value.node().scalar;
  method.xpic_order = 1;
  if (text == "flip") {
    method.update = UpdateKind::flip;
    return;
  }
  if (text == "pic") {
    method.update = UpdateKind::pic;
    return;
  }
  const std::string name = text.substr(0, text.find('('));
  if (name != "xpic") {
    const std::vector<std::string> known{"flip", "pic", "xpic"};
    return value.complain(kExpected, did_you_mean(name, known));
  }
  int order = 0;
  const char* const first = text.data() + name.size() + 1;
  const bool closed = text.size() > name.size() + 2 && text.back() == ')';
  const char* const last = text.data() + text.size() - 1;
  const bool whole = closed && std::from_chars(first, last, order).ptr == last && *first != '0';
  if (!whole || order < 2 || order > 20) {
    return value.complain("xpic needs its order (xpic(m) with m = 2..20)",
                          order == 1 ? "xpic(1) is pic" : "");
  }
  method.update = UpdateKind::xpic;
  method.xpic_order = order;
}

}  // namespace

void read_method(MapReader& top, MethodSpec& method) {
  const auto section = top.find("method");
  if (!section) return;
  MapReader map(*section, "a map {basis, update, …}");
  map.word("basis", kBases, method.basis);
  if (const auto update = map.find("update")) read_update(*update, method);
  map.word("strain", kStrains, method.strain);
  const auto position = map.find("position");
  if (const auto chosen = position ? position->word(kPositions) : std::nullopt) {
    if (method.update == UpdateKind::flip && *chosen != PositionKind::grid) {
      position->complain("flip moves particles with the grid (position: grid)");
    }
    method.position = *chosen;
  }
  map.boolean("contact_correction", method.contact_correction);
  map.integer("deformation_terms", 1, 2, method.deformation_terms);
  map.finish();
}

void read_contact(MapReader& top, int dimension, ContactSpec& contact) {
  const auto section = top.find("contact");
  if (!section) return;
  if (section->is_word("none")) {
    contact.active = false;
    return;
  }
  MapReader map(*section, "none or a map {law, friction, normal, separation, …}");
  map.word("normal", kNormals, contact.normal);
  if (contact.normal == NormalKind::smoothed_logistic_regression) {
    contact.penalty = 1;
    contact.advance_separation = true;
  }
  if (contact.normal == NormalKind::average_gradient) contact.separation = SeparationKind::position_offset;
  const auto normal = contact.normal == NormalKind::specified ? map.need("specified_normal", "a vector")
                                                              : map.find("specified_normal");
  if (const auto vector = normal ? normal->vector(Measure::number, dimension) : std::nullopt) {
    const auto unit = unit_vector(*vector);
    if (!unit) normal->report("the zero vector has no direction");
    contact.specified_normal = unit.value_or(Vec3{});
  }
  constexpr Limit kShare{"in [0, 0.5)", 0, 0.5, false, true};
  map.word("separation", kSeparations, contact.separation);
  map.quantity("position_offset", Measure::number, kNotNegative, contact.position_offset);
  read_law(map, contact);
  map.quantity("penalty", Measure::number, kNotNegative, contact.penalty);
  map.boolean("advance_separation", contact.advance_separation);
  map.quantity("hysteresis", Measure::number, kNotNegative, contact.hysteresis);
  map.quantity("mass_screen", Measure::number, kShare, contact.mass_screen);
  map.integer("corrections", 1, 2, contact.corrections);
  map.word("area", kAreas, contact.area);
  map.word("fields", kManyFields, contact.fields);
  const bool clouds = (contact.normal == NormalKind::logistic_regression ||
                       contact.normal == NormalKind::smoothed_logistic_regression) &&
                      contact.separation == SeparationKind::ellipsoid;
  if (contact.fields == ManyFields::pairs && !clouds) {
    map.find("fields")->report(
        "explicit pairs are found from the particles of each pair (normal: logistic_regression, separation: "
        "ellipsoid)");
  }
  map.find("pairs");  // known here, read when there are bodies
  map.finish();
}

}  // namespace mpmfast
