#include <optional>

#include "engine/scene/sections/describe.hpp"

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

bool is_of_grid(SeparationKind separation) {
  return separation == SeparationKind::displacement || separation == SeparationKind::position_offset ||
         separation == SeparationKind::position_power || separation == SeparationKind::position_piecewise;
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

/// The published method that `as` names; its keys are resolved, so that `as` itself is not written.
std::optional<PublishedContact> describe_published(Keys& map) {
  std::optional<PublishedContact> named;
  map.at("as",
         "A published contact method: its normal and separation; fields is lump, and warm_start, "
         "advance_separation and persistent are false. Keys beside it override it.",
         [&](Slot& slot) {
           std::size_t index = 0;
           if (!slot.writes() && slot.choose(index, kPublishedContacts))
             named = kPublishedContacts[index].value;
         });
  return map.reads() ? named : std::nullopt;
}

/// The keys of a published method, but for the normal.
void set_published(const PublishedContact& method, ContactSpec& contact) {
  contact.separation = method.separation;
  contact.advance_separation = contact.warm_start = contact.persistent = false;
  contact.fields = ManyFields::lump;
}

void describe_normal(Keys& map, int dimension, ContactSpec& contact) {
  constexpr const char* kDescription =
      "The normal, from the body listed first to the other, or into a rigid one.";
  map.at("specified_normal", kDescription, [&](Slot& slot) {
    if (slot.writes() && contact.specified_normal == Vec3{}) return;
    take_unit_vector(slot, dimension, contact.specified_normal);
  });
  map.under("normal=specified", contact.normal == NormalKind::specified,
            [&] { map.need_at("specified_normal", kDescription, "a vector", [](Slot&) {}); });
}

void describe_regression(Keys& map, ContactSpec& contact) {
  constexpr Limit kTolerance{"in (0, 1)", 0, 1, true, true}, kHalf{"in [0, 0.5]", 0, 0.5, false, false};
  map.key("penalty", "Regression: holds the plane back, in units of the cell.", contact.penalty,
          Number{Measure::number, kNotNegative});
  map.key("offset_penalty", "The same for the plane's offset.", contact.offset_penalty,
          Number{Measure::number, kNotNegative});
  map.key("tolerance", "Regression: it stops when the normal turns less (1 - n·n').", contact.tolerance,
          Number{Measure::number, kTolerance});
  map.key("max_iterations", "Regression: at most so many passes.", contact.max_iterations, Whole{1, 1000});
  map.key("warm_start", "A regression starts from the plane of the last step.", contact.warm_start);
  map.key("refit",
          "Cells that what is near may move, a thirtieth of which it may slide, before a node's normal is "
          "found anew; 0: in every step.",
          contact.refit, Number{Measure::number, kHalf});
}

/// Which nodes and pairs touch.
void describe_touching(Keys& map, ContactSpec& contact) {
  constexpr Limit kShare{"in [0, 0.5)", 0, 0.5, false, true};
  map.key("rigid_bias",
          "A rigid body gives the normal unless its gradient is smaller by this factor; 10 or more: also in "
          "place of a regression; 0: off.",
          contact.rigid_bias, Number{Measure::number, kNotNegative});
  map.key("advance_separation", "The gap is judged where the bodies will be at the end of the step.",
          contact.advance_separation);
  map.key("persistent",
          "One set of touching pairs a step, for both corrections and the strain: keeps energy.",
          contact.persistent);
  map.key("hysteresis", "Cells: what touches goes on touching up to this gap.", contact.hysteresis,
          Number{Measure::number, kNotNegative});
  map.key("mass_screen", "Nodes where a body has less than this share of the mass have no contact.",
          contact.mass_screen, Number{Measure::number, kShare});
  map.key("volume_screen", "Nodes with less material than this share of a cell have no contact.",
          contact.volume_screen, Number{Measure::number, kNotNegative});
}

void check_fields(Slot& fields, const ContactSpec& contact) {
  if (fields.reads() && contact.fields == ManyFields::simultaneous &&
      contact.normal == NormalKind::own_gradient)
    fields.report("pairs that are solved together want one normal for both (not normal: own_gradient)");
  const bool of_particles = !is_gradient(contact.normal) && contact.normal != NormalKind::specified &&
                            !is_of_grid(contact.separation);
  if (fields.reads() && contact.fields == ManyFields::pairs && !of_particles)
    fields.report(
        "explicit pairs are found from the particles of each pair (normal: a regression or a margin, "
        "separation: ellipsoid)");
}

/// Where the normal and the gap of contact on nodes come from.
void describe_geometry(Keys& map, int dimension, ContactSpec& contact) {
  const std::optional<PublishedContact> published = describe_published(map);
  if (published) contact.normal = published->normal;
  map.key("normal", "Where the normal of contact comes from.", contact.normal, kNormals);
  if (!map.writes()) set_defaults(contact);
  if (published) set_published(*published, contact);
  describe_normal(map, dimension, contact);
  map.key("separation", "How the gap between two bodies is measured.", contact.separation, kSeparations);
  map.key("position_offset", "Cells that position_offset takes off the gap.", contact.position_offset,
          Number{Measure::number, kNotNegative});
  map.key("piecewise_particles", "Particles along a cell's side that position_piecewise is made for.",
          contact.piecewise_particles, Whole{1, 2});
  map.key("detection", "What makes two bodies touch.", contact.detection, kDetections);
}

void describe_corrections(Keys& map, bool strain_stated, ContactSpec& contact, StrainKind& strain) {
  constexpr Limit kWhole{"in [0, 1]", 0, 1};
  describe_regression(map, contact);
  describe_touching(map, contact);
  map.key("corrections", "Contact corrections a step; 1: only after the forces have acted.",
          contact.corrections, Whole{1, 2});
  if (map.reads() && !strain_stated && !contact.decides_once()) strain = StrainKind::average;
  if (!map.writes()) contact.first_correction_share = share_of(strain, contact);
  map.key("first_correction_share", "flip: share of the first correction that particles take too.",
          contact.first_correction_share, Number{Measure::number, kWhole});
  map.key("jumps", "How interfaces know the jump of displacements in cells that are new to them.",
          contact.jumps, kJumps);
  map.key("area", "How the area of contact is found, for bonds and films.", contact.area, kAreas);
  map.at("fields", "What is done where three or more bodies meet.", [&](Slot& slot) {
    slot.take(contact.fields, kManyFields);
    check_fields(slot, contact);
  });
}

void describe_map(Keys& map, bool strain_stated, Scene& scene, Keys& top) {
  ContactSpec& contact = scene.contact;
  map.key("family", "Where contact acts.", contact.family, kFamilies);
  const bool nodes = contact.family != ContactFamily::penalty || map.describes();
  if (nodes) describe_geometry(map, scene.dimension(), contact);
  describe_law(map, "What surfaces do that touch: the law of all pairs but those in `pairs`.",
               scene.heat.active, contact.law);
  if (nodes) describe_corrections(map, strain_stated, contact, scene.method.strain);
  contact.springs.describe(map);  // with either family, so that --set can choose it
  map.key("points_per_cell", "Points that follow a surface, along the side of a cell.",
          contact.springs.per_cell, Whole{1, 64});
  describe_pairs(map, top, scene);
  map.at("crack", "Cohesive laws: surfaces in this box are not bonded at the start.", [&](Slot& slot) {
    if (slot.writes() && !contact.cracked) return;
    describe_region(slot, scene.dimension(), contact.crack_lower, contact.crack_upper);
    contact.cracked = true;
  });
}

}  // namespace

void describe_contact(Keys& top, bool strain_stated, Scene& scene) {
  ContactSpec& contact = scene.contact;
  if (!top.writes()) contact.first_correction_share = share_of(scene.method.strain, contact);
  top.at("contact", "How bodies touch; none: all share one velocity field and stick together.",
         [&](Slot& slot) {
           if (slot.is_keyword("none", !contact.active))
             contact.active = false;
           else
             slot.map("none or a map {law, friction, normal, separation, …}",
                      [&](Keys& map) { describe_map(map, strain_stated, scene, top); });
         });
}

}  // namespace mpmfast
