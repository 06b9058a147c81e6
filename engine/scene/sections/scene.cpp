#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

void describe_head(Keys& top, Scene& scene) {
  top.key("title", "Name of the scene; that of its file if not given.", scene.title, Text{});
  top.need_at(
      "space", "Whether the scene lies in a plane, turns about an axis or is solid.", expected_of(kSpaces),
      [&](Slot& slot) {
        if (slot.reads() && (slot.value()->node().scalar == "2d" || slot.value()->node().scalar == "2D"))
          return slot.complain("not known here (one of plane_strain, plane_stress, axisymmetric, 3d)",
                               "plane_strain is the usual one of two dimensions");
        slot.take(scene.space, kSpaces);
      });
  const bool solid = scene.dimension() == 3, turned = scene.space == Space::axisymmetric;
  if (!solid && !turned)
    top.key("thickness", "Planes only: masses, forces and energies are those of this depth.", scene.thickness,
            Number{Measure::length, kPositive});
  else
    top.check("thickness", [&](Slot& slot) {
      slot.report(solid ? "a 3-D scene has no thickness"
                        : "an axisymmetric scene has no thickness: it is whole round its axis");
    });
}

/// Not with apic, whose slopes come back larger, nor with contact: a field without freedom on a node has no
/// momentum there (theory.md, "Extended splines").
void check_extension(const Value& top, const Scene& scene) {
  const auto field = [&](const BodySpec& body) {
    const bool shared = !scene.contact.active && !is_rigid(scene, body);
    return shared ? std::string() : body.field.empty() ? body.name : body.field;
  };
  const auto meets = [&](const BodySpec& body) { return field(body) != field(scene.bodies[0]); };
  const Value stated = *top.find("method")->find("extension");
  if (scene.method.update == UpdateKind::apic) stated.report("apic makes energy with extended splines");
  if (scene.contact.family != ContactFamily::penalty &&
      std::any_of(scene.bodies.begin(), scene.bodies.end(), meets))
    stated.report("extended splines do not know contact on nodes: one velocity field was expected",
                  "family: penalty; contact: none; or leave the extension out");
}

/// Penalty contact needs surfaces that stay whole, and laws that only push.
void check_penalty(const Value& top, const Scene& scene) {
  const Value stated = *top.find("contact")->find("family");
  const auto bonds = [](const SurfaceLaw& law) {
    return std::visit(
        [](const auto& one) {
          return one.scope == LawScope::everywhere || one.scope == LawScope::bonded ||
                 one.scope == LawScope::interface;
        },
        law.acts);
  };
  if (scene.contact.any(bonds)) stated.report("penalty contact only pushes: it has no bonds");
  if (scene.grid.outflow == OutflowKind::outflow)
    stated.report("surfaces are followed whole: none may flow out (grid.leaving)");
  if (scene.space == Space::axisymmetric)
    stated.report("penalty contact does not know scenes about an axis yet");
}

/// Contact at the surface finds its points from fits in every step, and has one active set a step.
void check_surface(const Value& top, const Scene& scene) {
  const ContactSpec& contact = scene.contact;
  const Value stated = *top.find("contact")->find("family");
  const auto refuse = [&](bool wrong, const char* why, const char* hint = "family: nodes") {
    if (wrong) stated.report(why, hint);
  };
  const auto rubs = [](const SurfaceLaw& law) {
    return std::visit(
        [](const auto& one) {
          return one.scope == LawScope::nowhere || (one.scope == LawScope::contact && !one.uses_area);
        },
        law.acts);
  };
  refuse(
      !rubs(contact.law) || !std::all_of(contact.pairs.begin(), contact.pairs.end(),
                                         [&](const PairLawSpec& pair) { return rubs(pair.law); }),
      "contact at the surface knows the laws coulomb, frictionless, stick, velocity_friction and ignore yet");
  refuse(!contact.decides_once() || (scene.method.strain != StrainKind::last_re_extrapolated &&
                                     scene.method.strain != StrainKind::average_re_extrapolated),
         "contact at the surface decides once a step what touches",
         "method.strain: average+ or last+, and corrections, persistent, advance_separation and detection as "
         "they are by default");
  const bool fitted =
      contact.normal == NormalKind::max_margin || contact.normal == NormalKind::smoothed_max_margin ||
      contact.normal == NormalKind::logistic_regression ||
      contact.normal == NormalKind::smoothed_logistic_regression ||
      contact.normal == NormalKind::logistic_irls || contact.normal == NormalKind::linear_regression;
  const bool by_particles = contact.separation == SeparationKind::ellipsoid ||
                            contact.separation == SeparationKind::ellipsoid_support ||
                            contact.separation == SeparationKind::parallelogram_support;
  refuse(!fitted || !by_particles || contact.fields != ManyFields::simultaneous || contact.refit > 0,
         "contact at the surface finds its points from the particles of each pair in every step",
         "a normal by a fit, separation: ellipsoid, fields: simultaneous, refit: 0");
  refuse(scene.heat.active, "contact at the surface does not know heat yet");
  refuse(!scene.cracks.empty(), "contact at the surface does not know cracks yet");
}

/// What follows surfaces and cracks knows the particles that a body was seeded with.
void check_split(const Value& top, const Scene& scene) {
  const Value stated = *top.find("method")->find("split");
  if (scene.contact.family == ContactFamily::penalty)
    stated.report("particles of bodies whose surfaces are followed (contact.family: penalty) are not split");
  if (!scene.cracks.empty()) stated.report("particles of bodies with cracks are not split yet");
}

/// Springs join two bodies each, whose displacements tell how far they are apart.
void check_interfaces(const Value& top, const Scene& scene) {
  if (!scene.contact.any([](const SurfaceLaw& law) { return has_springs(law.acts); })) return;
  const Value stated = *top.find("contact");
  if (scene.contact.fields != ManyFields::simultaneous)
    stated.report("interfaces join bodies in pairs: fields: simultaneous was expected");
  if (scene.contact.normal == NormalKind::own_gradient)
    stated.report("interfaces want one normal for both sides (not normal: own_gradient)");
  for (const BodySpec& body : scene.bodies)
    if (body.rotation && is_rigid(scene, body))
      stated.report(fmt::format("interfaces do not know rigid bodies that turn ('{}')", body.name));
}

/// A crack parts what is bonded.
void check_crack(const Value& top, const Scene& scene) {
  const auto bonds = [](const SurfaceLaw& law) { return std::holds_alternative<Cohesive>(law.acts); };
  const bool glued = std::any_of(scene.cracks.begin(), scene.cracks.end(),
                                 [&](const CrackSpec& crack) { return bonds(crack.law); });
  if (!scene.contact.cracked || glued || scene.contact.any(bonds)) return;
  top.find("contact")->find("crack")->report(
      "nothing is bonded that a crack could part: law: cohesive was expected");
}

/// What follows from several sections.
void check_scene(const Value& top, bool grid_known, const std::vector<BodyLocation>& locations,
                 Scene& scene) {
  check_bodies(scene, locations, grid_known);
  if (scene.contact.family == ContactFamily::penalty)
    check_penalty(top, scene);
  else if (scene.contact.family == ContactFamily::surface)
    check_surface(top, scene);
  else if (scene.contact.active)
    check_interfaces(top, scene);
  check_crack(top, scene);
  if (scene.method.extended) check_extension(top, scene);
  if (scene.method.split) check_split(top, scene);
  check_heat(top, scene, locations);
  if (!scene.cracks.empty()) check_cracks(top, scene);
  check_loads(top, scene);
  if (scene.space == Space::plane_stress) check_plane_stress(top, scene);
  if (scene.space == Space::axisymmetric) check_axisymmetric(top, grid_known, scene);
  if (grid_known && scene.grid.outflow == OutflowKind::wall) close_faces(top, scene);
  if (grid_known) check_walls(top, scene);  // also those that the scene leaves to us
}

}  // namespace

std::vector<BodyLocation> describe_scene(Keys& top, Scene& scene) {
  for (const KnownKeyword& early : early_keys()) top.stated(early.name);  // done with
  describe_head(top, scene);
  const bool grid_known = describe_grid(top, scene.dimension(), scene.grid);
  describe_time(top, scene.time);
  const bool strain_stated = describe_method(top, scene.method);
  describe_heat(top, grid_known, scene);
  describe_materials(top, scene.materials);
  const std::vector<BodyLocation> locations = describe_bodies(top, scene);
  describe_boundaries(top, grid_known, scene);
  describe_gravity(top, scene.dimension(), scene.gravity);
  describe_loads(top, scene);
  describe_contact(top, strain_stated, scene);
  describe_cracks(top, scene);
  describe_output(top, scene.dimension(), scene.output);
  if (top.reads()) check_scene(top.reader().value(), grid_known, locations, scene);
  top.close();
  return locations;
}

const std::vector<KnownKeyword>& early_keys() {
  static const std::vector<KnownKeyword> kEarly{
      {"variables", "Numbers and quantities by name, for expressions `${…}` anywhere in the scene."},
      {"include", "A scene that this one starts from, or several: paths counted from its folder."},
  };
  return kEarly;
}

const std::map<std::string, Known>& known_values() {
  static const KeyRegistry kKnowledge = [] {
    KeyRegistry knowledge;
    const auto register_key = [&](Scene scene) {
      Keys top(knowledge, "");
      describe_scene(top, scene);
    };
    Scene scene;
    for (const Keyword<Space>& space : kSpaces) {
      scene.space = space.value;
      register_key(scene);
    }
    // Choices on which defaults of other keys depend: those vary.
    knowledge.choose({"contact.normal", "contact.law", "method.update", "method.strain"});
    scene.contact.normal = NormalKind::specified;
    scene.contact.law.acts = Adhesion{};
    scene.method.update = UpdateKind::apic;
    scene.method.strain = StrainKind::first;
    register_key(scene);
    return knowledge;
  }();
  return kKnowledge.found();
}

std::string write_scene(const Scene& scene) {
  Written out;
  Keys top(out);
  Scene copy = scene;  // descriptions serve readers too, and do not know that they only write
  describe_scene(top, copy);
  return layout(out);
}

}  // namespace mpmfast
