#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

bool is_gradient(NormalKind normal) {
  return normal == NormalKind::average_gradient || normal == NormalKind::max_gradient ||
         normal == NormalKind::max_volume || normal == NormalKind::own_gradient;
}

bool is_ours(NormalKind normal) {
  return normal == NormalKind::max_margin || normal == NormalKind::smoothed_max_margin ||
         normal == NormalKind::smoothed_logistic_regression;
}

/// The default first_correction_share: with one set of touching pairs nothing has to be drained
/// (tools/manual/theory.md, "The energy of a contact").
double share_of(StrainKind strain, const ContactSpec& contact) {
  const bool seen =
      strain == StrainKind::last_re_extrapolated || strain == StrainKind::average_re_extrapolated;
  return seen || !is_ours(contact.normal) ? 0 : ContactSpec::kDrained;
}

/// What follows from the choice of normals, before the scene's other words: the published methods are as
/// published, ours with all that makes them robust.
void set_defaults(ContactSpec& contact) {
  const bool ours = is_ours(contact.normal);
  contact.advance_separation = contact.warm_start = contact.persistent = ours;
  contact.fields = ours ? ManyFields::simultaneous : ManyFields::lump;
  if (is_gradient(contact.normal)) contact.separation = SeparationKind::position_offset;
}

void read_regression(MapReader& map, ContactSpec& contact) {
  constexpr Limit kTolerance{"in (0, 1)", 0, 1, true, true};
  map.quantity("penalty", Measure::number, kNotNegative, contact.penalty);
  map.quantity("offset_penalty", Measure::number, kNotNegative, contact.offset_penalty);
  map.quantity("tolerance", Measure::number, kTolerance, contact.tolerance);
  map.integer("max_iterations", 1, 1000, contact.max_iterations);
  map.boolean("warm_start", contact.warm_start);
}

}  // namespace

void read_contact(MapReader& top, int dimension, bool strain_stated, StrainKind& strain,
                  ContactSpec& contact) {
  const auto section = top.find("contact");
  if (!section) {
    contact.first_correction_share = share_of(strain, contact);
    return;
  }
  if (section->is_word("none")) {
    contact.active = false;
    return;
  }
  MapReader map(*section, "none or a map {law, friction, normal, separation, …}");
  map.word("normal", kNormals, contact.normal);
  set_defaults(contact);
  const auto normal = map.find("specified_normal");
  if (contact.normal == NormalKind::specified) {
    const When specified(*section, "normal=specified");
    map.need("specified_normal", "a vector");
  }
  if (const auto vector = normal ? normal->vector(Measure::number, dimension) : std::nullopt) {
    const auto unit = unit_vector(*vector);
    if (!unit) normal->report("the zero vector has no direction");
    contact.specified_normal = unit.value_or(Vec3{});
  }
  constexpr Limit kShare{"in [0, 0.5)", 0, 0.5, false, true}, kWhole{"in [0, 1]", 0, 1};
  map.word("separation", kSeparations, contact.separation);
  map.quantity("position_offset", Measure::number, kNotNegative, contact.position_offset);
  map.integer("piecewise_particles", 1, 2, contact.piecewise_particles);
  map.word("detection", kDetections, contact.detection);
  read_law(map, contact);
  read_regression(map, contact);
  map.quantity("rigid_bias", Measure::number, kNotNegative, contact.rigid_bias);
  map.boolean("advance_separation", contact.advance_separation);
  map.boolean("persistent", contact.persistent);
  map.quantity("hysteresis", Measure::number, kNotNegative, contact.hysteresis);
  map.quantity("mass_screen", Measure::number, kShare, contact.mass_screen);
  map.quantity("volume_screen", Measure::number, kNotNegative, contact.volume_screen);
  map.integer("corrections", 1, 2, contact.corrections);
  if (!strain_stated && !contact.decides_once()) strain = StrainKind::average;
  contact.first_correction_share = share_of(strain, contact);
  map.quantity("first_correction_share", Measure::number, kWhole, contact.first_correction_share);
  map.word("area", kAreas, contact.area);
  map.word("fields", kManyFields, contact.fields);
  const bool grid_separation = contact.separation == SeparationKind::displacement ||
                               contact.separation == SeparationKind::position_offset ||
                               contact.separation == SeparationKind::position_power ||
                               contact.separation == SeparationKind::position_piecewise;
  if (contact.fields == ManyFields::pairs &&
      (is_gradient(contact.normal) || contact.normal == NormalKind::specified || grid_separation)) {
    map.find("fields")->report(
        "explicit pairs are found from the particles of each pair (normal: a regression or a margin, "
        "separation: ellipsoid)");
  }
  map.find("pairs");  // known here, read when there are bodies
  map.finish();
}

}  // namespace mpmfast
