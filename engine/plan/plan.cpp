#include "engine/plan/plan.hpp"

#include <algorithm>

#include "engine/plan/materials.hpp"

namespace mpmfast {

namespace {

void plan_method(const MethodSpec& method, Plan& plan) {
  plan.update = method.update == UpdateKind::flip  ? ParticleUpdate::flip
                : method.update == UpdateKind::pic ? ParticleUpdate::pic
                                                   : ParticleUpdate::xpic;
  plan.order = method.update == UpdateKind::xpic ? method.xpic_order : 1;
  plan.position = method.update == UpdateKind::flip            ? PositionUpdate::grid
                  : method.position == PositionKind::grid      ? PositionUpdate::grid
                  : method.position == PositionKind::trapezoid ? PositionUpdate::trapezoid
                                                               : PositionUpdate::particle;
  plan.strain_first = method.strain == StrainKind::first ? 1 : method.strain == StrainKind::last ? 0 : 0.5;
  plan.deformation_terms = method.deformation_terms;
}

/// A field for each body, for each group of bodies, or one for all that are not rigid.
void plan_fields(const Scene& scene, Plan& plan) {
  for (const auto& body : scene.bodies) {
    const bool rigid = is_rigid(scene, body);
    std::string name = body.field.empty() ? body.name : body.field;
    if (!scene.contact.active && !rigid) name = "all";
    const auto known = std::find(plan.fields.begin(), plan.fields.end(), name);
    plan.body_field.push_back(static_cast<int>(known - plan.fields.begin()));
    if (known != plan.fields.end()) continue;
    plan.fields.push_back(name);
    plan.field_rigid.push_back(rigid);
  }
}

void plan_columns(const Scene& scene, Plan& plan) {
  plan.particle_columns = {Quantity::position,         Quantity::velocity, Quantity::deformation_gradient,
                           Quantity::kirchhoff_stress, Quantity::mass,     Quantity::initial_volume,
                           Quantity::wave_speed};
  if (plan.basis == BasisKind::lcpdi) plan.particle_columns.push_back(Quantity::domain_edges);
  for (Quantity q : state_columns(scene.materials)) plan.particle_columns.push_back(q);
  plan.nodal_columns = {Nodal::mass, Nodal::momentum, Nodal::force, Nodal::velocity};
  if (plan.update == ParticleUpdate::xpic)
    for (Nodal q : {Nodal::star, Nodal::next, Nodal::series}) plan.nodal_columns.push_back(q);
  const bool acts = scene.contact.law != LawKind::perfect;
  if (plan.contact && acts && scene.contact.normal == NormalKind::average_gradient) {
    plan.geometry = true;
    plan.nodal_columns.push_back(Nodal::volume_gradient);
  }
  if (plan.contact && acts &&
      (scene.contact.separation == SeparationKind::position_offset ||
       scene.contact.separation == SeparationKind::position_power)) {
    plan.geometry = true;
    plan.nodal_columns.push_back(Nodal::mass_position);
  }
}

void list_passes(const Scene& scene, Plan& plan) {
  auto& p = plan.passes;
  p.push_back("project mass and momentum");
  if (plan.geometry) p.push_back("project volume gradients and positions");
  if (plan.contact) {
    p.push_back("find contact nodes");
    if (scene.contact.law != LawKind::perfect) p.push_back("contact normals and separations");
    p.push_back("first contact correction");
  }
  p.push_back(plan.strain_first > 0 ? "strain, stress and internal force" : "internal force");
  if (plan.gravity) p.push_back("body force");
  p.push_back("momentum update with reactions");
  if (plan.contact) p.push_back("second contact correction");
  if (plan.order > 1)
    p.push_back("XPIC: " + std::to_string(plan.order - 1) +
                (plan.paired ? " passes over v* and dv*" : " passes over v*"));
  p.push_back(plan.strain_first < 1 ? "particle update, strain and stress" : "particle update");
}

}  // namespace

Plan make_plan(const Scene& scene) {
  Plan plan;
  plan.dimension = scene.dimension();
  plan.basis = scene.method.basis;
  plan_method(scene.method, plan);
  plan_fields(scene, plan);
  // Rigid bodies move the others even where these share one field.
  plan.contact = plan.fields.size() > 1 && scene.contact.law != LawKind::ignore;
  plan.paired = plan.contact && plan.order > 1 && scene.method.contact_correction;
  plan.first_correction_stays = plan.update == ParticleUpdate::pic ||
                                (plan.update == ParticleUpdate::xpic && !scene.method.contact_correction);
  for (double g : scene.gravity.acceleration) plan.gravity |= g != 0;
  plan_columns(scene, plan);
  list_passes(scene, plan);
  return plan;
}

}  // namespace mpmfast
