#include "engine/step/step.hpp"

#include <omp.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/constants.hpp"
#include "engine/plan/memory.hpp"
#include "engine/plan/seed.hpp"
#include "engine/state/slots.hpp"
#include "engine/state/thread_team.hpp"
#include "engine/step/crowding.hpp"

namespace mpmfast {

template <int Dim>
Step<Dim>::Step(const Scene& scene)
    : scene_(&scene),
      plan_(make_plan(scene)),
      passes_(make_passes<Dim>(scene.method.basis)),
      extension_(scene, plan_),
      conditions_(scene),
      cracks_(scene, plan_),
      contact_(scene, plan_, cracks_),
      rigid_(scene, plan_, seeded(scene)),
      penalty_(scene, plan_, state_),
      heat_(scene, plan_),
      loads_(scene, plan_) {
  choose_threads();
  passes_->shape_domains(state_);
  state_.nodes.plan(plan_.nodal_columns, plan_.paired);
  sums_.boundary_impulse.assign(scene.boundaries.size(), Vec<Dim>::Zero());
  sums_.rigid_impulse.assign(plan_.fields.size(), Vec<Dim>::Zero());
  sums_.rigid_moment.assign(plan_.fields.size(), Vec<3>::Zero());
  sums_.pair_impulse.assign(scene.contact.pairs.size(), Vec<Dim>::Zero());
  sums_.pair_friction_work.assign(scene.contact.pairs.size(), 0);
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    lower_[d] = scene.grid.origin[k] - scene.grid.cell;
    upper_[d] = scene.grid.origin[k] + scene.grid.size[k] + scene.grid.cell;
  }
  if (plan_.plane_kind == PlaneKind::axisymmetric)
    lower_[0] = std::max(lower_[0], 0.0);  // nothing crosses the axis
  for (std::size_t p = 0; p < state_.particles.size(); ++p)
    fastest_ = std::max(fastest_, state_.particles.column(Quantity::wave_speed)[p] +
                                      state_.particles.vector(Quantity::velocity, p).norm());
}

template <int Dim>
void Step<Dim>::choose_threads() {
  state_.threads =
      std::clamp(static_cast<int>(state_.particles.size() / constants::threads::kParticlesPerThread), 1,
                 omp_get_max_threads());
}

template <int Dim>
const State<Dim>& Step<Dim>::seeded(const Scene& scene) {
  const MemoryLimit available = available_memory();
  check_memory(scene, plan_, available);
  seed(scene, plan_, state_);
  check_crowding(scene, state_, plan_.fields.size(), available);
  return state_;
}

template <int Dim>
double Step<Dim>::fastest() const {
  double fastest = std::max({fastest_, conditions_.fastest(), rigid_.fastest()});
  for (const auto& body : scene_->bodies) {
    double squared = 0;
    for (std::size_t d = 0; d < Dim; ++d) squared += body.velocity[d] * body.velocity[d];
    fastest = std::max(fastest, std::sqrt(squared));
  }
  return fastest;
}

template <int Dim>
double Step<Dim>::stable_dt() const {
  const double share = std::min(scene_->time.cfl, penalty_.courant_limit());
  const double stable = std::min(scene_->time.max_step, share * scene_->grid.cell / fastest());
  return heat_.active() ? std::min(stable, heat_.stable_dt()) : stable;
}

template <int Dim>
double Step<Dim>::dt_towards(double end, double first) const {
  const double stable = stable_dt(), left = end - state_.time;
  const double dt = left <= stable ? left : left < 2 * stable ? 0.5 * left : stable;
  if (!(stable >= scene_->time.collapse * first) || (!(dt > constants::step::kLeastStep * end) && dt < left))
    fail_collapsed(stable, first > 0 ? stable / first : 1);
  return dt;
}

template <int Dim>
void Step<Dim>::add_velocity(int axis, std::span<const double> change) {
  auto& particles = state_.particles;
  double* v = particles.column(Quantity::velocity, axis);
  const double* mass = particles.column(Quantity::mass);
  for (std::size_t p = 0; p < change.size(); ++p) {
    sums_.body_force_work += mass[p] * change[p] * (v[p] + 0.5 * change[p]);
    v[p] += change[p];
    fastest_ = std::max(
        fastest_, particles.column(Quantity::wave_speed)[p] + particles.vector(Quantity::velocity, p).norm());
  }
}

template <int Dim>
void Step<Dim>::advance(double dt, bool stresses) {
  if (plan_.split_edge > 0) choose_threads();
  ThreadTeam::parallel_region(state_.threads, [&] { advance_in_parallel(dt, stresses); });
}

template <int Dim>
void Step<Dim>::advance_in_parallel(double dt, bool stresses) {
  clock_.begin_step();
  start_rigid(dt);
  if (plan_.displacements && state_.step == 0) lead_displacements(dt);
  split_if_due();
  sort_if_due();
  project();           // N20 Eq. 5
  press_surfaces(dt);  // K24 §3.5, 3.6
  extend();            // K24 §3.3
  push_surfaces(dt);   // tools/manual/theory.md, "Penalty contact"
  if (plan_.force_with_mass) restrict_columns({Nodal::force});
  set_rigid_nodes();
  prepare_conditions(dt);
  find_contact();
  keep_own_velocities();
  correct_contact_first(dt);  // Eq. 26
  start_velocities();
  if (!plan_.force_with_mass) strain_and_force(dt);  // Eq. 28, 29
  add_loads(dt);
  react(dt);
  update_momenta(dt);        // Eq. 30
  correct_contact_second();  // Eq. 31, 33
  enforce(dt);
  end_velocities(dt);
  find_work_of_loads(dt);
  filter_velocities(dt);  // Eq. 42 to 44
  re_extrapolate();       // NN §2.8
  conduct_heat(dt);
  find_moving_velocities();
  update_particles(dt);  // Eq. 32, 35, 38, 41
  drift(dt);
  move_rigid_end(dt);
  move_cracks(dt);
  remove_outflow();
  record_energies(dt);
  state_.time += dt;
  ++state_.step;
  dt_ = dt;
  grow_cracks();
  if (stresses) find_stresses();
}

/// Positions are half a step ahead of strains by the motion of the particles, and so are the jumps that
/// displacements tell (Interfaces::start): as the first step begins, half of it counts as done, or bodies
/// that come from apart begin with springs that nothing loaded.
template <int Dim>
void Step<Dim>::lead_displacements(double dt) {
  auto& particles = state_.particles;
  for (int d = 0; d < Dim; ++d) {
    double* reference = particles.column(Quantity::reference_position, d);
    const double* velocity = particles.column(Quantity::velocity, d);
    for (std::size_t p = 0; p < particles.size(); ++p) reference[p] -= 0.5 * dt * velocity[p];
  }
}

template <int Dim>
void Step<Dim>::start_rigid(double dt) {
  if (rigid_.empty()) return;
  const auto timed = clock_.enter(Task::start_rigid);
  rigid_.begin(state_, dt);
}

template <int Dim>
void Step<Dim>::set_rigid_nodes() {
  if (rigid_.empty()) return;
  const auto timed = clock_.enter(Task::set_rigid_nodes);
  rigid_.set_nodes(state_);
}

template <int Dim>
void Step<Dim>::prepare_conditions(double dt) {
  if (scene_->boundaries.empty()) return;
  const auto timed = clock_.enter(Task::prepare_conditions);
  conditions_.prepare(state_, state_.time, dt);
}

template <int Dim>
void Step<Dim>::react(double dt) {
  if (scene_->boundaries.empty()) return;
  const auto timed = clock_.enter(Task::react);
  conditions_.react(state_, dt, wall_share());
}

template <int Dim>
void Step<Dim>::enforce(double dt) {
  if (scene_->boundaries.empty()) return;
  const auto timed = clock_.enter(Task::enforce);
  conditions_.enforce(state_, dt);
}

template <int Dim>
void Step<Dim>::drift(double dt) {
  if (!plan_.keeps_fits) return;
  const auto timed = clock_.enter(Task::drift);
  contact_.drift_fits(state_, dt);
}

template <int Dim>
void Step<Dim>::move_cracks(double dt) {
  if (!cracks_.active()) return;
  const auto timed = clock_.enter(Task::move_cracks);
  cracks_.move(state_, dt);
}

/// p/m, in `to`.
template <int Dim>
void Step<Dim>::find_velocities(Nodal to) {
  const double* mass = state_.nodes.column(Nodal::mass);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d)
      divide_by_mass(mass, state_.nodes.column(Nodal::momentum, d), 1, begin, end,
                     state_.nodes.column(to, d));
  });
}

/// What `own_filter` filters: the velocities of each field before contact changes them.
template <int Dim>
void Step<Dim>::keep_own_velocities() {
  if (!plan_.own_filter) return;
  const auto timed = clock_.enter(Task::own_velocities);
  find_velocities(Nodal::star);
  prolong({Nodal::star});
}

template <int Dim>
void Step<Dim>::press_surfaces(double dt) {
  if (!penalty_.active()) return;
  const auto timed = clock_.enter(Task::press_surfaces);
  if (const auto fold = penalty_.find_contacts(state_)) fail_folded(*fold);
  penalty_.compute_forces(state_, rigid_.pivots(), dt);
}

/// From here on the nodes that follow others have no mass.
template <int Dim>
void Step<Dim>::extend() {
  if (!extension_.active()) return;
  const auto timed = clock_.enter(Task::follow);
  extension_.find(state_);
  restrict_columns({Nodal::mass, Nodal::momentum});
}

/// The forces of the springs to the grid. With FLIP boundary points begin with the grid's velocity, and what
/// they had beyond it acts on the grid as a force beside.
/// FLIP adds up in each particle's velocity what the grid cannot see of it; where the body does not surround
/// it and it weighs a thousandth, that grows until it moves the body: grains pressed to a third gave the
/// points 20 km/s and the body 5 % of the work.
template <int Dim>
void Step<Dim>::push_surfaces(double dt) {
  if (!penalty_.active()) return;
  const auto timed = clock_.enter(Task::push_surfaces);
  if (update_rule() != ParticleUpdate::flip) {
    if (penalty_.contact_points() > 0) passes_->push(state_, penalty_.forces());
    return;
  }
  find_velocities(Nodal::velocity);
  prolong({Nodal::velocity});
  passes_->settle(state_, penalty_.forces(), dt);
  restrict_columns({Nodal::momentum});
}

/// What particles gave to nodes that follow others goes to these.
template <int Dim>
void Step<Dim>::restrict_columns(std::initializer_list<Nodal> quantities) {
  if (!extension_.active()) return;
  const auto timed = clock_.enter(Task::follow);
  extension_.restrict_columns(state_, quantities);
}

/// What particles will read of nodes that follow others.
template <int Dim>
void Step<Dim>::prolong(std::initializer_list<Nodal> quantities) {
  if (!extension_.active()) return;
  const auto timed = clock_.enter(Task::follow);
  extension_.prolong(state_, quantities);
}

template <int Dim>
void Step<Dim>::find_contact() {
  if (!plan_.contact) return;
  {
    const auto timed = clock_.enter(Task::contact_nodes);
    contact_.find_pairs(state_);
  }
  if (plan_.contact_geometry) {
    const auto timed = clock_.enter(Task::contact_geometry);
    contact_.find_geometry(state_, *passes_);
  }
  contact_.yield_to(state_, conditions_);
}

template <int Dim>
void Step<Dim>::correct_contact_first(double dt) {
  if (!plan_.contact) return;
  contact_.begin_step(rigid_.pivots(), dt, scene_->grid.cell / fastest());
  if (!plan_.first_correction) return;
  const auto timed = clock_.enter(Task::first_correction);
  contact_.correct_first(state_);
}

template <int Dim>
void Step<Dim>::correct_contact_second() {
  if (!plan_.contact) return;
  const auto timed = clock_.enter(Task::second_correction);
  contact_.correct_second(state_);
}

template <int Dim>
void Step<Dim>::correct_contact_re_extrapolated() {
  if (!plan_.contact) return;
  const auto timed = clock_.enter(Task::third_correction);
  contact_.correct_re_extrapolated(state_);
}

/// v = p/m after the first contact correction: for XPIC as it is, for a strain that comes first with
/// conditions imposed on the copy. Without either, nobody reads it.
template <int Dim>
void Step<Dim>::start_velocities() {
  const bool filtered = plan_.order > 1 && !plan_.full_mass && !plan_.own_filter;
  if (plan_.strain_first == 0 && !filtered) return;
  const auto timed = clock_.enter(Task::start_velocities);
  find_velocities(Nodal::velocity);
  if (filtered) find_velocities(Nodal::star);
  conditions_.impose_velocity(state_);
  prolong({Nodal::velocity});
  if (filtered) prolong({Nodal::star});
}

template <int Dim>
void Step<Dim>::strain_and_force(double dt) {
  stresses_wait_ = plan_.strain_first > 0;
  const auto timed = clock_.enter(Task::strain_and_force);
  if (!passes_->strain_and_force(state_, plan_.strain_first * dt, plan_.deformation_terms))
    fail("a volume became zero or negative (J <= 0)");
  restrict_columns({Nodal::force});
}

template <int Dim>
std::size_t Step<Dim>::field_of_slot(std::int64_t slot) const {
  const auto tile = static_cast<std::size_t>(slot / kTileNodes<Dim>);
  return static_cast<std::size_t>(state_.tiling.node_tiles[tile].field);
}

template <int Dim>
void Step<Dim>::add_loads(double dt) {
  if (!loads_.active()) return;
  const auto timed = clock_.enter(Task::loads);
  loads_.add_force(state_, dt);
}

template <int Dim>
void Step<Dim>::find_work_of_loads(double dt) {
  if (loads_.active()) loads_.find_work(state_, dt);
}

template <int Dim>
void Step<Dim>::update_momenta(double dt) {
  const auto timed = clock_.enter(Task::momenta);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      const double* f = state_.nodes.column(Nodal::force, d);
      double* p = state_.nodes.column(Nodal::momentum, d);
      for (std::int64_t i = begin; i < end; ++i) p[i] += f[i] * dt;
    }
  });
}

/// v⁺ = p⁺/m, and a Δt = f Δt/m in place of the force.
template <int Dim>
void Step<Dim>::end_velocities(double dt) {
  const auto timed = clock_.enter(Task::end_velocities);
  const double* mass = state_.nodes.column(Nodal::mass);
  for_each_slot(state_, [&](std::int64_t begin, std::int64_t end) {
    for (int d = 0; d < Dim; ++d) {
      const double* p = state_.nodes.column(Nodal::momentum, d);
      double* v = state_.nodes.column(Nodal::velocity, d);
      double* f = state_.nodes.column(Nodal::force, d);
      divide_by_mass(mass, p, 1, begin, end, v);
      divide_by_mass(mass, f, dt, begin, end, f);
    }
  });
  prolong({Nodal::velocity, Nodal::force});
}

template <int Dim>
void Step<Dim>::conduct_heat(double dt) {
  if (!heat_.active()) return;
  const auto timed = clock_.enter(Task::heat);
  if (!heat_.advance(state_, *passes_, contact_, dt)) fail_warmed();
}

template <int Dim>
void Step<Dim>::update_particles(double dt) {
  const auto timed = clock_.enter(Task::update);
  const bool stresses = plan_.strain_first == 0;  // else the next step makes its own
  const UpdateRule rule{update_rule(),           plan_.position, dt, (1 - plan_.strain_first) * dt,
                        plan_.deformation_terms, stresses};
  const TileReport report = passes_->update(state_, rule, lower_, upper_);
  fastest_ = report.fastest;
  count_path(report.speed * dt);
  cracks_.add_displacement(report.speed * dt);
  if (report.inverted) fail("a volume became zero or negative (J <= 0)");
  lost_ = report.lost;
}

template <int Dim>
void Step<Dim>::move_rigid_end(double dt) {
  if (rigid_.empty()) return;
  const auto timed = clock_.enter(Task::move_rigid);
  const RigidReport report = rigid_.end(state_, dt, lower_, upper_);
  lost_ |= report.lost;
  count_path(report.fastest * dt);
}

template class Step<2>;
template class Step<3>;

}  // namespace mpmfast
