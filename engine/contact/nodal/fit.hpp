#pragma once

/// @file Normals by regression and separations by the particles' domains, for every contact entry.

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "engine/contact/contact_basis.hpp"
#include "engine/contact/nodal/kept_fit.hpp"
#include "engine/contact/nodal/list.hpp"
#include "engine/contact/nodal/slabs.hpp"
#include "engine/contact/nodal/smooth_normals.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/shares.hpp"
#include "engine/state/state.hpp"
#include "kernels/contact/collect.hpp"
#include "kernels/contact/margin.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// What one thread counts; summed in any order, since whole numbers do not round.
struct alignas(64) FitTally {
  std::uint64_t regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
  std::uint64_t touching = 0, doubtful = 0;
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

template <int Dim>
class ContactFit {
 public:
  ContactFit() : rooms_(static_cast<std::size_t>(omp_get_max_threads())) {}

  /// Normals by regression and separations by the particles' domains, of the listed contact entries.
  void run(const State<Dim>& state, const ContactSpec& spec, const ContactBasis<Dim>& basis,
           ContactList<Dim>& contact) {
    const FitChoice choice(spec);
    if (!choice.regress && !choice.separate) return;
    basis_ = &basis;
    bases_ = &state.field_base;
    const ParticleView<Dim> view = const_cast<State<Dim>&>(state).view();  // read only here
    for (auto& room : rooms_) {
      room.candidates.extent = choice.separate ? std::optional(choice.extent) : std::nullopt;
      room.candidates.numbered = choice.separate && !contact.fits.empty();
      room.tally = {};
      room.stack = -1;
    }
    if (choice.smooth) raw_.resize(contact.entries.size()), kept_.resize(contact.nodes.size());
    first_.resize(contact.fields.size());
    const NormalMean<Dim> mean(state, contact, raw_, choice.pairs);
    find_due(contact, spec.refit * state.grid.cell, state.threads, shares_, due_,
             [&](const ContactNode<Dim>& node) { reuse(state, choice, mean, node, contact); });
    slabs_.cut(state, contact, due_, choice.smooth);
    for (auto& room : rooms_) room.clouds.resize(std::max(slabs_.at_once(), room.clouds.size()));
    std::size_t surrounded = 0;
    for (std::size_t s = 0; s < slabs_.size(); ++s) {
      fit_slab(state, view, spec, choice, mean, s, contact);
      for (; choice.smooth && surrounded <= s && slabs_.surrounded_by(surrounded) <= s; ++surrounded)
        smooth(state, choice, mean, surrounded, contact);
    }
    count(contact.counters);
  }

  std::size_t bytes() const {
    std::size_t sum = bytes_in(raw_, kept_, due_, first_);
    const auto add = [&](const auto& columns) {
      for (const auto& column : columns) sum += bytes_in(column);
    };
    for (const Room& room : rooms_) {
      const auto& near = room.candidates;
      sum += bytes_in(room.side, room.sums, near.pieces, near.number);
      add(near.position);
      add(near.reach);
      add(near.domain);
      add(near.shape);
      for (const CloudRoom<Dim>& cloud : room.clouds) {
        add(cloud.xi);
        add(cloud.shape);
        sum += bytes_in(cloud.number);
      }
    }
    return sum;
  }

 private:
  struct Room;

  /// Normals and separations of the nodes of a slab; of those to be smoothed the clouds are kept.
  void fit_slab(const State<Dim>& state, const ParticleView<Dim>& view, const ContactSpec& spec,
                const FitChoice& choice, const NormalMean<Dim>& mean, std::size_t slab,
                ContactList<Dim>& contact) {
    const std::size_t at = slab % slabs_.at_once();
    for (auto& room : rooms_) {
      room.clouds[at].shapes = room.candidates.shapes();
      room.clouds[at].numbered = room.candidates.numbered;
      room.clouds[at].begin = 0;
    }
    slabs_.for_each_node(slab, state, contact, [&](std::size_t k, const ContactNode<Dim>& node) {
      if (!due_[k]) return;
      Room& room = own_room();
      CloudRoom<Dim>& clouds = room.clouds[at];
      if (room.stack != node.stack) find_candidates(state, view, contact, k, room);
      collect(state.grid, contact, node, room.candidates, clouds);
      const auto cloud = clouds.columns(clouds.begin, clouds.count);
      const FieldRanges fields = ranges(node, cloud.count);
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = contact.entries[static_cast<std::size_t>(e)];
        const bool fits = choice.regress && !entry.settled;
        const bool fell_back =
            fits && fit(choice, spec.warm_start, room.view(room.particles_of(cloud, fields, entry)), entry,
                        room.tally);
        std::array<std::int32_t, 2> foremost{-1, -1};
        if (choice.separate)
          entry.separation = state.grid.cell * separation(choice.extent, cloud, fields, entry, foremost);
        const bool touches = fits && (!choice.separate || entry.separation < 0 || entry.touched);
        const bool doubted = touches && fell_back;
        room.tally.touching += touches;
        if (choice.smooth)
          raw_[static_cast<std::size_t>(e)] =
              mean.raw(node, entry, entry.normal, entry.separation < 0, doubted);
        else
          room.tally.doubtful += doubted;
        if (contact.fits.empty()) continue;
        // A lump is what is there: another in its place has the same name.
        const bool known =
            fits && entry.b >= 0 && (!choice.separate || (foremost[0] >= 0 && foremost[1] >= 0));
        contact.fits[static_cast<std::size_t>(e)] = {entry.normal, entry.normal,         foremost, 0,
                                                     known,        entry.separation < 0, doubted};
      }
      if (!choice.smooth) return;
      kept_[k] = {own_number(), cloud.count, clouds.begin};
      clouds.begin += static_cast<std::size_t>(padded_count(cloud.count));
    });
  }

  /// The normal and the foremost particles of the last fit.
  void reuse(const State<Dim>& state, const FitChoice& choice, const NormalMean<Dim>& mean,
             const ContactNode<Dim>& node, ContactList<Dim>& contact) {
    for (int e = node.entry_begin; e < node.entry_end; ++e) {
      auto& entry = contact.entries[static_cast<std::size_t>(e)];
      const KeptFit<Dim>& fit = contact.fits[static_cast<std::size_t>(e)];
      if (entry.crack < 0) entry.normal = fit.normal;
      if (choice.separate && entry.crack < 0)
        with_extent(choice.extent, [&]<Extent E>() {
          entry.separation = state.grid.cell * kept_separation<E>(state, node.node, fit);
        });
      if (choice.smooth)
        raw_[static_cast<std::size_t>(e)] = mean.raw(node, entry, fit.raw, entry.separation < 0, fit.doubted);
    }
  }

  Room& own_room() { return rooms_[static_cast<std::size_t>(own_number())]; }

  /// Where the particles of each field of a node begin and end in its cloud.
  struct FieldRanges {
    const int* first;
    int fields, count;
    std::pair<int, int> operator()(int k) const { return {first[k], k + 1 < fields ? first[k + 1] : count}; }
  };
  FieldRanges ranges(const ContactNode<Dim>& node, int count) const {
    return {first_.data() + node.field_begin, node.field_end - node.field_begin, count};
  }

  /// What one thread works in.
  struct alignas(64) Room {
    int stack;                           ///< in hand; −1: none
    Candidates<Dim> candidates;          ///< near it
    std::vector<CloudRoom<Dim>> clouds;  ///< of the slabs that are kept at once
    CloudRoom<Dim> pair;
    std::vector<double> side;    ///< classes of the particles in hand
    std::vector<Vec<Dim>> sums;  ///< of normals, of the entries of the node in hand
    FitTally tally;

    /// The particles of an entry with their sides: of a pair on a node of several fields those of the two,
    /// else all of them.
    CloudColumns<Dim> particles_of(const CloudColumns<Dim>& cloud, const FieldRanges& ranges,
                                   const ContactEntry<Dim>& entry) {
      const auto [a_begin, a_end] = ranges(entry.a);
      if (entry.b < 0 || ranges.fields == 2) {
        fill_sides(cloud.count, a_begin, a_end);
        return cloud;
      }
      const auto [b_begin, b_end] = ranges(entry.b);
      const int count = a_end - a_begin + b_end - b_begin, low = std::min(a_begin, b_begin);
      if (std::max(a_end, b_end) - low == count) {  // neighbours
        fill_sides(count, a_begin - low, a_end - low);
        return cloud.part(low, count);
      }
      pair.count = 0;
      pair.append_places(cloud, a_begin, a_end);
      pair.append_places(cloud, b_begin, b_end);
      fill_sides(count, 0, a_end - a_begin);
      return pair.columns(0, count);
    }

    /// −1 for [begin, end), 1 for the rest of the particles, 0 beyond them.
    void fill_sides(int count, int begin, int end) {
      const auto needed = static_cast<std::size_t>(padded_count(count));
      if (side.size() < needed) side.resize(2 * needed);
      const Lanes zero{}, one = broadcast<Lanes>(1.0);
      Lanes index;
      for (int i = 0; i < kLanes; ++i) index[i] = i;
      for (int k = 0; k < count; k += kLanes) {
        const IntLanes own = (index >= static_cast<double>(begin)) & (index < static_cast<double>(end));
        const Lanes counted = index < static_cast<double>(count) ? one : zero;
        store_lanes(&side[static_cast<std::size_t>(k)], own ? -one : counted);
        index += static_cast<double>(kLanes);
      }
    }

    CloudView<Dim> view(const CloudColumns<Dim>& cloud) const {
      CloudView<Dim> v;
      for (int d = 0; d < Dim; ++d) v.xi[d] = cloud.xi[d];
      v.side = side.data();
      v.count = cloud.count;
      return v;
    }
  };

  template <class F>
  static void with_extent(Extent extent, F f) {
    switch (extent) {
      case Extent::radial:
        return f.template operator()<Extent::radial>();
      case Extent::ellipsoid:
        return f.template operator()<Extent::ellipsoid>();
      case Extent::parallelepiped:
        return f.template operator()<Extent::parallelepiped>();
    }
  }

  /// N20 Eq. 24, cells; infinite if a class is empty.
  /// @param foremost  particles: of a along the normal, of the rest against it; −1: none
  static double separation(Extent extent, const CloudColumns<Dim>& cloud, const FieldRanges& fields,
                           const ContactEntry<Dim>& entry, std::array<std::int32_t, 2>& foremost) {
    double apart = 0;
    with_extent(extent, [&]<Extent E>() {
      const auto reach = [&](std::pair<int, int> range, const Vec<Dim>& n) {
        const auto part = cloud.part(range.first, range.second - range.first);
        SupportSearch::Found found = reach_along<E>(part, n);
        if (found.at >= 0 && part.number) found.at = static_cast<int>(part.number[found.at]);
        return found;
      };
      const Vec<Dim> back = -entry.normal;
      const auto own = fields(entry.a);
      const auto front = reach(own, entry.normal);
      auto rest = entry.b >= 0 ? reach(fields(entry.b), back) : reach({0, own.first}, back);
      if (entry.b < 0)
        if (const auto behind = reach({own.second, cloud.count}, back); behind.value > rest.value)
          rest = behind;
      apart = -front.value - rest.value;
      foremost = {front.at, rest.at};
    });
    return apart;
  }

  /// Where the cloud of a node was left.
  struct Kept {
    int thread, count;
    std::size_t begin;
  };

  /// Particles near the contact nodes of a stack that are due, whose first one is given.
  void find_candidates(const State<Dim>& state, const ParticleView<Dim>& view,
                       const ContactList<Dim>& contact, std::size_t first, Room& room) {
    const auto& tiling = state.tiling;
    const int s = room.stack = contact.nodes[first].stack;
    NodeBox<Dim> box{contact.nodes[first].node, contact.nodes[first].node};
    for (std::size_t k = first; k < contact.nodes.size() && contact.nodes[k].stack == s; ++k)
      for (int d = 0; due_[k] && d < Dim; ++d) {
        box.low[d] = std::min(box.low[d], contact.nodes[k].node[d]);
        box.high[d] = std::max(box.high[d], contact.nodes[k].node[d]);
      }
    room.candidates.clear();
    const auto& stack = tiling.stacks[static_cast<std::size_t>(s)];
    for (int n = stack.begin; n < stack.end; ++n)
      for (int t : tiling.node_tiles[static_cast<std::size_t>(n)].particle_tile) {
        if (t < 0) continue;
        const auto first = tiling.tiles.begin() + t;
        if (first->field != tiling.node_tiles[static_cast<std::size_t>(n)].field) continue;  // once a body
        for (auto tile = first; tile <= first + first->others; ++tile) {
          const TileContext<Dim> c{&view, &*tile, tiling.runs.data(), state.bodies.data(), &state.grid};
          basis_->add_candidates(c, box, room.candidates);
        }
      }
  }

  /// The cloud of a node, field after field.
  void collect(const GridView<Dim>& grid, const ContactList<Dim>& contact, const ContactNode<Dim>& node,
               const Candidates<Dim>& candidates, CloudRoom<Dim>& clouds) {
    clouds.count = 0;
    auto piece = candidates.pieces.begin();
    const auto end = candidates.pieces.end();
    int before = -1;
    for (int f = node.field_begin; f < node.field_end; ++f) {
      const int own = contact.fields[static_cast<std::size_t>(f)].field,
                field = (*bases_)[static_cast<std::size_t>(own)];  // of a side of a crack: all of its body
      if (field <= before) piece = candidates.pieces.begin();
      before = field;
      while (piece != end && piece->field < field) ++piece;
      first_[static_cast<std::size_t>(f)] = clouds.count;
      for (; piece != end && piece->field == field; ++piece)
        basis_->append_covering(candidates, *piece, grid.inverse_cell, node.node, clouds);
    }
    clouds.pad();
  }

  /// The plane of widest margin, from the last step's normal; regression where the hulls meet.
  static bool part(const CloudView<Dim>& cloud, bool warm, ContactEntry<Dim>& entry, FitTally& tally) {
    Vec<Dim> guess = Eigen::Map<const Vec<Dim>>(entry.plane);
    if (!warm || guess.isZero(0)) guess = cloud_gradient(cloud);
    if (guess.isZero(0)) return false;
    const Margin<Dim> margin = widest_margin<Dim>(cloud, guess);
    tally.iterations += static_cast<std::uint64_t>(margin.iterations);
    if (margin.normal.isZero(0)) return false;
    entry.normal = margin.normal;
    for (int d = 0; d < Dim; ++d) entry.plane[d] = margin.normal[d];
    return true;
  }

  /// @return whether the normal is that of a simpler method
  static bool fit(const FitChoice& choice, bool warm, const CloudView<Dim>& cloud, ContactEntry<Dim>& entry,
                  FitTally& tally) {
    ++tally.regressions;
    if (choice.margin) {
      if (part(cloud, warm, entry, tally)) return false;
      warm = false;  // what is kept of the last step is a normal, not a plane
    }
    const Regression<Dim> result = fit_normal<Dim>(cloud, choice.rule, warm ? entry.plane : nullptr);
    using Outcome = typename Regression<Dim>::Outcome;
    entry.normal = result.outcome == Outcome::failed ? cloud_gradient(cloud) : result.normal;
    std::memcpy(entry.plane, result.plane, sizeof entry.plane);
    tally.iterations += static_cast<std::uint64_t>(result.iterations);
    const bool fell_back =
        choice.margin || result.outcome == Outcome::centroid_fallback || result.outcome == Outcome::failed;
    tally.fallbacks += fell_back;
    tally.unconverged += result.outcome == Outcome::unconverged;
    return fell_back;
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

  /// Mean normals of the nodes around, and the separations along them, of a slab.
  void smooth(const State<Dim>& state, const FitChoice& choice, const NormalMean<Dim>& mean, std::size_t slab,
              ContactList<Dim>& contact) {
    const std::size_t at = slab % slabs_.at_once();
    slabs_.for_each_node(slab, state, contact, [&](std::size_t k, const ContactNode<Dim>& node) {
      if (!due_[k]) return;
      Room& room = own_room();
      const Kept& kept = kept_[k];
      const auto cloud =
          rooms_[static_cast<std::size_t>(kept.thread)].clouds[at].columns(kept.begin, kept.count);
      mean(mean.around(node), node, room.sums);
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = contact.entries[static_cast<std::size_t>(e)];
        const Vec<Dim>& sum = room.sums[static_cast<std::size_t>(e - node.entry_begin)];
        const RawNormal<Dim>& raw = raw_[static_cast<std::size_t>(e)];
        room.tally.doubtful += raw.doubted && !is_borne_out(raw, sum);
        const double length = sum.norm();
        if (length > 0 && !entry.settled) entry.normal = sum / length;
        KeptFit<Dim> none, &fit = contact.fits.empty() ? none : contact.fits[static_cast<std::size_t>(e)];
        fit.normal = entry.normal;
        if (choice.separate)
          entry.separation = state.grid.cell *
                             separation(choice.extent, cloud, ranges(node, cloud.count), entry, fit.foremost);
      }
    });
  }

  void count(ContactCounters& counters) const {
    for (const Room& room : rooms_) {
      const FitTally& t = room.tally;
      counters.regressions += t.regressions;
      counters.iterations += t.iterations;
      counters.fallbacks += t.fallbacks;
      counters.unconverged += t.unconverged;
      counters.touching += t.touching;
      counters.doubtful += t.doubtful;
    }
  }

  const ContactBasis<Dim>* basis_ = nullptr;
  const std::vector<int>* bases_ = nullptr;  ///< State::field_base
  std::vector<Room> rooms_;
  std::vector<RawNormal<Dim>> raw_;
  std::vector<Kept> kept_;
  std::vector<std::uint8_t> due_;  ///< by contact node: it is fitted in this step
  ContactSlabs<Dim> slabs_;
  Shares shares_{omp_get_max_threads()};
  std::vector<int> first_;  ///< as ContactList::fields: where its particles begin in their cloud
};

}  // namespace mpmfast
