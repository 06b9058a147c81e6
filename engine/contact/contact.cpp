#include "engine/contact/contact.hpp"

#include <algorithm>
#include <limits>

#include "engine/constants.hpp"
#include "engine/contact/geometry/free_directions.hpp"
#include "engine/contact/geometry/kept_fits.hpp"
#include "engine/contact/geometry/normal_fit.hpp"
#include "engine/contact/impulses/corrections.hpp"
#include "engine/contact/interface/extrapolated_jump.hpp"
#include "engine/contact/interface/interfaces.hpp"
#include "engine/contact/ledger/record_contact.hpp"
#include "engine/contact/pairs/find_pairs.hpp"
#include "engine/contact/pairs/pair_memory.hpp"
#include "engine/contact/published/grid_geometry.hpp"
#include "engine/contact/surface/surface_contact.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// The separations of the sides of cracks: the normal parts of their extrapolated displacement jumps.
template <int Dim>
void find_crack_separations(const State<Dim>& state, ContactList<Dim>& list) {
  for_each_pair(list, state.threads, [&](const ContactNode<Dim>& node, int e) {
    const ContactPair& pair = list.pairs.pair[e];
    if (pair.crack < 0) return;
    PairGeometry<Dim>& geometry = list.pairs.geometry[e];
    const NodeFields<Dim> fields(state, list, node);
    geometry.separation = extrapolated_jump(state, fields, node, pair.a, pair.b).dot(geometry.normal);
  });
}

/// Has the node surfaces that only touch?
template <int Dim>
bool has_separable_pair(const ContactList<Dim>& list, const ContactNode<Dim>& node) {
  const auto begin = list.pairs.status.begin();
  return std::any_of(begin + node.pair_begin, begin + node.pair_end,
                     [](const PairStatus& status) { return status.separable; });
}

void visit_counters(Archive& archive, ContactCounters& c) {
  archive.number("contact/nodes_peak", c.nodes_peak);
  archive.number("contact/regressions", c.regressions);
  archive.number("contact/iterations", c.iterations);
  archive.number("contact/fallbacks", c.fallbacks);
  archive.number("contact/unconverged", c.unconverged);
  archive.number("contact/touching_normals", c.touching);
  archive.number("contact/doubtful_normals", c.doubtful);
  archive.number("contact/pair_nodes", c.pair_nodes);
  archive.number("contact/pair_fallbacks", c.pair_fallbacks);
  archive.number("contact/meetings", c.meetings);
  archive.number("contact/screened", c.screened);
}

}  // namespace

/// The classes of the phases, and what the step hands them.
template <int Dim>
struct Contact<Dim>::Phases {
  PairFinder<Dim> finder;
  PairMemory<Dim> memory;
  NormalFit<Dim> fit;
  Interfaces<Dim> interfaces;
  Corrections<Dim> corrections;
  std::unique_ptr<SurfaceContact<Dim>> surface;  ///< null: contact acts on nodes
  FreeDirections<Dim> free;
  StepTimes times{};
  std::vector<Vec<Dim>> pivots;       ///< m, by field
  std::vector<double> friction_sums;  ///< memory of record_friction, J

  Phases(const Scene& scene, const Plan& plan, const PairLaws& laws, const Cracks<Dim>& cracks)
      : finder(scene, laws, cracks),
        memory(scene, plan, laws),
        interfaces(scene, plan, laws, cracks),
        corrections(scene, plan, laws) {
    if (plan.surface) surface = std::make_unique<SurfaceContact<Dim>>(scene, plan, laws);
  }
};

template <int Dim>
Contact<Dim>::Contact(const Scene& scene, const Plan& plan, const Cracks<Dim>& cracks)
    : scene_(scene),
      cracks_(cracks),
      fields_(static_cast<int>(plan.fields.size())),
      has_geometry_(plan.contact_geometry),
      laws_(scene, plan),
      phases_(std::make_unique<Phases>(scene, plan, laws_, cracks)) {}

template <int Dim>
Contact<Dim>::~Contact() = default;

template <int Dim>
void Contact<Dim>::find_pairs(const State<Dim>& state) {
  phases_->finder.find(state, phases_->memory, list_);
}

template <int Dim>
void Contact<Dim>::find_geometry(State<Dim>& state, const ContactBasis<Dim>& basis) {
  if (list_.nodes.empty() || !has_geometry_) return;
  const auto is_crack = [](const ContactPair& pair) { return pair.crack >= 0; };
  if (!std::all_of(list_.pairs.pair.begin(), list_.pairs.pair.end(), is_crack)) {
    find_grid_normals(state, scene_.contact, list_);
    phases_->fit.run(state, scene_.contact, basis, list_,
                     phases_->surface ? &phases_->surface->samples() : nullptr);
    find_grid_separations(state, scene_.contact, list_);
  }
  if (cracks_.active()) find_crack_separations(state, list_);
  phases_->interfaces.find(state, list_);
  if (scene_.contact.detection == DetectionKind::velocity ||
      scene_.contact.separation == SeparationKind::none)
    for (PairGeometry<Dim>& geometry : list_.pairs.geometry)
      geometry.separation = -std::numeric_limits<double>::infinity();
}

template <int Dim>
void Contact<Dim>::yield_to(const State<Dim>& state, const Conditions<Dim>& conditions) {
  phases_->free.conditions = &conditions;
  if (phases_->surface) {
    phases_->surface->find(state, phases_->free, list_);
    for (PairStatus& status : list_.pairs.status) status.separable = true;
    return;
  }
  if (!conditions.empty() && phases_->corrections.method().one_set)
    yield_constrained_directions(phases_->free, state.threads, list_);
}

template <int Dim>
void Contact<Dim>::begin_step(const std::vector<Vec<Dim>>& pivots, double dt, double crossing) {
  phases_->pivots = pivots;
  phases_->times = {dt, crossing};
  ledger_.reset(pivots.size(), laws_.count());
}

template <int Dim>
void Contact<Dim>::correct_first(State<Dim>& state) {
  if (phases_->surface) return phases_->surface->correct_first(state, phases_->times);
  phases_->corrections.correct_first(state, phases_->free, phases_->times, list_);
  if (phases_->corrections.method().first_stays)
    record_impulses(state, laws_, phases_->pivots, list_, Entry::made, ledger_);
}

template <int Dim>
void Contact<Dim>::correct_second(State<Dim>& state) {
  if (phases_->surface)
    return phases_->surface->correct_second(state, phases_->times, phases_->pivots, ledger_);
  phases_->corrections.correct_second(state, phases_->free, phases_->times, phases_->interfaces, list_);
  record_impulses(state, laws_, phases_->pivots, list_, Entry::made, ledger_);
  if (!phases_->corrections.method().one_set) end_step(state);
}

template <int Dim>
void Contact<Dim>::correct_re_extrapolated(State<Dim>& state) {
  if (phases_->surface) return phases_->surface->correct_re_extrapolated(state, phases_->times, ledger_);
  phases_->corrections.correct_re_extrapolated(state, phases_->free, phases_->times, list_);
  if (phases_->corrections.method().one_set) end_step(state);
}

template <int Dim>
bool Contact<Dim>::acts_on_nodes() const {
  return !phases_->surface && !list_.nodes.empty();
}

template <int Dim>
void Contact<Dim>::begin_orders(State<Dim>& state, Nodal momenta) {
  if (!acts_on_nodes()) return;
  record_impulses(state, laws_, phases_->pivots, list_, Entry::taken_back, ledger_);
  phases_->corrections.take_out_impulses(state, momenta, list_);
}

template <int Dim>
void Contact<Dim>::correct_order(State<Dim>& state) {
  if (acts_on_nodes()) phases_->corrections.correct_order(state, phases_->free, phases_->times, list_);
}

template <int Dim>
void Contact<Dim>::end_orders(const State<Dim>& state) {
  if (!acts_on_nodes()) return;
  phases_->corrections.add_friction(state, list_);
  record_impulses(state, laws_, phases_->pivots, list_, Entry::made, ledger_);
}

/// After the last correction: the interfaces and the friction work of the step.
template <int Dim>
void Contact<Dim>::end_step(State<Dim>& state) {
  if (phases_->interfaces.active())
    phases_->interfaces.end(state, phases_->free, phases_->times.dt, list_, ledger_);
  record_friction(state, laws_, phases_->corrections.method(), list_, ledger_, phases_->friction_sums);
}

template <int Dim>
void Contact<Dim>::list_separable_slots(int threads, std::vector<int>& slots) const {
  using constants::threads::kFewNodes;
  slots.assign(list_.fields.size(), -1);  // some fields belong to no listed node
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), threads, kFewNodes, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list_.nodes[k];
    if (!has_separable_pair(list_, node)) return;
    for (int f = node.field_begin; f < node.field_end; ++f)
      slots[static_cast<std::size_t>(f)] = list_.fields[f].slot;
  });
}

template <int Dim>
void Contact<Dim>::average_compression(State<Dim>& state) const {
  using constants::threads::kFewNodes;
  const double* mass = state.nodes.column(Nodal::mass);
  double* weight = state.nodes.column(Nodal::compression_weight);
  for_each_of(static_cast<std::int64_t>(list_.nodes.size()), state.threads, kFewNodes, [&](std::int64_t k) {
    const ContactNode<Dim>& node = list_.nodes[k];
    if (has_separable_pair(list_, node) || has_springs(list_, node)) return;
    double all = 0, part = 0;
    for (int f = node.field_begin; f < node.field_end; ++f) {
      all += mass[list_.fields[f].slot];
      part += weight[list_.fields[f].slot];
    }
    for (int f = node.field_begin; f < node.field_end; ++f)
      weight[list_.fields[f].slot] = part / all * mass[list_.fields[f].slot];
  });
}

template <int Dim>
void Contact<Dim>::renumber_fits(const Tiling<Dim>& tiling) {
  mpmfast::renumber_fits(tiling, list_.pairs.fit);
}

template <int Dim>
void Contact<Dim>::invalidate_fits() {
  list_.pairs.fit.assign(list_.pairs.fit.size(), {});
}

template <int Dim>
void Contact<Dim>::drift_fits(const State<Dim>& state, double dt) {
  if (!list_.pairs.fit.empty()) mpmfast::drift_fits(state, dt, list_);
}

template <int Dim>
void Contact<Dim>::visit(Archive& archive) {
  visit_counters(archive, list_.counters);
  archive.number("contact/stored", ledger_.stored);
  phases_->memory.visit(archive, list_);
  if (phases_->surface) phases_->surface->visit(archive, fields_);
}

template <int Dim>
const ConductanceSpec& Contact<Dim>::conductance_of(const NodeFields<Dim>& fields,
                                                    const ContactNode<Dim>& node,
                                                    const ContactPair& pair) const {
  const int number = laws_.number_of(fields, node, pair);
  const bool by_default = number < 0 || pair.crack >= 0;
  return (by_default ? scene_.contact.law : scene_.contact.pairs[static_cast<std::size_t>(number)].law)
      .conductance;
}

template <int Dim>
std::size_t Contact<Dim>::bytes() const {
  const PairColumns<Dim>& pairs = list_.pairs;
  return bytes_in(list_.nodes, list_.fields, list_.node_at, pairs.pair, pairs.geometry, pairs.before,
                  pairs.status, pairs.impulse, pairs.relative, pairs.spring, pairs.bond, pairs.fit) +
         phases_->memory.bytes() + phases_->finder.bytes() + phases_->fit.bytes() +
         (phases_->surface ? phases_->surface->bytes() : 0);
}

template class Contact<2>;
template class Contact<3>;

}  // namespace mpmfast
