#pragma once

/// @file One time step (theory §2), for either dimension and any basis.

#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "engine/conditions/conditions.hpp"
#include "engine/conditions/rigid_bodies.hpp"
#include "engine/contact/contact.hpp"
#include "engine/contact/penalty/penalty.hpp"
#include "engine/cracks/cracks.hpp"
#include "engine/cracks/tip_load.hpp"
#include "engine/heat/heat.hpp"
#include "engine/loads/loads.hpp"
#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/archive.hpp"
#include "engine/state/outflow.hpp"
#include "engine/state/splitting.hpp"
#include "engine/state/state.hpp"
#include "engine/step/clock.hpp"
#include "engine/step/extension.hpp"
#include "engine/step/passes.hpp"

namespace mpmfast {

/// What a run adds up over its steps.
template <int Dim>
struct Sums {
  double friction_work{}, boundary_work{}, body_force_work{};  ///< J
  std::vector<Vec<Dim>> boundary_impulse;                      ///< N s, as Scene::boundaries
  std::vector<Vec<Dim>> rigid_impulse;                         ///< N s, by velocity field
  std::vector<Vec<3>> rigid_moment;                            ///< N m s about the pivot, likewise
  std::vector<Vec<Dim>> pair_impulse;      ///< N s, on the first of the two; as ContactSpec::pairs
  std::vector<double> pair_friction_work;  ///< J, likewise
  Outflow outflow;
  double interface_loss{};  ///< J, of bonds that soften and break
};

template <int Dim>
class Step {
 public:
  /// Seeds the scene. Throws SceneError.
  explicit Step(const Scene& scene);
  explicit Step(Scene&&) = delete;  ///< the scene must outlive the step

  /// The stable time step now: C Δx / max(c + |v|), s.
  double stable_dt() const;

  /// The next step towards the time `end`: the stable one, but two even ones rather than a last sliver, s.
  /// Throws the RunFailure of a time step that collapsed.
  /// @param first  the time step that the run began with
  double dt_towards(double end, double first) const;

  /// Advances the state by dt. Throws RunFailure.
  /// @param stresses  false: stresses that the next step takes anew may stay behind F (find_stresses)
  void advance(double dt, bool stresses = true);

  /// Brings the stresses up to F, where advance left them behind: for whoever reads them between two steps.
  void find_stresses();

  /// Adds to one component of the particles' velocities, m/s, in the order of the columns; the energy that
  /// this brings is recorded as work of loads.
  void add_velocity(int axis, std::span<const double> change);

  /// Throws the RunFailure of a time step that collapsed to dt: who holds it, and why.
  /// @param share  of the first time step
  [[noreturn]] void fail_collapsed(double dt, double share) const;

  /// Where particle p is: its position, or the cell that it was last sorted to where that is no number.
  Vec<Dim> position_of(std::size_t p) const;

  State<Dim>& state() { return state_; }
  const State<Dim>& state() const { return state_; }
  const Plan& plan() const { return plan_; }
  const Sums<Dim>& sums() const { return sums_; }
  Sums<Dim>& sums() { return sums_; }
  const StepClock& clock() const { return clock_; }
  const ContactCounters& contact_counters() const { return contact_.list().counters; }
  const Penalty<Dim>& penalty() const { return penalty_; }
  const Extension<Dim>& extension() const { return extension_; }
  const Heat<Dim>& heat() const { return heat_; }
  /// Contact nodes, normals and separations of the last step.
  const ContactList<Dim>& contact_list() const { return contact_.list(); }
  /// Of contact lists and clouds now, and of the workspaces of threads.
  std::size_t contact_bytes() const { return contact_.bytes(); }
  std::size_t workspace_bytes() const { return passes_->workspace_bytes(state_.threads); }
  const Cracks<Dim>& cracks() const { return cracks_; }
  /// What drives a crack at one of its ends, after a step. The stresses must be those of the moment.
  TipLoad tip_load(int crack, bool end);
  std::uint64_t nodes_peak() const { return nodes_peak_; }
  const SplitCounters& splits() const { return splits_; }
  /// Of the particles, and of the springs of penalty contact, J.
  double stored_energy();
  /// Of it, what springs and bonds between surfaces hold, J.
  double interface_energy() const { return contact_.ledger().stored; }
  double dissipated_energy();  ///< plastic work and viscous heat so far, J

  /// The state that persists from step to step: filled from an archive, a step of the same scene goes on to
  /// the bit as the one that was written. Throws what the archive throws.
  void visit(Archive& archive);

 private:
  /// The fastest speed, m/s: of waves in particles and of prescribed motion.
  double fastest() const;
  /// Below a thousand particles a thread, waiting for each other costs more than the work.
  void choose_threads();
  void count_path(double way) { travelled_ += way, unchecked_path_ += way; }
  const State<Dim>& seeded(const Scene& scene);
  void advance_in_parallel(double dt, bool stresses);
  void split_if_due();
  void sort_if_due();
  void sort();
  void find_crack_sides(bool sorted);
  void number_slots();
  void lead_displacements(double dt);
  void project();
  bool project_masses(bool cracked);
  void start_rigid(double dt);
  void set_rigid_nodes();
  void prepare_conditions(double dt);
  void react(double dt);
  void enforce(double dt);
  void drift(double dt);
  void move_cracks(double dt);
  void press_surfaces(double dt);
  void push_surfaces(double dt);
  void find_velocities(Nodal to);
  void extend();
  void restrict_columns(std::initializer_list<Nodal> quantities);
  void prolong(std::initializer_list<Nodal> quantities);
  void find_contact();
  void correct_contact_first(double dt);
  void correct_contact_second();
  void correct_contact_re_extrapolated();
  void keep_own_velocities();
  void start_velocities();
  void strain_and_force(double dt);
  std::size_t field_of_slot(std::int64_t slot) const;
  bool is_rigid_slot(std::int64_t slot) const { return state_.field_rigid[field_of_slot(slot)]; }
  void add_loads(double dt);
  void update_momenta(double dt);
  void end_velocities(double dt);
  /// Do XPIC and FMPM filter in this step? Between, particles are updated as FLIP's.
  bool filters() const { return (state_.step + 1) % plan_.filter_every == 0; }
  ParticleUpdate update_rule() const { return filters() ? plan_.update : ParticleUpdate::flip; }
  double wall_share() const { return update_rule() == ParticleUpdate::flip ? plan_.wall_share : 1; }
  void find_work_of_loads(double dt);
  void filter_velocities(double dt);
  void filter_full_mass(double dt);
  void re_extrapolate();
  void impose_on_re_extrapolated();
  void conduct_heat(double dt);
  void find_moving_velocities();
  void update_particles(double dt);
  void move_rigid_end(double dt);
  void grow_cracks();
  void remove_outflow();
  void record_energies(double dt);
  void record_contact(const ContactLedger<Dim>& ledger);
  /// Throws the RunFailure of the particle that is to blame. @param otherwise  the cause if none is found
  [[noreturn]] void fail(const char* otherwise) const;
  [[noreturn]] void fail_warmed() const;
  [[noreturn]] void fail_folded(const Fold& fold) const;
  [[noreturn]] void fail_at(std::size_t particle, const std::string& cause) const;

  const Scene* scene_;
  Plan plan_;
  State<Dim> state_;
  std::unique_ptr<Passes<Dim>> passes_;
  Extension<Dim> extension_;
  Conditions<Dim> conditions_;
  Cracks<Dim> cracks_;
  Contact<Dim> contact_;
  RigidBodies<Dim> rigid_;
  Penalty<Dim> penalty_;
  Heat<Dim> heat_;
  Loads<Dim> loads_;
  Sums<Dim> sums_;
  StepClock clock_;
  Vec<Dim> lower_, upper_;  ///< box that particles must stay in, m
  TipSamples tip_samples_;
  double dt_{};                ///< of the last step, s
  double fastest_{};           ///< max_p (c_p + |v_p|), m/s
  double travelled_ = 0;       ///< bound on paths since the last sort, or since all were near their places, m
  double unchecked_path_ = 0;  ///< likewise since domains were looked at, m (split_if_due)
  std::vector<int> kept_slots_;            ///< whose v⁺ moves particles, in this step; −1: none
  std::vector<Vec<Dim>> kept_velocities_;  ///< theirs, m/s
  bool sort_due_ = true;
  bool stresses_wait_ = false;  ///< some stresses are of an earlier F
  bool lost_ = false;           ///< in this step a particle left the box, or is not a number
  std::uint64_t nodes_peak_ = 0;
  SplitCounters splits_;
};

extern template class Step<2>;
extern template class Step<3>;

}  // namespace mpmfast
