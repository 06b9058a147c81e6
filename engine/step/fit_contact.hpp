#pragma once

/// @file Normals by logistic regression and separations by deformed ellipsoids, for every contact entry.

#include <omp.h>

#include <algorithm>

#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"
#include "engine/step/contact_list.hpp"
#include "kernels/contact/collect.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

/// What one thread counts; summed in any order, since whole numbers do not round.
struct alignas(64) FitTally {
  std::uint64_t regressions = 0, iterations = 0, fallbacks = 0, unconverged = 0;
};

template <int Dim, class Basis>
class ContactFit {
 public:
  ContactFit() : rooms_(static_cast<std::size_t>(omp_get_max_threads())), tally_(rooms_.size()) {
    for (auto& room : rooms_) room.reserve(512);
  }

  void run(const State<Dim>& state, const ContactSpec& spec, ContactList<Dim>& contact) {
    ParticleView<Dim> view = const_cast<State<Dim>&>(state).view();  // read only here
    const bool smooth = spec.normal == NormalKind::smoothed_logistic_regression;
    const bool regress = smooth || spec.normal == NormalKind::logistic_regression;
    const bool ellipsoids = spec.separation == SeparationKind::ellipsoid;
    std::fill(tally_.begin(), tally_.end(), FitTally{});
    const auto n = static_cast<std::int64_t>(contact.nodes.size());
    if (smooth) raw_.resize(contact.entries.size());
    if (regress || ellipsoids) {
#pragma omp parallel for num_threads(state.threads) schedule(dynamic, 8) if (n > 16)
      for (std::int64_t k = 0; k < n; ++k) {
        const auto& node = contact.nodes[static_cast<std::size_t>(k)];
        CloudRoom<Dim>& room = this_room();
        collect(state, view, contact, node, room);
        for (int e = node.entry_begin; e < node.entry_end; ++e) {
          auto& entry = contact.entries[static_cast<std::size_t>(e)];
          choose_sides(entry, room);
          if (regress) fit(spec, room, entry);
          if (smooth) raw_[static_cast<std::size_t>(e)] = entry.normal;
          if (!smooth && ellipsoids) entry.separation = separation(state.grid.cell, room, entry.normal);
        }
      }
    }
    if (smooth) smooth_normals(state, view, contact, ellipsoids);
    for (const auto& t : tally_) {
      contact.counters.regressions += t.regressions;
      contact.counters.iterations += t.iterations;
      contact.counters.fallbacks += t.fallbacks;
      contact.counters.unconverged += t.unconverged;
    }
  }

 private:
  CloudRoom<Dim>& this_room() { return rooms_[static_cast<std::size_t>(omp_get_thread_num())]; }

  void collect(const State<Dim>& state, ParticleView<Dim>& view, const ContactList<Dim>& contact,
               const ContactNode<Dim>& node, CloudRoom<Dim>& room) const {
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
    room.reserve(room.count + kLanes);
    for (int k = room.count; k < padded_count(room.count); ++k) {
      const auto at = static_cast<std::size_t>(k);
      room.owner[at] = -1;
      for (int d = 0; d < Dim; ++d) {
        room.xi[d][at] = 0;
        room.half_size[d][at] = 1;
        for (int j = 0; j < Dim; ++j) room.deformation[Dim * d + j][at] = d == j ? 1 : 0;
      }
    }
  }

  static void choose_sides(const ContactEntry<Dim>& entry, CloudRoom<Dim>& room) {
    for (int k = 0; k < padded_count(room.count); ++k) {
      const int owner = room.owner[static_cast<std::size_t>(k)];
      const bool other = owner >= 0 && (entry.b < 0 || owner == entry.b);
      room.side[static_cast<std::size_t>(k)] = owner == entry.a ? -1.0 : other ? 1.0 : 0.0;
    }
  }

  void fit(const ContactSpec& spec, const CloudRoom<Dim>& room, ContactEntry<Dim>& entry) {
    const Regression<Dim> result = fit_normal<Dim>(room.view(), spec.penalty);
    entry.normal = result.outcome == Regression<Dim>::Outcome::failed ? cloud_gradient(room) : result.normal;
    using Outcome = typename Regression<Dim>::Outcome;
    FitTally& tally = tally_[static_cast<std::size_t>(omp_get_thread_num())];
    ++tally.regressions;
    tally.iterations += static_cast<std::uint64_t>(result.iterations);
    tally.fallbacks += result.outcome == Outcome::centroid_fallback || result.outcome == Outcome::failed;
    tally.unconverged += result.outcome == Outcome::unconverged;
  }

  /// The last resort, where one class is missing or the centroids coincide: the gradient normal with
  /// G_pi ∝ −ξ_p, the slope of a paraboloid over the support.
  static Vec<Dim> cloud_gradient(const CloudRoom<Dim>& room) {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int k = 0; k < room.count; ++k)
      for (int d = 0; d < Dim; ++d)
        sum[d] += room.side[static_cast<std::size_t>(k)] * room.xi[d][static_cast<std::size_t>(k)];
    const double length = sum.norm();
    return length > 0 ? Vec<Dim>(sum / length) : Vec<Dim>::Zero();
  }

  /// N20 Eq. 24, m.
  static double separation(double cell, CloudRoom<Dim>& room, const Vec<Dim>& normal) {
    for (int k = 0; k < room.count; k += kLanes) {
      const auto at = static_cast<std::size_t>(k);
      Lanes f[Dim * Dim], inverse[Dim * Dim], half_size[Dim];
      for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(&room.deformation[e][at]);
      for (int d = 0; d < Dim; ++d) half_size[d] = load_lanes(&room.half_size[d][at]);
      inverse_deformation<Dim>(f, inverse);
      store_lanes(&room.radius[at], ellipsoid_radius<Dim>(inverse, half_size, normal));
    }
    return cell * cloud_separation<Dim>(room.view(), room.radius.data(), normal);
  }

  /// The mean of the regression normals of the same contact on the 3^Dim nodes around, weighted by the
  /// smaller of the two masses: single normals are poor where a cloud holds few particles of one field.
  void smooth_normals(const State<Dim>& state, ParticleView<Dim>& view, ContactList<Dim>& contact,
                      bool ellipsoids) {
    const auto n = static_cast<std::int64_t>(contact.nodes.size());
#pragma omp parallel for num_threads(state.threads) schedule(dynamic, 8) if (n > 16)
    for (std::int64_t k = 0; k < n; ++k) {
      const auto& node = contact.nodes[static_cast<std::size_t>(k)];
      CloudRoom<Dim>& room = this_room();
      if (ellipsoids) collect(state, view, contact, node, room);
      for (int e = node.entry_begin; e < node.entry_end; ++e) {
        auto& entry = contact.entries[static_cast<std::size_t>(e)];
        Vec<Dim> sum = Vec<Dim>::Zero();
        for (int m = 0; m < power(3, Dim); ++m) {
          const int other = neighbour(state.tiling, contact, node, m);
          if (other >= 0)
            add_normals(state, contact, node, entry, contact.nodes[static_cast<std::size_t>(other)], sum);
        }
        const double length = sum.norm();
        if (length > 0) entry.normal = sum / length;
        if (!ellipsoids) continue;
        choose_sides(entry, room);
        entry.separation = separation(state.grid.cell, room, entry.normal);
      }
    }
  }

  /// The contact node at one of the 3^Dim places around a node (itself in the middle), or −1.
  static int neighbour(const Tiling<Dim>& tiling, const ContactList<Dim>& contact,
                       const ContactNode<Dim>& node, int m) {
    int stack_digit = 0, stride3 = 1, local = 0, stride4 = 1, rest = node.local;
    for (int d = 0; d < Dim; ++d) {
      int at = rest % kTileSide + m % 3 - 1;
      int step = 1;
      if (at < 0) at += kTileSide, step = 0;
      if (at >= kTileSide) at -= kTileSide, step = 2;
      stack_digit += step * stride3;
      local += at * stride4;
      stride3 *= 3;
      stride4 *= kTileSide;
      rest /= kTileSide;
      m /= 3;
    }
    const int stack = tiling.stacks[static_cast<std::size_t>(node.stack)].neighbour[stack_digit];
    return stack < 0 ? -1
                     : contact.node_at[static_cast<std::size_t>(stack) * kTileNodes<Dim> +
                                       static_cast<std::size_t>(local)];
  }

  /// Adds the other node's normals of field a against any of the fields that a meets here, and of such a
  /// field against a, turned round.
  void add_normals(const State<Dim>& state, const ContactList<Dim>& contact, const ContactNode<Dim>& node,
                   const ContactEntry<Dim>& entry, const ContactNode<Dim>& other, Vec<Dim>& sum) const {
    const auto field = [&](const ContactNode<Dim>& n, int k) {
      return contact.fields[static_cast<std::size_t>(n.field_begin + k)].field;
    };
    const int a = field(node, entry.a);
    const auto meets_a = [&](int f) {
      if (f == a) return false;
      for (int k = 0; k < node.field_end - node.field_begin; ++k)
        if (field(node, k) == f) return true;
      return false;
    };
    const auto has = [&](auto wanted, int except) {
      for (int k = 0; k < other.field_end - other.field_begin; ++k)
        if (k != except && wanted(field(other, k))) return true;
      return false;
    };
    const double* mass = state.nodes.column(Nodal::mass);
    for (int e = other.entry_begin; e < other.entry_end; ++e) {
      const auto& theirs = contact.entries[static_cast<std::size_t>(e)];
      const int f = field(other, theirs.a);
      const bool same = f == a && has(meets_a, theirs.a);
      const bool turned = meets_a(f) && has([&](int g) { return g == a; }, theirs.a);
      if (!same && !turned) continue;
      double own = 0, total = 0;
      for (int k = 0; k < other.field_end - other.field_begin; ++k) {
        const double m = mass[contact.fields[static_cast<std::size_t>(other.field_begin + k)].slot];
        total += m;
        if (k == theirs.a) own = m;
      }
      sum += (same ? 1.0 : -1.0) * std::min(own, total - own) * raw_[static_cast<std::size_t>(e)];
    }
  }

  std::vector<CloudRoom<Dim>> rooms_;
  std::vector<FitTally> tally_;
  std::vector<Vec<Dim>> raw_;
};

}  // namespace mpmfast
