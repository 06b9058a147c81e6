#pragma once

/// @file Nodes to particles: velocities, positions, and (strain last) strains at the end of a step (theory
/// §3).

#include "kernels/transfer/affine.hpp"
#include "kernels/transfer/move.hpp"
#include "kernels/transfer/strain_force.hpp"
#include "kernels/transfer/update_rule.hpp"

namespace mpmfast {

/// Of a node's record: v⁺ and a Δt, in 2-D what the strain is taken from twice for its gradient, and for XPIC
/// m(v − v*).
template <int Dim>
constexpr int update_entries(int vectors) {
  return Dim * (vectors + (Dim == 2 ? 2 : 0));
}

/// The columns of these entries.
/// @param vectors v⁺, a Δt and the third, if there is one; @param strain what the strain is taken from (2-D)
template <int Dim, int NV>
inline auto entry_columns(const NodeColumns<NV * Dim>& vectors, const NodeColumns<Dim>& strain) {
  NodeColumns<update_entries<Dim>(NV)> entries;
  int at = 0;
  const auto add = [&](int vector) {
    for (int d = 0; d < Dim; ++d) entries.column[at++] = vectors.column[Dim * vector + d];
  };
  for (int vector : {0, 1}) add(vector);
  if (Dim == 2)
    for (int copy = 0; copy < 2; ++copy)
      for (double* column : strain.column) entries.column[at++] = column;
  if (NV == 3) add(NV - 1);
  return entries;
}

/// What a chunk gathers of NC nodal entries.
template <int Dim, int NC>
struct GatherWorkspace {
  Window<Dim, NC> window;
  using Node = typename Window<Dim, NC>::Node;
  Node value[Window<Dim, NC>::kRecords][kChunk<Dim>];
  Node slope[Dim][kChunk<Dim>];  ///< ∂/∂x_d of the first record (3-D); moments about the particle
};

template <int Dim, class Basis>
struct UpdateWorkspace : StrainForceWorkspace<Dim, Basis> {
  GatherWorkspace<Dim, update_entries<Dim>(2)> two;
  GatherWorkspace<Dim, update_entries<Dim>(3)> three;
  alignas(64) double value[Dim == 2 ? 8 : 16][kChunk<Dim>];  ///< the vectors by component
};

/// The nodal vectors of a chunk by component in workspace.value, and the gradient of v⁺ in workspace.gradient
/// if it is wanted: in 2-D from the pairs beside the values.
template <int NC, class Weights, class Workspace>
inline void gather_chunk(const Weights& w, int count, bool gradient, GatherWorkspace<2, NC>& from,
                         Workspace& workspace) {
  constexpr int last = Window<2, NC>::kRecords - 1, pairs = 4 / Window<2, NC>::kPerNode;
  for (int r = 0; r <= last; ++r)
    if (gradient && r == pairs)
      gather_chunk_pairs(w, count, from.window.at[r], from.value[r]);
    else
      gather_chunk_values(w, count, from.window.at[r], [&](int k, auto sum) { from.value[r][k] = sum; });
  unpack<2, 4>(from.value[0], count, workspace.value);
  if (NC > 8) unpack<2, 4>(from.value[last], count, workspace.value + 4);
  if (gradient) unpack_pairs(from.value[pairs], count, 1 - pairs, workspace);
}

template <int NC, class Weights, class Workspace>
inline void gather_chunk(const Weights& w, int count, bool gradient, GatherWorkspace<3, NC>& from,
                         Workspace& workspace) {
  if (gradient) {
    for (int k = 0; k < count; ++k) {
      typename GatherWorkspace<3, NC>::Node slope[3];
      from.value[0][k] = gather(w, k, from.window.at[0], slope);
      for (int d = 0; d < 3; ++d) from.slope[d][k] = slope[d];
    }
    for (int d = 0; d < 3; ++d) unpack<3, 3>(from.slope[d], count, &workspace.gradient[4 * d]);
  }
  for (int r = gradient ? 1 : 0; r < from.window.kRecords; ++r)
    for (int k = 0; k < count; ++k) from.value[r][k] = gather_values(w, k, from.window.at[r]);
  for (int r = 0; r < from.window.kRecords; ++r)
    unpack<3, Window<3, NC>::kPerNode>(from.value[r], count, &workspace.value[from.window.kPerNode * r]);
}

/// One tile. FLIP: V ← V + S aΔt; PIC: V ← S v⁺ (N20 Eq. 38); XPIC: V ← m S(v − v*) + S aΔt (Eq. 41; FMPM
/// alike); APIC: as PIC, and the slopes about the particle. Positions: grid_end X ← X + Δt S v⁺; grid X ← X +
/// Δt(S v⁺ − ½ S aΔt); trapezoid ½(V_old + V_new); particle V_new. (Flattened: so much in one function, the
/// compiler would call what costs less than the call.)
/// @param nodes  v⁺ (or what moves particles in its place: re_extrapolate.hpp), aΔt (and m(v − v*) when NV is
/// 3)
/// @param strain  what the strain is taken from: v⁺, or v′ (re_extrapolate.hpp)
/// @param lower, upper  box that particles must stay in, m
template <int Dim, class Basis, int NV, class VisitMaterial>
[[gnu::flatten]] TileReport update_tile(const TileContext<Dim>& c, UpdateWorkspace<Dim, Basis>& workspace,
                                        const NodeColumns<NV * Dim>& nodes, const NodeColumns<Dim>& strain,
                                        const UpdateRule& rule, const double (&lower)[Dim],
                                        const double (&upper)[Dim], const VisitMaterial& visit_material) {
  const ParticleView<Dim>& p = *c.particles;
  const bool strains = rule.dt_strain > 0, hoop = Dim == 2 && p.plane_kind == PlaneKind::axisymmetric;
  // In 2-D the gradient comes with the values, from pairs beside them; what else asks for v′ has it here.
  const bool apart = strains && strain.column[0] != nodes.column[0] && (Dim == 3 || hoop);
  TileReport report;
  LaneReport lanes;
  auto& from = [&]() -> auto& {
    if constexpr (NV == 2)
      return workspace.two;
    else
      return workspace.three;
  }
  ();
  if (Dim == 2 && c.next) fetch_rows<Dim>(nodes, *c.next, 1);  // in 3-D it gains nothing
  load_window(entry_columns<Dim, NV>(nodes, strain), *c.tile, from.window);
  if (apart) load_window(for_gradients(strain), *c.tile, workspace.velocity);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, strains ? Wanted::both : Wanted::values,
      [&](auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        gather_chunk(w, count, strains && !(Dim == 3 && apart), from, workspace);
        if (strains) {
          if (Dim == 3 && apart) gather_velocity_gradient<Dim>(w, count, workspace.velocity.at[0], workspace);
          if (hoop && apart)
            gather_hoop_rate(p, w, begin, count, workspace.velocity.at[0], workspace);
          else if (hoop)
            for (int k = 0; k < count; k += kLanes)  // S v⁺_r / r
              store_lanes(&workspace.hoop_rate[k],
                          load_lanes(&workspace.value[0][k]) / load_lanes(p.position[0] + begin + k));
          visit_material(c.bodies[run.body].material, [&]<class Law>(const Law& law) {
            report.inverted |=
                !(rule.stresses || !stress_can_wait<Law>(p)
                      ? strain_chunk<Dim>(p, law, begin, count, rule.dt_strain, rule.terms, workspace,
                                          stress_columns(p, begin))
                      : deform_chunk<Dim>(p, begin, count, rule.dt_strain, rule.terms, workspace));
          });
        }
        if constexpr (Basis::kSpread > 0 && NV == 2) {
          if (rule.velocity == ParticleUpdate::apic)
            gather_slopes<Dim, Basis>(c, run, w, begin, count, from, workspace.gradient);
        }
        move_chunk<Dim, Basis::kConvected>(c, run.body, begin, count, workspace.value, rule, lower, upper,
                                           lanes);
      });
  lanes.add_to(report);
  return report;
}

}  // namespace mpmfast
