#pragma once

/// @file Normals by regression and separations by the particles' domains, for every contact entry.

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"
#include "engine/step/contact_list.hpp"
#include "engine/step/smooth_normals.hpp"
#include "kernels/contact/collect.hpp"
#include "kernels/contact/margin.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// What one thread counts; summed in any order, since whole numbers do not round.
struct alignas(64) FitTally {
  std::uint64_t regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
};

/// What a scene's contact asks of the clouds.
struct FitChoice {
  bool regress, margin, smooth, separate, pairs;
  Extent extent;
  RegressionRule rule;

  explicit FitChoice(const ContactSpec& spec) {
    pairs = spec.fields == ManyFields::simultaneous;
    smooth = spec.normal == NormalKind::smoothed_logistic_regression ||
             spec.normal == NormalKind::smoothed_max_margin;
    margin = spec.normal == NormalKind::max_margin || spec.normal == NormalKind::smoothed_max_margin;
    regress = smooth || margin || spec.normal == NormalKind::logistic_regression ||
              spec.normal == NormalKind::logistic_irls || spec.normal == NormalKind::linear_regression;
    separate = spec.detection != DetectionKind::velocity &&
               (spec.separation == SeparationKind::ellipsoid ||
                spec.separation == SeparationKind::ellipsoid_support ||
                spec.separation == SeparationKind::parallelogram_support);
    extent = spec.separation == SeparationKind::ellipsoid_support       ? Extent::ellipsoid
             : spec.separation == SeparationKind::parallelogram_support ? Extent::parallelepiped
                                                                        : Extent::radial;
    rule.fit = spec.normal == NormalKind::logistic_irls       ? Fit::likelihood
               : spec.normal == NormalKind::linear_regression ? Fit::linear
                                                              : Fit::least_squares;
    rule.penalty = spec.penalty;
    rule.offset_penalty = spec.offset_penalty;
    rule.tolerance = spec.tolerance;
    rule.max_iterations = spec.max_iterations;
  }
};

template <int Dim, class Basis>
class ContactFit {
 public:
  ContactFit() : rooms_(static_cast<std::size_t>(omp_get_max_threads())), tally_(rooms_.size()) {}

  void run(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& contact) {
    const FitChoice choice(spec);
    if (!choice.regress && !choice.separate) return;
    const ParticleView<Dim> view = const_cast<State<Dim>&>(state).view();  // read only here
    std::fill(tally_.begin(), tally_.end(), FitTally{});
    for (auto& room : rooms_) room.clouds.begin = 0;
    if (choice.smooth) raw_.resize(contact.entries.size()), kept_.resize(contact.nodes.size());
    for_each_node(state, contact, [&](std::size_t k, const ContactNode<Dim>& node, Room& room) {
      collect(state, view, contact, node, room.clouds);
      const auto cloud = room.clouds.columns(room.clouds.begin, room.clouds.count);
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = contact.entries[static_cast<std::size_t>(e)];
        room.choose_sides(cloud, entry);
        if (choice.regress && !entry.settled) fit(choice, spec.warm_start, room.view(cloud), entry);
        if (choice.separate)
          entry.separation = state.grid.cell * room.separation(choice.extent, cloud, entry.normal);
        if (choice.smooth) raw_[static_cast<std::size_t>(e)] = {entry.normal, entry.separation};
      }
      if (!choice.smooth) return;
      kept_[k] = {omp_get_thread_num(), cloud.count, room.clouds.begin};
      room.clouds.begin += static_cast<std::size_t>(padded_count(cloud.count));
    });
    if (choice.smooth) smooth(state, choice, contact);
    count(contact.counters);
  }

 private:
  /// What one thread works in.
  struct Room {
    CloudRoom<Dim> clouds;
    std::vector<double> side, radius;  ///< class and half extent of the cloud in hand

    void choose_sides(const CloudColumns<Dim>& cloud, const ContactEntry<Dim>& entry) {
      const auto needed = static_cast<std::size_t>(padded_count(cloud.count));
      if (side.size() < needed) side.resize(2 * needed), radius.resize(2 * needed);
      for (std::size_t k = 0; k < needed; ++k) side[k] = side_of(cloud.owner[k], entry);
    }

    /// A pair of a node of three or more fields leaves the others out.
    static double side_of(int owner, const ContactEntry<Dim>& entry) {
      if (owner == entry.a) return -1;
      return owner >= 0 && (entry.b < 0 || owner == entry.b) ? 1 : 0;
    }

    CloudView<Dim> view(const CloudColumns<Dim>& cloud) const {
      CloudView<Dim> v;
      for (int d = 0; d < Dim; ++d) v.xi[d] = cloud.xi[d];
      v.side = side.data();
      v.count = cloud.count;
      return v;
    }

    /// N20 Eq. 24, cells.
    double separation(Extent extent, const CloudColumns<Dim>& cloud, const Vec<Dim>& normal) {
      switch (extent) {
        case Extent::radial:
          return separation<Extent::radial>(cloud, normal);
        case Extent::ellipsoid:
          return separation<Extent::ellipsoid>(cloud, normal);
        case Extent::parallelepiped:
          return separation<Extent::parallelepiped>(cloud, normal);
      }
      return 0;
    }

    template <Extent E>
    double separation(const CloudColumns<Dim>& cloud, const Vec<Dim>& normal) {
      for (int k = 0; k < cloud.count; k += kLanes) {
        Lanes edge[Dim * Dim];
        for (int e = 0; e < Dim * Dim; ++e) edge[e] = load_lanes(cloud.edge[e] + k);
        store_lanes(&radius[static_cast<std::size_t>(k)], extent_along<E, Dim>(edge, normal));
      }
      return cloud_separation<Dim>(view(cloud), radius.data(), normal);
    }
  };

  /// Where the cloud of a node was left.
  struct Kept {
    int thread, count;
    std::size_t begin;
  };

  /// f(index, node, the thread's room), in parallel.
  template <class F>
  void for_each_node(const State<Dim>& state, const ContactList<Dim>& contact, F f) {
    const auto n = static_cast<std::int64_t>(contact.nodes.size());
#pragma omp parallel for num_threads(state.threads) schedule(dynamic, 8) if (n > 16)
    for (std::int64_t k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      f(at, contact.nodes[at], rooms_[static_cast<std::size_t>(omp_get_thread_num())]);
    }
  }

  static void collect(const State<Dim>& state, const ParticleView<Dim>& view, const ContactList<Dim>& contact,
                      const ContactNode<Dim>& node, CloudRoom<Dim>& room) {
    room.count = 0;
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const int slot = contact.fields[static_cast<std::size_t>(f)].slot;
      const auto& node_tile = state.tiling.node_tiles[static_cast<std::size_t>(slot / kTileNodes<Dim>)];
      for (int t : node_tile.particle_tile) {
        if (t < 0) continue;
        const TileContext<Dim> c{&view, &state.tiling.tiles[static_cast<std::size_t>(t)],
                                 state.tiling.runs.data(), state.bodies.data(), &state.grid};
        collect_tile<Dim, Basis>(c, node.node, f - node.field_begin, room);
      }
    }
    room.pad();
  }

  /// The plane of widest margin, from the last step's normal; regression where the hulls meet.
  bool part(const CloudView<Dim>& cloud, bool warm, ContactEntry<Dim>& entry) {
    Vec<Dim> guess = Eigen::Map<const Vec<Dim>>(entry.plane);
    if (!warm || guess.isZero(0)) guess = cloud_gradient(cloud);
    if (guess.isZero(0)) return false;
    const Margin<Dim> margin = widest_margin<Dim>(cloud, guess);
    tally_[static_cast<std::size_t>(omp_get_thread_num())].iterations +=
        static_cast<std::uint64_t>(margin.iterations);
    if (margin.normal.isZero(0)) return false;
    entry.normal = margin.normal;
    for (int d = 0; d < Dim; ++d) entry.plane[d] = margin.normal[d];
    return true;
  }

  void fit(const FitChoice& choice, bool warm, const CloudView<Dim>& cloud, ContactEntry<Dim>& entry) {
    if (choice.margin) {
      ++tally_[static_cast<std::size_t>(omp_get_thread_num())].regressions;
      if (part(cloud, warm, entry)) return;
      warm = false;  // what is kept of the last step is a normal, not a plane
      --tally_[static_cast<std::size_t>(omp_get_thread_num())].regressions;
      ++tally_[static_cast<std::size_t>(omp_get_thread_num())].fallbacks;
    }
    const Regression<Dim> result = fit_normal<Dim>(cloud, choice.rule, warm ? entry.plane : nullptr);
    using Outcome = typename Regression<Dim>::Outcome;
    entry.normal = result.outcome == Outcome::failed ? cloud_gradient(cloud) : result.normal;
    std::memcpy(entry.plane, result.plane, sizeof entry.plane);
    FitTally& tally = tally_[static_cast<std::size_t>(omp_get_thread_num())];
    ++tally.regressions;
    tally.iterations += static_cast<std::uint64_t>(result.iterations);
    tally.fallbacks += result.outcome == Outcome::centroid_fallback || result.outcome == Outcome::failed;
    tally.unconverged += result.outcome == Outcome::unconverged;
  }

  /// The last resort, where one class is missing or the centroids coincide: the gradient normal with
  /// G_pi ∝ −ξ_p, the slope of a paraboloid over the support.
  static Vec<Dim> cloud_gradient(const CloudView<Dim>& cloud) {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int k = 0; k < cloud.count; ++k)
      for (int d = 0; d < Dim; ++d) sum[d] += cloud.side[k] * cloud.xi[d][k];
    const double length = sum.norm();
    return length > 0 ? Vec<Dim>(sum / length) : Vec<Dim>::Zero();
  }

  /// Mean normals of the nodes around, and the separations along them.
  void smooth(const State<Dim>& state, const FitChoice& choice, ContactList<Dim>& contact) {
    const NormalMean<Dim> mean(state, contact, raw_, choice.pairs);
    for_each_node(state, contact, [&](std::size_t k, const ContactNode<Dim>& node, Room& room) {
      const Kept& kept = kept_[k];
      const auto cloud = rooms_[static_cast<std::size_t>(kept.thread)].clouds.columns(kept.begin, kept.count);
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = contact.entries[static_cast<std::size_t>(e)];
        const Vec<Dim> sum = mean(node, entry);
        const double length = sum.norm();
        if (length > 0 && !entry.settled) entry.normal = sum / length;
        if (!choice.separate) continue;
        room.choose_sides(cloud, entry);
        entry.separation = state.grid.cell * room.separation(choice.extent, cloud, entry.normal);
      }
    });
  }

  void count(ContactCounters& counters) const {
    for (const auto& t : tally_) {
      counters.regressions += t.regressions;
      counters.iterations += t.iterations;
      counters.fallbacks += t.fallbacks;
      counters.unconverged += t.unconverged;
    }
  }

  std::vector<Room> rooms_;
  std::vector<FitTally> tally_;
  std::vector<RawNormal<Dim>> raw_;
  std::vector<Kept> kept_;
};

}  // namespace mpmfast
