#include "engine/state/splitting.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "engine/constants.hpp"
#include "engine/state/slots.hpp"
#include "kernels/constants.hpp"

namespace mpmfast {

namespace {

constexpr double kLeastShare = 1.0 / (1 << constants::splitting::kMostHalvings);

enum class Edge { good, to_halve, held };

/// Judges edges: of all particles one after another, so their columns are looked up once.
template <int Dim>
class EdgeCheck {
 public:
  EdgeCheck(const State<Dim>& state, const SplitRule& rule) : state_(&state), rule_(&rule) {
    const auto& particles = state.particles;
    for (int e = 0; e < Dim * Dim; ++e) deformation_[e] = particles.column(Quantity::deformation_gradient, e);
    for (int k = 0; k < Dim; ++k) share_[k] = particles.column(Quantity::domain_share, k);
    from_axis_ = particles.column(Quantity::position, 0);
  }

  /// Of direction k. The halves of a ring both lie on its side of the axis, or it stays whole.
  Edge operator()(std::size_t p, int k) const {
    const std::size_t body = state_->particles.body()[p];
    const double length = 2 * state_->bodies[body].half_size[k] * share_[k][p];
    double squared = 0;
    for (int d = 0; d < Dim; ++d) squared += square(deformation_[Dim * d + k][p]);
    if (!(square(length) * squared > square(rule_->longest)) || !rule_->body_splits[body]) return Edge::good;
    const bool small = share_[k][p] <= kLeastShare, sound = squared < constants::kMostSound;
    const bool meets_axis = state_->plane_kind == PlaneKind::axisymmetric &&
                            !(std::abs(length * deformation_[k][p]) < 4 * from_axis_[p]);
    return small || meets_axis || !sound ? Edge::held : Edge::to_halve;
  }

 private:
  static double square(double x) { return x * x; }

  const State<Dim>* state_;
  const SplitRule* rule_;
  const double* deformation_[Dim * Dim];
  const double* share_[Dim];
  const double* from_axis_;  ///< m, in scenes that have one
};

template <int Dim>
void copy_particle(Particles<Dim>& particles, std::size_t from, std::size_t to) {
  for (Quantity q : particles.quantities())
    for (int k = 0; k < Particles<Dim>::components(q); ++k)
      particles.column(q, k)[to] = particles.column(q, k)[from];
  particles.body()[to] = particles.body()[from];
}

template <int Dim>
void move_by(Particles<Dim>& particles, Quantity q, std::size_t p, const Vec<Dim>& offset) {
  for (int d = 0; d < Dim; ++d) particles.column(q, d)[p] += offset[d];
}

/// Half the half-edge vector that the domain had at the start.
template <int Dim>
Vec<Dim> reference_offset(const State<Dim>& state, std::size_t p, int k) {
  const auto& particles = state.particles;
  const Vec<Dim> offset = particles.initial_deformation(p).col(k);
  return 0.5 * state.bodies[particles.body()[p]].half_size[k] * particles.domain_share(p, k) * offset;
}

/// Temperatures are led along their slope to where the halves are, and what an equation of state holds of
/// heat with them: what particles tell the nodes stays as it was, and so does the heat of both.
template <int Dim>
void lead_temperatures(State<Dim>& state, std::size_t p, std::size_t q, const Vec<Dim>& offset) {
  auto& particles = state.particles;
  if (!particles.has(Quantity::temperature_slope)) return;
  const double rise = particles.vector(Quantity::temperature_slope, p).dot(offset);
  double* temperature = particles.column(Quantity::temperature);
  if (!(std::abs(rise) < temperature[p])) return;
  const double stored = state.bodies[particles.body()[p]].heat.stored;
  for (const auto& [at, by] : {std::pair{p, -rise}, std::pair{q, rise}}) {
    temperature[at] += by;
    if (stored > 0) particles.column(Quantity::internal_energy)[at] += stored * by;
  }
}

}  // namespace

template <int Dim>
Vec<Dim> half_edge(const State<Dim>& state, std::size_t p, int k) {
  const auto& particles = state.particles;
  const double length = state.bodies[particles.body()[p]].half_size[k] * particles.domain_share(p, k);
  Vec<Dim> edge;
  for (int d = 0; d < Dim; ++d)
    edge[d] = particles.column(Quantity::deformation_gradient, Dim * d + k)[p] * length;
  return edge;
}

template <int Dim>
SplitCounters count_long_edges(const State<Dim>& state, const SplitRule& rule) {
  const EdgeCheck<Dim> check(state, rule);
  std::atomic<std::uint64_t> to_halve{0}, held{0};
  for_each_block(static_cast<std::int64_t>(state.particles.size()), constants::threads::kEdgesAtOnce,
                 state.threads, [&](std::int64_t begin, std::int64_t end) {
                   SplitCounters found;
                   for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p)
                     for (int k = 0; k < Dim; ++k) {
                       const Edge edge = check(p, k);
                       found.splits += edge == Edge::to_halve;
                       found.held += edge == Edge::held;
                     }
                   to_halve.fetch_add(found.splits, std::memory_order_relaxed);
                   held.fetch_add(found.held, std::memory_order_relaxed);
                 });
  return {to_halve, held};
}

template <int Dim>
std::vector<std::uint32_t> long_along(const State<Dim>& state, const SplitRule& rule, int k) {
  const EdgeCheck<Dim> check(state, rule);
  std::vector<std::uint32_t> found;
  for (std::size_t p = 0; p < state.particles.size(); ++p)
    if (check(p, k) == Edge::to_halve) found.push_back(static_cast<std::uint32_t>(p));
  const auto& id = state.particles.id();
  std::sort(found.begin(), found.end(), [&](auto a, auto b) { return id[a] < id[b]; });
  return found;
}

template <int Dim>
std::size_t halve(State<Dim>& state, const std::vector<std::uint32_t>& parents, int k) {
  auto& particles = state.particles;
  const std::size_t first = particles.size();
  particles.grow(first + parents.size());
  for (std::size_t n = 0; n < parents.size(); ++n) {
    const std::size_t p = parents[n], q = first + n;
    const Vec<Dim> offset = 0.5 * half_edge(state, p, k), reference = reference_offset(state, p, k);
    // A ring's halves have their shares of its turn: as much as rings of their width are seeded with.
    const double outer = state.plane_kind == PlaneKind::axisymmetric
                             ? 0.5 * (1 + offset[0] / particles.column(Quantity::position, 0)[p])
                             : 0.5;
    particles.column(Quantity::domain_share, k)[p] *= 0.5;
    copy_particle(particles, p, q);
    particles.id()[q] = particles.next_id()++;
    for (const QuantityInfo& info : kQuantityTable) {
      if (!info.extensive || !particles.has(info.quantity)) continue;
      double* whole = particles.column(info.quantity);
      whole[q] = outer * whole[p];
      whole[p] -= whole[q];
    }
    move_by<Dim>(particles, Quantity::position, p, -offset);
    move_by<Dim>(particles, Quantity::position, q, offset);
    if (particles.has(Quantity::reference_position)) {
      move_by<Dim>(particles, Quantity::reference_position, p, -reference);
      move_by<Dim>(particles, Quantity::reference_position, q, reference);
    }
    lead_temperatures(state, p, q, offset);
  }
  return first;
}

template Vec<2> half_edge(const State<2>&, std::size_t, int);
template Vec<3> half_edge(const State<3>&, std::size_t, int);
template SplitCounters count_long_edges(const State<2>&, const SplitRule&);
template SplitCounters count_long_edges(const State<3>&, const SplitRule&);
template std::vector<std::uint32_t> long_along(const State<2>&, const SplitRule&, int);
template std::vector<std::uint32_t> long_along(const State<3>&, const SplitRule&, int);
template std::size_t halve(State<2>&, const std::vector<std::uint32_t>&, int);
template std::size_t halve(State<3>&, const std::vector<std::uint32_t>&, int);

}  // namespace mpmfast
