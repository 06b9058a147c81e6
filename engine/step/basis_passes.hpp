#pragma once

/// @file The passes of the step for one basis: loops over tiles around the kernels. kernels/basis/bases.hpp
/// lists the bases.

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include "engine/constants.hpp"
#include "engine/geometry/crossing.hpp"
#include "engine/state/thread_team.hpp"
#include "engine/step/moves.hpp"
#include "engine/step/passes.hpp"
#include "engine/step/tile_loops.hpp"
#include "kernels/basis/facts.hpp"
#include "kernels/contact/collect.hpp"
#include "kernels/transfer/affine.hpp"
#include "kernels/transfer/boundary.hpp"
#include "kernels/transfer/heat.hpp"
#include "kernels/transfer/move.hpp"
#include "kernels/transfer/project.hpp"
#include "kernels/transfer/re_extrapolate.hpp"
#include "kernels/transfer/update.hpp"
#include "kernels/transfer/xpic.hpp"

namespace mpmfast {

template <int Dim, class Basis>
class BasisPasses final : public Passes<Dim> {
 public:
  BasisPasses() {
    workspaces_.resize(static_cast<std::size_t>(omp_get_max_threads()));
    for (auto& workspace : workspaces_) workspace = std::make_unique<Workspace>();
  }

  void shape_domains(State<Dim>& state) override {
    for (std::size_t p = 0; p < state.particles.size(); ++p) shape_domain(state, p);
  }

  void shape_domains(State<Dim>& state, std::span<const std::uint32_t> particles) override {
    for (const std::uint32_t p : particles) shape_domain(state, p);
  }

  void sort(State<Dim>& state) override {
    const auto n = static_cast<std::int64_t>(state.particles.size());
    state.tiling.start_keys(static_cast<std::size_t>(n), state.body_field);
    const ChunkGeometry<Dim> all = geometry_of(state);
    const auto sorted_node = [&](std::size_t p) {
      NodeIndex<Dim> first = Basis::first_node(all, static_cast<int>(p));
      for (int d = 0; d < Dim; ++d) first[d] += 1 - kSortedOffset<Basis>;  // the tiling's offset is 1 … 4
      return first;
    };
    for_each_of(n, state.threads, constants::threads::kFewParticles, [&](std::int64_t p) {
      const auto at = static_cast<std::size_t>(p);
      const int body = state.particles.body()[at];
      state.tiling.set_key(at, sorted_node(at), state.body_field[static_cast<std::size_t>(body)], body,
                           state.surfaces.holds(body, state.particles.id()[at]));
    });
    state.tiling.build(state.particles, state.body_field);
    state.nodes.resize(static_cast<std::size_t>(state.tiling.slots()));
  }

  Supports<Dim> supports(const State<Dim>& state) const override {
    static_assert(power(Basis::kMaxSupport + 1, 2) <= LineCrossings::kMost);  // of nodes_ahead
    return {[all = geometry_of(state)](std::size_t p, double way) {
              ChunkGeometry<Dim> behind = all;  // farther from an origin that lies so much behind
              for (double& x : behind.origin) x -= way;
              return Basis::first_node(behind, static_cast<int>(p));
            },
            Basis::kMaxSupport};
  }

  bool near_home(const State<Dim>& state, double way) const override {
    ChunkGeometry<Dim> ahead = geometry_of(state), behind = ahead;
    for (double& x : ahead.origin) x -= way;
    for (double& x : behind.origin) x += way;
    const auto is_near = [&](const NodeIndex<Dim>& home, int p) {
      const NodeIndex<Dim> last = Basis::first_node(ahead, p), first = Basis::first_node(behind, p);
      bool near = true;
      for (int d = 0; d < Dim; ++d) near &= last[d] <= home[d] + 1 && first[d] >= home[d] - 1;
      return near;
    };
    const auto tiles = static_cast<std::int64_t>(state.tiling.tiles.size());
    std::atomic<bool> strayed{false};
    for_each_of(tiles, state.threads, constants::threads::kFewBlocks, [&](std::int64_t t) {
      const ParticleTile<Dim>& tile = state.tiling.tiles[static_cast<std::size_t>(t)];
      for (int r = tile.run_begin; r < tile.run_end && !strayed.load(std::memory_order_relaxed); ++r) {
        const ParticleRun<Dim>& run = state.tiling.runs[static_cast<std::size_t>(r)];
        for (int cell = 0; cell < kTileNodes<Dim>; ++cell) {
          NodeIndex<Dim> home;
          for (int d = 0, digits = cell; d < Dim; ++d, digits /= kTileSide)
            home[d] = tile.window[d] + kSortedOffset<Basis> + digits % kTileSide;
          for (std::uint32_t p = run.cell_begin[cell]; p < run.cell_begin[cell + 1]; ++p)
            if (!is_near(home, static_cast<int>(p))) strayed.store(true, std::memory_order_relaxed);
        }
      }
    });
    return !strayed;
  }

  bool project(State<Dim>& state, bool with_force) override {
    auto& nodes = state.nodes;
    NodeColumns<1 + Dim> inertia;
    NodeColumns<kLoadEntries<Dim>> load{};
    inertia.column[0] = load.column[0] = nodes.column(Nodal::mass);
    for (int d = 0; d < Dim; ++d)
      inertia.column[1 + d] = load.column[1 + d] = nodes.column(Nodal::momentum, d);
    for (int e = 4; e < kLoadEntries<Dim>; ++e) load.column[e] = nodes.column(Nodal::force, (e - 4) % Dim);
    outside_.assign(workspaces_.size(), 0);
    const bool affine = state.particles.has(Quantity::velocity_slopes);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      int& outside = outside_[static_cast<std::size_t>(thread_index())];
      if (outside) return;  // all of it will be done again
      const bool inside = with_force && !rigid ? project_force_tile<Dim, Basis>(c, workspace.project, load)
                                               : project_inertia(c, workspace.project, affine, inertia);
      if (!inside) outside = 1;
    });
    return *std::max_element(outside_.begin(), outside_.end()) == 0;
  }

  void project_geometry(State<Dim>& state, bool cracks_alone, bool cracks_displaced) override {
    auto& nodes = state.nodes;
    const GeometryColumns<Dim> out{nodes.columns(Nodal::volume_gradient), nodes.columns(Nodal::mass_position),
                                   nodes.columns(Nodal::mass_displacement),
                                   nodes.template columns<1>(Nodal::volume)};
    const bool any = out.volume_gradient.column[0] || out.mass_position.column[0] ||
                     out.mass_displacement.column[0] || out.volume.column[0];
    if (any)
      scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool) {
        if (!cracks_alone || c.tile->cracked) project_geometry_tile<Dim, Basis>(c, workspace.project, out);
      });
    if (!nodes.has(Nodal::mass_slope)) return;
    NodeColumns<Dim + Dim * Dim> displaced;
    for (int k = 0; k < Dim; ++k) displaced.column[k] = nodes.column(Nodal::mass_offset, k);
    for (int k = 0; k < Dim * Dim; ++k) displaced.column[Dim + k] = nodes.column(Nodal::mass_slope, k);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool) {
      if (!cracks_displaced || c.tile->cracked)
        project_displaced_tile<Dim, Basis>(c, workspace.project, displaced);
    });
  }

  void occupy(State<Dim>& state) override {
    if constexpr (Basis::kSpread > 0) {
      const NodeColumns<1> out = state.nodes.template columns<1>(Nodal::occupied);
      scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool) {
        occupy_tile<Dim, Basis>(c, workspace.project, out);
      });
    }
  }

  void push(State<Dim>& state, const std::vector<Vec<Dim>>& forces) override {
    const NodeColumns<Dim> out = state.nodes.columns(Nodal::force);
    const auto force_of = by_number(state, forces);
    const auto acts_in = [&](const TileContext<Dim>& c) {
      for (int r = c.tile->run_begin; r < c.tile->run_end; ++r)
        if (c.runs[r].on_surface)
          for (std::uint32_t p = c.runs[r].begin; p < c.runs[r].end; ++p)
            if (force_of(c.runs[r], p) != Vec<Dim>::Zero()) return true;
      return false;
    };
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      if (!rigid && acts_in(c)) push_tile<Dim, Basis>(c, workspace.project, force_of, out);
    });
  }

  void settle(State<Dim>& state, const std::vector<Vec<Dim>>& forces, double dt) override {
    const NodeColumns<Dim> in = state.nodes.columns(Nodal::velocity);
    NodeColumns<2 * Dim> out;
    for (int d = 0; d < Dim; ++d) {
      out.column[d] = state.nodes.column(Nodal::momentum, d);
      out.column[Dim + d] = state.nodes.column(Nodal::force, d);
    }
    const auto force_of = by_number(state, forces);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      if (!rigid) settle_tile<Dim, Basis>(c, workspace.project, in, dt, force_of, out);
    });
  }

  bool strain_and_force(State<Dim>& state, double dt_strain, int terms) override {
    const auto velocity = state.nodes.columns(Nodal::velocity), force = state.nodes.columns(Nodal::force);
    inverted_.assign(workspaces_.size(), 0);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      if (rigid) return;
      if (!strain_force(c, workspace, velocity, dt_strain, terms, state, force))
        inverted_[static_cast<std::size_t>(thread_index())] = 1;
    });
    return *std::max_element(inverted_.begin(), inverted_.end()) == 0;
  }

  void xpic(State<Dim>& state, bool paired) override {
    if (paired)
      xpic_columns<2 * Dim>(state);
    else
      xpic_columns<Dim>(state);
  }

  void re_extrapolate(State<Dim>& state, ParticleUpdate update) override {
    auto& nodes = state.nodes;
    const NodeColumns<Dim> in = nodes.columns(update == ParticleUpdate::flip   ? Nodal::force
                                              : update == ParticleUpdate::xpic ? Nodal::star
                                                                               : Nodal::velocity);
    NodeColumns<Dim + 1> out{};
    for (int d = 0; d < Dim; ++d) out.column[d] = nodes.column(Nodal::momentum, d);
    if (nodes.has(Nodal::compression_weight)) out.column[Dim] = nodes.column(Nodal::compression_weight);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      if (!rigid) re_extrapolate_tile<Dim, Basis>(c, workspace.re_extrapolate, update, in, out);
    });
  }

  TileReport update(State<Dim>& state, const UpdateRule& rule, const Vec<Dim>& lower,
                    const Vec<Dim>& upper) override {
    return rule.velocity == ParticleUpdate::xpic ? update_columns<3>(state, rule, lower, upper)
                                                 : update_columns<2>(state, rule, lower, upper);
  }

  void project_heat(State<Dim>& state, HeatScale scale) override {
    auto& nodes = state.nodes;
    for (auto& workspace : workspaces_)
      if (!workspace->heat) workspace->heat = std::make_unique<HeatWorkspace<Dim, Basis>>();
    NodeColumns<Dim + 2> content;
    content.column[0] = nodes.column(Nodal::heat_capacity);
    set_led(nodes, content.column + 1);
    NodeColumns<1 + Dim> flow{{nodes.column(Nodal::heat_flow)}};
    for (int d = 0; d < Dim; ++d)
      flow.column[1 + d] =
          nodes.has(Nodal::conducting_surface) ? nodes.column(Nodal::conducting_surface, d) : nullptr;
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool) {
      project_heat_tile<Dim, Basis>(c, *workspace.heat, scale, content, flow);
    });
  }

  void filter_heat(State<Dim>& state) override {
    const NodeColumns<1> in = state.nodes.template columns<1>(Nodal::temperature_filter);
    NodeColumns<Dim + 1> out;
    set_led(state.nodes, out.column);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool) {
      filter_heat_tile<Dim, Basis>(c, *workspace.heat, in, out);
    });
  }

  HeatReport update_heat(State<Dim>& state, HeatScale scale, bool filtered) override {
    auto& nodes = state.nodes;
    const NodeColumns<3> in{
        {nodes.column(Nodal::temperature), nodes.column(Nodal::heat_flow),
         filtered ? nodes.column(Nodal::temperature_series) : nodes.column(Nodal::temperature)}};
    heat_reports_.assign(state.tiling.tiles.size(), {});
    loops_.for_each_deformable(state, [&](const TileContext<Dim>& c, int thread) {
      heat_reports_[static_cast<std::size_t>(c.tile - state.tiling.tiles.data())] =
          update_heat_tile<Dim, Basis>(c, *workspaces_[static_cast<std::size_t>(thread)]->heat, scale,
                                       filtered, in);
    });
    HeatReport all;
    for (const HeatReport& one : heat_reports_) {
      all.stored += one.stored;
      all.worked += one.worked;
      all.sound &= one.sound;
    }
    return all;
  }

  void add_candidates(const TileContext<Dim, DomainView<Dim>>& tile, const NodeBox<Dim>& box,
                      Candidates<Dim>& out) const override {
    mpmfast::add_candidates<Dim, Basis>(tile, box, out);
  }

  void append_covering(const Candidates<Dim>& from, const CandidatePiece<Dim>& piece, double inverse_cell,
                       const NodeIndex<Dim>& node, CloudWorkspace<Dim>& cloud) const override {
    mpmfast::append_covering<Dim, Basis>(from, piece, inverse_cell, node, cloud);
  }

  std::size_t workspace_bytes(int threads) const override {
    return std::min(workspaces_.size(), static_cast<std::size_t>(threads)) * sizeof(Workspace);
  }

 private:
  struct Workspace {
    ProjectWorkspace<Dim, Basis> project;
    XpicWorkspace<Dim, Basis, 2 * Dim> xpic;
    ReExtrapolateWorkspace<Dim, Basis> re_extrapolate;
    UpdateWorkspace<Dim, Basis> update;
    std::unique_ptr<HeatWorkspace<Dim, Basis>> heat;  ///< where a scene has any
  };

  /// Of all particles, whatever their tile and body: what first_node() reads does not differ between these.
  static ChunkGeometry<Dim> geometry_of(const State<Dim>& state) {
    const DomainView<Dim> domains = state.domains();
    const ParticleTile<Dim> nowhere{};
    const ParticleRun<Dim> any{};
    const TileContext<Dim, DomainView<Dim>> c{&domains, &nowhere, &any, state.bodies.data(), &state.grid};
    return chunk_geometry(c, any, 0, static_cast<int>(state.particles.size()));
  }

  static void shape_domain([[maybe_unused]] State<Dim>& state, [[maybe_unused]] std::size_t p) {
    if constexpr (Basis::kConvected) {
      auto& particles = state.particles;
      double f[Dim * Dim], edge[Dim * Dim];
      for (int e = 0; e < Dim * Dim; ++e)
        f[e] = particles.column(Quantity::deformation_gradient, e)[p] * particles.domain_share(p, e % Dim);
      convect_domain<Dim>(f, state.bodies[particles.body()[p]].half_size, state.grid.inverse_cell, edge);
      for (int e = 0; e < Dim * Dim; ++e) particles.column(Quantity::domain_edges, e)[p] = edge[e];
    }
  }

  static auto visitor(const State<Dim>& state) {
    return [&state](int material, const auto& f) {
      std::visit(f, state.materials[static_cast<std::size_t>(material)]);
    };
  }

  /// Calls f(context, workspace, rigid) as TileLoops::for_each_by_colour.
  template <class F>
  void scatter_tiles(State<Dim>& state, F f) {
    loops_.for_each_by_colour(state, [&](const TileContext<Dim>& c, int thread, bool rigid) {
      f(c, *workspaces_[static_cast<std::size_t>(thread)], rigid);
    });
  }

  /// Of a boundary point in a run, what it has by its number.
  static auto by_number(const State<Dim>& state, const std::vector<Vec<Dim>>& of) {
    return [&state, &of, &id = state.particles.id()](const ParticleRun<Dim>& run,
                                                     std::uint32_t p) -> const Vec<Dim>& {
      return of[static_cast<std::size_t>(state.surfaces.number(run.body, id[p]))];
    };
  }

  static bool strain_force(const TileContext<Dim>& c, Workspace& workspace, const NodeColumns<Dim>& velocity,
                           double dt_strain, int terms, const State<Dim>& state,
                           const NodeColumns<Dim>& force) {
    if constexpr (Dim == 2) {
      if (state.plane_kind == PlaneKind::axisymmetric)
        return strain_force_tile<Dim, Basis, PlaneKind::axisymmetric>(
            c, workspace.update, velocity, dt_strain, terms, visitor(state), force);
    }
    return strain_force_tile<Dim, Basis>(c, workspace.update, velocity, dt_strain, terms, visitor(state),
                                         force);
  }

  static bool project_inertia(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                              [[maybe_unused]] bool affine, const NodeColumns<1 + Dim>& out) {
    if constexpr (Basis::kSpread > 0)
      if (affine) return project_affine_tile<Dim, Basis>(c, workspace, out);
    return project_tile<Dim, Basis>(c, workspace, out);
  }

  /// Contents, and their slopes behind them.
  static void set_led(Nodes<Dim>& nodes, double** columns) {
    columns[0] = nodes.column(Nodal::heat_content);
    for (int d = 0; d < Dim; ++d) columns[1 + d] = nodes.column(Nodal::heat_slope, d);
  }

  template <int NC>
  void xpic_columns(State<Dim>& state) {
    const auto in = state.nodes.template columns<NC>(Nodal::star),
               out = state.nodes.template columns<NC>(Nodal::next);
    scatter_tiles(state, [&](const TileContext<Dim>& c, Workspace& workspace, bool rigid) {
      if (rigid) return;
      auto& xpic_workspace = reinterpret_cast<XpicWorkspace<Dim, Basis, NC>&>(workspace.xpic);
      xpic_tile<Dim, Basis, NC>(c, xpic_workspace, in, out);
    });
  }

  template <int NV>
  TileReport update_columns(State<Dim>& state, const UpdateRule& rule, const Vec<Dim>& lower,
                            const Vec<Dim>& upper) {
    NodeColumns<NV * Dim> in;
    for (int d = 0; d < Dim; ++d) {
      in.column[d] = state.nodes.column(Nodal::velocity, d);
      in.column[Dim + d] = state.nodes.column(Nodal::force, d);
      if constexpr (NV == 3) in.column[2 * Dim + d] = state.nodes.column(Nodal::series, d);
    }
    const NodeColumns<Dim> strain = state.nodes.columns(
        state.nodes.has(Nodal::re_extrapolated) ? Nodal::re_extrapolated : Nodal::velocity);
    double low[Dim], high[Dim];
    for (int d = 0; d < Dim; ++d) low[d] = lower[d], high[d] = upper[d];
    reports_.assign(workspaces_.size(), {});
    loops_.for_each_deformable(state, [&](const TileContext<Dim>& c, int thread) {
      const auto at = static_cast<std::size_t>(thread);
      merge(update_tile<Dim, Basis, NV>(c, workspaces_[at]->update, in, strain, rule, low, high,
                                        visitor(state)),
            reports_[at].report);
    });
    TileReport all;
    for (const auto& r : reports_) merge(r.report, all);
    return all;
  }

  static void merge(const TileReport& r, TileReport& sum) {
    sum.fastest = std::max(sum.fastest, r.fastest);
    sum.speed = std::max(sum.speed, r.speed);
    sum.inverted |= r.inverted;
    sum.lost |= r.lost;
  }

  struct alignas(64) ThreadReport {
    TileReport report;
  };
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  TileLoops<Dim> loops_{omp_get_max_threads()};
  std::vector<ThreadReport> reports_;
  std::vector<HeatReport> heat_reports_;  ///< by tile: sums want one order
  std::vector<int> inverted_, outside_;
};

template <int Dim, BasisKind kind>
std::unique_ptr<Passes<Dim>> make_passes_of() {
  return std::make_unique<BasisPasses<Dim, typename BasisOf<kind>::template In<Dim>>>();
}

}  // namespace mpmfast
