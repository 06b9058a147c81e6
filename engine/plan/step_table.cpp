#include "engine/plan/step_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace mpmfast {

namespace {

std::string when(bool needed, const char* text) { return needed ? text : ""; }

bool has_conditions(const Scene& scene) { return !scene.boundaries.empty(); }
bool has_rigid(const Plan& plan) {
  return std::find(plan.field_rigid.begin(), plan.field_rigid.end(), true) != plan.field_rigid.end();
}
bool has_cracks(const Scene& scene) { return !scene.cracks.empty(); }
/// Is v before the forces filtered, and not each field's own?
bool filters_start(const Plan& plan) { return plan.order > 1 && !plan.full_mass && !plan.own_filter; }

/// What nodal columns beside masses and momenta are for.
std::string geometry_said(const Plan& plan) {
  const auto has = [&](Nodal q) {
    return std::find(plan.nodal_columns.begin(), plan.nodal_columns.end(), q) != plan.nodal_columns.end();
  };
  std::string what;
  for (const auto& [quantity, name] : {std::pair{Nodal::volume, "volumes"},
                                       {Nodal::volume_gradient, "volume gradients"},
                                       {Nodal::mass_position, "mean positions"},
                                       {Nodal::mass_displacement, "mean displacements"},
                                       {Nodal::mass_slope, "displacements with their slopes"}})
    if (has(quantity)) what += (what.empty() ? "project " : ", ") + std::string(name);
  return what;
}

std::string start_velocities_said(const Scene& scene, const Plan& plan) {
  if (plan.strain_first == 0 && !filters_start(plan)) return "";
  return std::string("velocities for ") + (plan.strain_first > 0 ? "the strain" : "XPIC") +
         (has_conditions(scene) ? ", with the boundaries' imposed" : "");
}

std::string filter_said(const Plan& plan) {
  if (plan.order < 2) return "";
  return (plan.full_mass ? "FMPM: " : "XPIC: ") + std::to_string(plan.order - 1) +
         (plan.order > 2 ? " passes" : " pass") + (plan.paired ? " over v* and dv*" : " over v*") +
         (plan.filter_every > 1 ? ", every " + std::to_string(plan.filter_every) + " steps" : "");
}

std::string heat_said(const Plan& plan) {
  if (!plan.heat) return "";
  return std::string("heat: temperatures to the nodes, conduction") +
         (plan.contact ? ", surfaces that touch" : "") + ", back to the particles";
}

std::string loads_said(const Scene& scene, const Plan& plan) {
  std::string what = when(plan.gravity, "body force");
  for (const LoadSpec& load : scene.loads) {
    const char* const said = std::visit([](const auto& spec) { return spec.kDescription; }, load);
    if (what.find(said) == std::string::npos) what += (what.empty() ? "" : ", ") + std::string(said);
  }
  return what;
}

using S = const Scene&;
using P = const Plan&;

const std::array<TaskRow, kTasks> kTable{{
    {Task::start_rigid, "start_rigid", Timer::conditions,
     "rigid bodies carry their mean velocity of the step", "", "RigidBodies::begin", false,
     [](S, P plan) { return when(has_rigid(plan), "rigid bodies carry their velocity of the step"); }},
    {Task::split, "split", Timer::sort, "particles with domains that are too long are split", "",
     "Step::split_if_due", true,
     [](S, P plan) {
       return when(plan.split_edge > 0,
                   "split particles whose domains have become too long, looked for every eighth of a cell");
     }},
    {Task::sort, "sort", Timer::sort, "particles are sorted by row of tiles, field, tile, body and cell", "",
     "Step::sort_if_due", true,
     [](S, P) { return std::string("sort, when a particle has moved by half a cell"); }},
    {Task::find_crack_sides, "look_at_cracks", Timer::contact_nodes,
     "which side of a crack a particle sees nodes on", "", "Step::find_crack_sides", true,
     [](S scene, P) {
       return when(has_cracks(scene), "sides of cracks, when particles or cracks have moved");
     }},
    {Task::project, "project", Timer::project, "mass and momentum to the nodes", "N20 Eq. 5", "Step::project",
     false,
     [](S, P plan) {
       return std::string(plan.force_with_mass ? "project mass, momentum and internal force"
                                               : "project mass and momentum");
     }},
    {Task::project_geometry, "project_geometry", Timer::project, "what laws and normals ask for beside them",
     "", "Step::project", false, [](S, P plan) { return plan.geometry ? geometry_said(plan) : ""; }},
    {Task::press_surfaces, "press_surfaces", Timer::surfaces,
     "points of surfaces below facets of others, and forces", "K24 §3.5, 3.6", "Step::press_surfaces", false,
     [](S, P plan) {
       return when(plan.penalty, "contact of surfaces: which points lie below which facets, and forces");
     }},
    {Task::follow, "follow", Timer::extension,
     "of extended splines, what is on nodes that follow others goes to these", "K24 Eq. 25", "Step::extend",
     false,
     [](S, P plan) {
       return when(plan.occupation > 0, "nodes with too little material near, which follow others");
     }},
    {Task::push_surfaces, "push_surfaces", Timer::surfaces, "forces of surfaces to the nodes", "K24 §3.6",
     "Step::push_surfaces", false,
     [](S, P plan) { return when(plan.penalty, "forces of surfaces to the nodes"); }},
    {Task::set_rigid_nodes, "set_rigid_nodes", Timer::conditions, "nodes of rigid bodies have their velocity",
     "", "RigidBodies::set_nodes", false,
     [](S, P plan) { return when(has_rigid(plan), "velocities of rigid bodies at nodes"); }},
    {Task::prepare_conditions, "prepare_conditions", Timer::conditions, "velocity conditions of this step",
     "NN §2.3.2", "Conditions::prepare", false,
     [](S scene, P) { return when(has_conditions(scene), "the boundaries' conditions of this step"); }},
    {Task::contact_nodes, "contact_nodes", Timer::contact_nodes, "nodes where fields meet", "N20 §3.1",
     "Step::find_contact", false, [](S, P plan) { return when(plan.contact, "find contact nodes"); }},
    {Task::contact_geometry, "contact_geometry", Timer::contact_geometry, "normals and separations there",
     "N20 Eq. 24", "Step::find_contact", false,
     [](S, P plan) {
       return when(plan.contact && plan.contact_geometry, "contact normals and separations");
     }},
    {Task::own_velocities, "own_velocities", Timer::nodes, "each field's own $v_i$, for `own_filter`", "",
     "Step::keep_own_velocities", false,
     [](S, P plan) { return when(plan.own_filter, "keep each field's own velocities"); }},
    {Task::first_correction, "first_correction", Timer::contact_resolve, "first contact correction",
     "N20 Eq. 26", "Step::correct_contact", false,
     [](S, P plan) { return when(plan.contact && plan.first_correction, "first contact correction"); }},
    {Task::start_velocities, "start_velocities", Timer::nodes,
     "$v_i = p_i/m_i$, with conditions on the copy that strains", "", "Step::start_velocities", false,
     start_velocities_said},
    {Task::strain_and_force, "strain_and_force", Timer::strain_force,
     "strain (the share that comes first), stress, internal force", "N20 Eq. 28, 29",
     "Step::strain_and_force", false,
     [](S, P plan) {
       return when(!plan.force_with_mass,
                   plan.strain_first > 0 ? "strain, stress and internal force" : "internal force");
     }},
    {Task::loads, "loads", Timer::nodes, "loads: body force, pressure on surfaces", "", "Loads::add_force",
     false, loads_said},
    {Task::react, "react", Timer::conditions, "reactions of the conditions", "NN Eq. 2.7 to 2.11",
     "Conditions::react", false,
     [](S scene, P) { return when(has_conditions(scene), "the boundaries' reactions"); }},
    {Task::momenta, "momenta", Timer::nodes, "momentum update", "N20 Eq. 30", "Step::update_momenta", false,
     [](S, P) { return std::string("momentum update"); }},
    {Task::second_correction, "second_correction", Timer::contact_resolve, "second contact correction",
     "N20 Eq. 31, 33", "Step::correct_contact", false,
     [](S, P plan) { return when(plan.contact, "second contact correction"); }},
    {Task::enforce, "enforce", Timer::conditions, "conditions again, momentum and force together", "",
     "Conditions::enforce", false,
     [](S scene, P) { return when(has_conditions(scene), "boundaries' velocities imposed"); }},
    {Task::end_velocities, "end_velocities", Timer::nodes, "$v_i^+$ and $a_i \\Delta t$", "",
     "Step::end_velocities", false, [](S, P) { return std::string("velocities and accelerations"); }},
    {Task::filter, "filter", Timer::xpic, "filter of XPIC and FMPM", "N20 Eq. 42 to 44",
     "Step::filter_velocities", true, [](S, P plan) { return filter_said(plan); }},
    {Task::re_extrapolate, "re_extrapolate", Timer::re_extrapolate,
     "new momenta of the particles to the nodes", "NN §2.8", "Step::re_extrapolate", false,
     [](S, P plan) { return when(plan.re_extrapolate, "re-extrapolate new momenta"); }},
    {Task::third_correction, "third_correction", Timer::contact_resolve, "contact of these", "NN §2.8",
     "Step::correct_contact", false,
     [](S, P plan) {
       return when(plan.re_extrapolate && plan.contact, "contact of the re-extrapolated momenta");
     }},
    {Task::impose, "impose", Timer::conditions, "conditions on these", "", "Conditions::impose_velocity",
     false,
     [](S scene, P plan) {
       return when(plan.re_extrapolate && has_conditions(scene), "boundaries' velocities imposed on them");
     }},
    {Task::heat, "heat", Timer::heat, "temperatures: conduction, faces, surfaces that touch", "",
     "Heat::advance", false, [](S, P plan) { return heat_said(plan); }},
    {Task::moving_velocities, "moving_velocities", Timer::nodes, "velocities that move the particles", "",
     "Step::find_moving_velocities", false,
     [](S, P plan) {
       return when(plan.moves_as_strained(),
                   "velocities that move the particles: re-extrapolated where nothing presses");
     }},
    {Task::update, "update", Timer::update, "velocities, positions, the strain that comes last, domains",
     "N20 Eq. 32, 35, 38, 41", "Step::update_particles", false,
     [](S, P plan) {
       return std::string(plan.strain_first < 1 ? "particle update, strain and stress" : "particle update");
     }},
    {Task::drift, "drift", Timer::contact_geometry, "how far fields have moved since normals were found", "",
     "Contact::drift_fits", false,
     [](S, P plan) { return when(plan.keeps_fits, "how far fields move under kept normals"); }},
    {Task::move_rigid, "move_rigid", Timer::conditions, "rigid bodies arrive", "", "Step::move_rigid_end",
     false, [](S, P plan) { return when(has_rigid(plan), "rigid bodies move"); }},
    {Task::move_cracks, "move_cracks", Timer::contact_nodes, "points of cracks move with the grid", "",
     "Cracks::move", false, [](S scene, P) { return when(has_cracks(scene), "cracks move"); }},
    {Task::leave, "leave", Timer::sort, "particles leave the grid", "", "Step::remove_outflow", true,
     [](S scene, P) {
       return when(scene.grid.outflow == OutflowKind::outflow, "particles beyond the grid are taken out");
     }},
    {Task::record_energies, "book", Timer::nodes, "impulses and energies are recorded", "",
     "Step::record_energies", false, nullptr},
    {Task::grow_cracks, "grow_cracks", Timer::contact_nodes, "cracks grow", "", "Step::grow_cracks", true,
     [](S scene, P) {
       return when(std::any_of(scene.cracks.begin(), scene.cracks.end(),
                               [](const CrackSpec& crack) { return crack.growth.active; }),
                   "cracks grow");
     }},
}};

}  // namespace

const std::array<TaskRow, kTasks>& step_table() { return kTable; }

std::string step_table_page() {
  std::string page = "| | task | equation | function |\n|---|---|---|---|\n";
  int number = 0;
  for (const TaskRow& row : kTable)
    page += fmt::format("| {} | {} | {} | `{}` |\n", ++number, row.sentence, row.equation, row.function);
  return page;
}

}  // namespace mpmfast
