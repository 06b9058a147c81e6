#pragma once

/// @file Heat between particles and nodes, with the weights of the step: what particles bring, what
/// conduction makes of it, and how they take the temperatures of the nodes.
///
/// A particle has a temperature T_p and the slope g_p = ∇T that the grid had there at the end of the last
/// step. Led to the node along it,
///   C_i T_i = Σ_p S_pi C_p (T_p + g_p·(x_i − X_p)),  C_p = M_p c,
/// temperatures of nodes are exact where they are linear, on whichever side of a node its particles lie: at
/// surfaces too, where means of particles are those of half a cell further in. Heat is conserved, since
/// Σ_i S_pi x_i = X_p. Conduction brings Q_i = −Σ_p V_p k g_p·G_pi, which sums to nothing.

#include <cstring>

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/simd/math.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct HeatWorkspace {
  WeightWorkspace<Dim, Basis> weights;
  Window<Dim, Dim + 2> content;
  Window<Dim, Dim + 1> filtered;
  Window<Dim, 1 + Dim> flow;
  Window<Dim, 1> temperature;
  Window<Dim, 3> update;
};

/// Temperatures are counted from that of the scene, K: what is left of round-off is that of differences.
struct HeatScale {
  double reference;
};

namespace detail {

/// window_i += S_pi entries.
template <int Dim, int NC, class Weights>
inline void scatter_entries(const Weights& w, int k, const double (&entries)[NC], Window<Dim, NC>& window) {
  using Layout = Window<Dim, NC>;
  using Node = typename Layout::Node;
  alignas(Node) Real padded[Layout::kRecords * Layout::kPerNode] = {};
  for (int c = 0; c < NC; ++c) padded[c] = static_cast<Real>(entries[c]);
  for (int r = 0; r < Layout::kRecords; ++r) {
    Node record;
    std::memcpy(&record, padded + r * Layout::kPerNode, sizeof record);
    scatter_values(w, k, record, window.at[r]);
  }
}

/// J V_p0, at most 2 V_p0, which steps are stable for: of planes that stretch along their normal with that,
/// of rings the whole turn.
template <int Dim>
inline double current_volume(const ParticleView<Dim>& p, std::uint32_t q) {
  double ratio;
  if (p.state.volume_ratio) {
    ratio = p.state.volume_ratio[q];
  } else {
    double f[Dim * Dim];
    for (int e = 0; e < Dim * Dim; ++e) f[e] = p.deformation[e][q];
    ratio = p.stretch ? p.stretch[q] * determinant<Dim>(f) : determinant<Dim>(f);
  }
  return p.volume[q] * (ratio < 2 ? ratio : 2);
}

/// The part of a temperature at X that does not hang on the node, T − g·X, then g, both times `capacity`.
template <int Dim, class Slope>
inline void lead(const TileContext<Dim>& c, std::uint32_t q, double capacity, double temperature,
                 const Slope& slope, double* out) {
  for (int d = 0; d < Dim; ++d) {
    temperature -= slope(d) * (c.particles->position[d][q] - c.grid->origin[d]);
    out[1 + d] = capacity * slope(d);
  }
  out[0] = capacity * temperature;
}

}  // namespace detail

/// One tile.
/// @param content  Nodal::heat_capacity, heat_content, heat_slope, J/K, J, J/m; accumulated
/// @param flow     Nodal::heat_flow by conduction, W, and conducting_surface, W/K; accumulated
template <int Dim, class Basis>
void project_heat_tile(const TileContext<Dim>& c, HeatWorkspace<Dim, Basis>& workspace, HeatScale scale,
                       const NodeColumns<Dim + 2>& content, const NodeColumns<1 + Dim>& flow) {
  const ParticleView<Dim>& p = *c.particles;
  clear(workspace.content);
  clear(workspace.flow);
  for_each_chunk<Dim, Basis>(c, workspace.weights, Wanted::both,
                             [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
                               const BodyHeat& heat = c.bodies[run.body].heat;
                               for (int k = 0; k < count; ++k) {
                                 const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
                                 const auto slope = [&](int d) { return p.temperature_slope[d][q]; };
                                 double entries[Dim + 2] = {p.mass[q] * heat.capacity};
                                 detail::lead(c, q, entries[0], p.state.temperature[q] - scale.reference,
                                              slope, entries + 1);
                                 detail::scatter_entries<Dim>(w, k, entries, workspace.content);
                                 if (heat.conductivity == 0) continue;
                                 const double conducts = -detail::current_volume(p, q) * heat.conductivity;
                                 Record along[Dim];
                                 for (int d = 0; d < Dim; ++d) {
                                   along[d] = Record{static_cast<Real>(conducts * slope(d))};
                                   along[d][1 + d] = static_cast<Real>(-conducts);
                                 }
                                 Record hoop{};  // sections of rings grow with r: that is no surface
                                 if (Dim == 2 && p.plane_kind == PlaneKind::axisymmetric)
                                   hoop[1] = static_cast<Real>(-conducts / p.position[0][q]);
                                 scatter(w, k, hoop, along, workspace.flow.at[0]);
                               }
                             });
  flush_window(workspace.content, *c.tile, content);
  flush_window(workspace.flow, *c.tile, flow);
}

/// One tile of what B makes of nodal temperatures T: Σ_p S_pi C_p (S T + (G T)·(x_i − X_p)), to be divided by
/// C_i as project_heat_tile's.
/// @param out  Nodal::heat_content, heat_slope; accumulated
template <int Dim, class Basis>
void filter_heat_tile(const TileContext<Dim>& c, HeatWorkspace<Dim, Basis>& workspace,
                      const NodeColumns<1>& in, const NodeColumns<Dim + 1>& out) {
  const ParticleView<Dim>& p = *c.particles;
  load_window(in, *c.tile, workspace.temperature);
  clear(workspace.filtered);
  for_each_chunk<Dim, Basis>(c, workspace.weights, Wanted::both,
                             [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
                               const double capacity = c.bodies[run.body].heat.capacity;
                               for (int k = 0; k < count; ++k) {
                                 const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
                                 Record gradient[Dim];
                                 const double value = gather(w, k, workspace.temperature.at[0], gradient)[0];
                                 double entries[Dim + 1];
                                 detail::lead(
                                     c, q, p.mass[q] * capacity, value, [&](int d) { return gradient[d][0]; },
                                     entries);
                                 detail::scatter_entries<Dim>(w, k, entries, workspace.filtered);
                               }
                             });
  flush_window(workspace.filtered, *c.tile, out);
}

/// What heat did to the particles of a tile, J.
struct HeatReport {
  double stored = 0;  ///< went into the internal energy of equations of state
  double worked = 0;  ///< went into elastic energy by expansion, −Σ V0 tr τ d(ln θ)
  bool sound = true;  ///< all temperatures are positive numbers
};

/// One tile: T_p ← T_p + S ΔT, or S T where temperatures are filtered; g_p ← G T; thermal stretches θ =
/// exp(α (T − T_start)).
/// @param in  T from the scene's, ΔT, the filtered T; K. Slopes are those of T and not of T + ΔT: what warms
/// a node of hardly any capacity is much, of which S takes little and G does not.
template <int Dim, class Basis>
HeatReport update_heat_tile(const TileContext<Dim>& c, HeatWorkspace<Dim, Basis>& workspace, HeatScale scale,
                            bool filtered, const NodeColumns<3>& in) {
  const ParticleView<Dim>& p = *c.particles;
  HeatReport report;
  load_window(in, *c.tile, workspace.update);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::both,
      [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        const BodyHeat& heat = c.bodies[run.body].heat;
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          Record gradient[Dim];
          const Record value = gather(w, k, workspace.update.at[0], gradient);
          double& temperature = p.state.temperature[q];
          const double rise = filtered ? value[2] + scale.reference - temperature : value[1];
          temperature += rise;
          for (int d = 0; d < Dim; ++d) p.temperature_slope[d][q] = gradient[d][0];
          report.sound &= temperature > 0 && temperature < constants::kMostSound;
          if (heat.stored > 0) {
            p.state.internal_energy[q] += heat.stored * rise;
            report.stored += p.volume[q] * heat.stored * rise;
          }
          if (!p.state.thermal_stretch) continue;
          const double stretch = exponential(heat.expansion * (temperature - heat.start));
          const double pull = p.stress[0][q] + p.stress[1][q] + p.stress[2][q];
          report.worked -= p.volume[q] * pull * logarithm(stretch / p.state.thermal_stretch[q]);
          if (heat.elastic_volume) {
            const double ratio = p.state.thermal_stretch[q] / stretch;
            for (double* strain : p.state.elastic_strain) strain[q] *= ratio * ratio;
          }
          p.state.thermal_stretch[q] = stretch;
        }
      });
  return report;
}

}  // namespace mpmfast
