#include "engine/plan/plan.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "engine/constants.hpp"
#include "engine/plan/contact_law.hpp"
#include "engine/plan/materials.hpp"
#include "engine/plan/step_table.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

namespace {

void plan_method(const MethodSpec& method, Plan& plan) {
  if (method.extended) plan.occupation = method.occupation;
  plan.update = method.update == UpdateKind::flip   ? ParticleUpdate::flip
                : method.update == UpdateKind::pic  ? ParticleUpdate::pic
                : method.update == UpdateKind::apic ? ParticleUpdate::apic
                                                    : ParticleUpdate::xpic;
  plan.full_mass = method.update == UpdateKind::fmpm;  // gathered as XPIC is
  plan.order = plan.update == ParticleUpdate::xpic ? method.xpic_order : 1;
  if (plan.order > 1) plan.filter_every = static_cast<std::uint64_t>(method.filter_every);
  plan.position = method.position == PositionKind::grid_end    ? PositionUpdate::grid_end
                  : method.position == PositionKind::grid      ? PositionUpdate::grid
                  : method.position == PositionKind::trapezoid ? PositionUpdate::trapezoid
                                                               : PositionUpdate::particle;
  plan.re_extrapolate = method.strain == StrainKind::last_re_extrapolated ||
                        method.strain == StrainKind::average_re_extrapolated;
  // The strains that come last from v⁺ lose the same with any share: what they lose is their own.
  if (plan.re_extrapolate) plan.wall_share = constants::plan::kWallShare;
  plan.strain_first = method.strain == StrainKind::first ? 1
                      : method.strain == StrainKind::last || method.strain == StrainKind::last_re_extrapolated
                          ? 0
                          : 0.5;
  plan.force_with_mass = plan.strain_first == 0 && plan.update != ParticleUpdate::apic &&
                         plan.plane_kind != PlaneKind::axisymmetric;
  static_assert(kAllTerms == MethodSpec::kAllTerms && kInverse == MethodSpec::kInverse);
  plan.deformation_terms = method.deformation_terms;
}

/// The grains of a law that parts them leave each other: a longer domain says nothing about the material
/// there, and that of a lone grain grows without end.
void plan_splitting(const Scene& scene, Plan& plan) {
  if (!scene.method.split || !facts(plan.basis).convected) return;
  plan.split_edge = scene.method.split_edge;
  for (const BodySpec& body : scene.bodies)
    plan.body_splits.push_back(!is_rigid(scene, body) && !parts(scene, body));
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

/// Fields for the sides of what is cracked, behind all others.
void plan_sides(const Scene& scene, Plan& plan) {
  const std::size_t bodies = plan.fields.size();
  plan.first_side.assign(bodies, -1);
  plan.sides.assign(bodies, 0);
  std::vector<int> cracks(bodies, 0);
  for (const CrackSpec& crack : scene.cracks)
    ++cracks[static_cast<std::size_t>(plan.body_field[static_cast<std::size_t>(crack.body)])];
  for (std::size_t f = 0; f < bodies; ++f) {
    if (cracks[f] == 0) continue;
    plan.first_side[f] = static_cast<int>(plan.fields.size());
    plan.sides[f] = cracks[f] > 1 ? 3 : 1;
    for (int side = 1; side <= plan.sides[f]; ++side) {
      plan.fields.push_back(plan.fields[f]);
      plan.field_rigid.push_back(false);
      plan.field_acceleration.push_back(plan.field_acceleration[f]);
      if (!plan.pairs.empty()) plan.pairs.group.push_back(plan.pairs.group[f]);
    }
  }
}

void need_column(Nodal q, Plan& plan) {
  plan.geometry = true;
  auto& columns = plan.nodal_columns;
  if (std::find(columns.begin(), columns.end(), q) == columns.end()) columns.push_back(q);
}

/// What normals, separations and screening take from the grid.
void plan_contact_columns(const ContactSpec& contact, Plan& plan) {
  const auto need = [&](Nodal q) { need_column(q, plan); };
  const bool gradients =
      contact.normal == NormalKind::average_gradient || contact.normal == NormalKind::max_gradient ||
      contact.normal == NormalKind::max_volume || contact.normal == NormalKind::own_gradient;
  if (gradients || contact.rigid_bias > 0) need(Nodal::volume_gradient);
  if (contact.normal == NormalKind::max_volume || contact.volume_screen > 0) need(Nodal::volume);
  switch (contact.separation) {
    case SeparationKind::position_offset:
    case SeparationKind::position_power:
    case SeparationKind::position_piecewise:
      need(Nodal::mass_position);
      break;
    case SeparationKind::displacement:
      need(Nodal::mass_displacement);
      plan.particle_columns.push_back(Quantity::reference_position);
      break;
    default:
      break;
  }
}

/// Contact areas for the laws that ask for one; nodal volumes also where the lump of several fields takes the
/// law of the largest.
void plan_areas(const Scene& scene, Plan& plan) {
  if (!plan.contact) return;
  const auto need = [&](Nodal q) { need_column(q, plan); };
  if (any_law(scene, [](const auto& law) { return law.uses_area; }))
    need(scene.contact.area == AreaKind::nodal_volume ? Nodal::volume : Nodal::volume_gradient);
  if (!plan.pairs.empty() && plan.fields.size() > 2) need(Nodal::volume);
  if (!plan.displacements) return;
  if (plan.interface_springs) need(Nodal::volume_gradient);
  need(Nodal::mass_offset);
  need(Nodal::mass_slope);
  if (scene.contact.separation != SeparationKind::displacement)
    plan.particle_columns.push_back(Quantity::reference_position);
}

/// Temperatures, and the areas of what heat crosses.
void plan_heat(const Scene& scene, Plan& plan) {
  auto& columns = plan.particle_columns;
  if (std::find(columns.begin(), columns.end(), Quantity::temperature) == columns.end())
    columns.push_back(Quantity::temperature);
  columns.push_back(Quantity::temperature_slope);
  if (std::any_of(scene.materials.begin(), scene.materials.end(),
                  [](const MaterialSpec& material) { return material.expansion != 0; }))
    columns.push_back(Quantity::thermal_stretch);
  for (Nodal q :
       {Nodal::heat_capacity, Nodal::heat_content, Nodal::heat_slope, Nodal::temperature, Nodal::heat_flow})
    plan.nodal_columns.push_back(q);
  if (scene.heat.filter_order > 0)
    for (Nodal q : {Nodal::temperature_filter, Nodal::temperature_series}) plan.nodal_columns.push_back(q);
  const auto& conditions = scene.heat.conditions;
  const auto any = [&](bool held) {
    return std::any_of(conditions.begin(), conditions.end(), [&](const HeatConditionSpec& condition) {
      return (condition.kind == HeatConditionSpec::Kind::temperature) == held && (condition.face || !held);
    });
  };
  const bool fed = any(false);
  if (any(true)) plan.nodal_columns.push_back(Nodal::conducting_surface);
  const auto conducts = [](const SurfaceLaw& law) {
    return law.conductance.touching > 0 || law.conductance.gap > 0;
  };
  const bool crossed = plan.contact && plan.contact_geometry && scene.contact.any(conducts);
  if (fed || crossed) need_column(Nodal::volume_gradient, plan);
  if (plan.contact) need_column(Nodal::volume, plan);  // which of several fields a lump stands for
}

/// The columns that loads read.
void plan_loads(const Scene& scene, Plan& plan) {
  for (const LoadSpec& load : scene.loads) {
    const LoadNeeds needs = std::visit([](const auto& spec) { return spec.needs(); }, load);
    if (needs.surface) need_column(Nodal::volume_gradient, plan);
    if (!needs.displacement) continue;
    need_column(Nodal::mass_displacement, plan);
    auto& columns = plan.particle_columns;
    if (std::find(columns.begin(), columns.end(), Quantity::reference_position) == columns.end())
      columns.push_back(Quantity::reference_position);
  }
}

void plan_columns(const Scene& scene, Plan& plan) {
  plan.particle_columns = {Quantity::position,         Quantity::velocity, Quantity::deformation_gradient,
                           Quantity::kirchhoff_stress, Quantity::mass,     Quantity::initial_volume,
                           Quantity::wave_speed};
  if (facts(plan.basis).convected) plan.particle_columns.push_back(Quantity::domain_edges);
  if (plan.split_edge > 0) plan.particle_columns.push_back(Quantity::domain_share);
  if (plan.update == ParticleUpdate::apic) plan.particle_columns.push_back(Quantity::velocity_slopes);
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(),
                  [](const BodySpec& body) { return body.seeding.turned(); }))
    plan.particle_columns.push_back(Quantity::initial_deformation);
  for (Quantity q : state_columns(scene.materials)) plan.particle_columns.push_back(q);
  if (plan.plane_kind != PlaneKind::plane_strain)
    plan.particle_columns.push_back(Quantity::out_of_plane_stretch);
  plan.nodal_columns = {Nodal::mass, Nodal::momentum, Nodal::force, Nodal::velocity};
  if (plan.update == ParticleUpdate::xpic)
    for (Nodal q : {Nodal::star, Nodal::next, Nodal::series}) plan.nodal_columns.push_back(q);
  if (plan.occupation > 0) plan.nodal_columns.push_back(Nodal::occupied);
  if (plan.re_extrapolate) plan.nodal_columns.push_back(Nodal::re_extrapolated);
  if (plan.moves_as_strained()) plan.nodal_columns.push_back(Nodal::compression_weight);
  if (plan.contact && plan.contact_geometry) plan_contact_columns(scene.contact, plan);
  plan_areas(scene, plan);
  if (plan.heat) plan_heat(scene, plan);
  plan_loads(scene, plan);
}

}  // namespace

Plan make_plan(const Scene& scene) {
  Plan plan;
  plan.dimension = scene.dimension();
  plan.plane_kind = scene.space == Space::plane_stress   ? PlaneKind::plane_stress
                    : scene.space == Space::axisymmetric ? PlaneKind::axisymmetric
                                                         : PlaneKind::plane_strain;
  plan.basis = scene.method.basis;
  plan.heat = scene.heat.active;
  plan_method(scene.method, plan);
  plan_splitting(scene, plan);
  plan_fields(scene, plan);
  // Rigid bodies move the others even where these share one field.
  const auto acts = [](const auto& law) { return law.scope != LawScope::nowhere; };
  const auto ties = [](const auto& law) { return law.scope == LawScope::everywhere; };
  const auto touches = [&](const auto& law) { return acts(law) && !ties(law); };
  const bool meets = plan.fields.size() > 1 && any_law(scene, acts), cracked = !scene.cracks.empty();
  plan.penalty = meets && scene.contact.family == ContactFamily::penalty;
  plan.contact = (meets && !plan.penalty) || cracked;
  plan.surface = meets && scene.contact.family == ContactFamily::surface;
  plan.contact_geometry = any_law(scene, touches);
  plan.keeps_fits = plan.contact && plan.contact_geometry && scene.contact.refit > 0;
  const auto interface_springs = [](const auto& law) { return law.scope == LawScope::interface; };
  plan.interface_springs = plan.contact && any_law(scene, interface_springs);
  plan.cracks_alone = cracked && plan.first_side.size() == 1;
  plan.displacements = plan.interface_springs || (cracked && plan.contact_geometry);
  plan.exact_fields = plan.interface_springs || any_law(scene, ties);
  plan.first_correction = scene.contact.corrections == 2;
  plan.one_set = plan.re_extrapolate && scene.contact.decides_once();
  plan.paired = plan.contact && plan.order > 1 && !plan.full_mass && scene.method.contact_correction &&
                !scene.method.own_filter && plan.first_correction;
  plan.own_filter = scene.method.own_filter && plan.order > 1 && !plan.full_mass;
  if (meets) plan.pairs = make_pair_table(scene, plan.body_field, static_cast<int>(plan.fields.size()));
  if (plan.update == ParticleUpdate::flip || plan.filter_every > 1)
    plan.first_share = scene.contact.first_correction_share;
  plan.first_correction_stays =
      plan.update == ParticleUpdate::pic || plan.update == ParticleUpdate::apic ||
      (plan.update == ParticleUpdate::xpic &&
       (plan.full_mass || (!scene.method.contact_correction && !scene.method.own_filter)));
  plan.field_acceleration.assign(plan.fields.size(), Vec3{});
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    for (std::size_t d = 0; d < 3 && !is_rigid(scene, scene.bodies[b]); ++d) {
      const double a = scene.gravity.acceleration[d] + scene.bodies[b].acceleration[d];
      plan.field_acceleration[static_cast<std::size_t>(plan.body_field[b])][d] = a;
      plan.gravity |= a != 0;
    }
  plan_sides(scene, plan);
  plan_columns(scene, plan);
  for (const TaskRow& row : step_table())
    if (std::string said = row.said ? row.said(scene, plan) : ""; !said.empty())
      plan.passes.push_back(std::move(said));
  return plan;
}

}  // namespace mpmfast
