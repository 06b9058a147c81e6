#pragma once

/// @file The particles' new momenta on the nodes, with this step's weights: what a strain that comes last is
/// taken from with `average+` and `last+` (MUSL; NN §2.8; K24 Alg. 3 lines 6 to 11).
///
/// A particle keeps S a Δt of the grid's acceleration, so the next step begins with v + S⁺S a Δt and not with
/// v⁺ = v + a Δt. Strains from v⁺ hold motion that no particle has: ½ Δt ∇(a − S⁺S a) works as a viscosity on
/// all that the grid hardly resolves. With v′ = S⁺V_new, stresses do the work that the particles' kinetic
/// energy loses: Σ_p M_p V_p·S a Δt + ½ M_p |S a Δt|² = Σ_i f_i·½ (v_i + v′_i) Δt.

#include "kernels/constants.hpp"
#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/affine.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/update_rule.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis>
struct ReExtrapolateWorkspace {
  WeightWorkspace<Dim, Basis> weights;
  Window<Dim, Dim> in;
  Window<Dim, Dim + 1> out;
  Record record[kChunk<Dim>];
  alignas(64) double compression_weight[kChunk<Dim>];
};

/// How far the particles of a chunk are pressed, in `pressed`: from 0 at J = 0.95 to 1 at J = 0.85 and below.
/// (From J = 1 waves switch it: a disk that vibrates then comes apart in 15 turns, which lasts a thousand.)
template <int Dim>
inline void find_compression_weight(const ParticleView<Dim>& p, std::uint32_t begin, int count,
                                    double* compression_weight) {
  for (int k = 0; k < count; k += kLanes) {
    Lanes jacobian;
    if (p.state.volume_ratio) {
      jacobian = load_lanes(p.state.volume_ratio + begin + k);
    } else {
      Lanes f[Dim * Dim];
      for (int e = 0; e < Dim * Dim; ++e) f[e] = load_lanes(p.deformation[e] + begin + k);
      jacobian = determinant<Dim>(f);
      if (p.plane_kind != PlaneKind::plane_strain) jacobian *= load_lanes(p.stretch + begin + k);
    }
    const Lanes share = constants::kCompressionRamp * (constants::kCompressionStart - jacobian);
    store_lanes(compression_weight + k, share > 1.0 ? 1.0 : share < 0.0 ? 0.0 : share);
  }
}

/// One tile: p′_i += Σ_p S_pi M_p V_new.
/// @param velocity  how V_new follows from `in`: FLIP V + Σ S in, with in = aΔt; XPIC Σ S in, with in =
/// m(v − v*) + aΔt; PIC and APIC Σ S in, with in = v⁺ (N20 Eq. 32, 38, 41)
/// @param out  p′, accumulated, kg m/s; then, if there is such a column, the mass that is pressed, kg
template <int Dim, class Basis>
void re_extrapolate_tile(const TileContext<Dim>& c, ReExtrapolateWorkspace<Dim, Basis>& workspace,
                         ParticleUpdate velocity, const NodeColumns<Dim>& in,
                         const NodeColumns<Dim + 1>& out) {
  const ParticleView<Dim>& p = *c.particles;
  const bool weighs_compression = out.column[Dim] != nullptr;
  auto ahead = fetch_ahead<Basis, Dim + Dim * Dim + 1>(p);
  if (velocity == ParticleUpdate::flip) ahead.add(p.velocity);
  if (weighs_compression) ahead.add(p.deformation);
  ahead.add(p.mass);
  load_window(in, *c.tile, workspace.in);
  begin_sums(c, workspace.out, out);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values,
      [&](const auto& w, const ParticleRun<Dim>& run, std::uint32_t begin, int count) {
        ahead.start_at(begin + static_cast<std::uint32_t>(count));
        if (weighs_compression) find_compression_weight(p, begin, count, workspace.compression_weight);
        const bool keeps = velocity == ParticleUpdate::flip;  // V, to which the grid adds
        pack<Dim + 1>(count, workspace.record, 0, [&](int d, int k) {
          if (d == Dim)
            return weighs_compression ? detail::load_row(workspace.compression_weight + k) : Row{};
          return keeps ? detail::load_row(p.velocity[d < Dim ? d : 0] + begin + k) : Row{};
        });
        gather_chunk_values(w, count, workspace.in.at[0], [&](int k, Record v) {
          ahead(k);
          const auto m = static_cast<Real>(p.mass[begin + static_cast<std::uint32_t>(k)]);
          if constexpr (Basis::kSpread > 0) {
            if (velocity == ParticleUpdate::apic) {
              scatter_affine<Dim, Basis>(c, run, w, begin, count, k, m, v, workspace.in.at[0],
                                         workspace.out.at[0]);
              return;
            }
          }
          workspace.record[k] = m * (v + workspace.record[k]);
        });
        if (Basis::kSpread > 0 && velocity == ParticleUpdate::apic) return;
        scatter_chunk_values(w, count, workspace.record, workspace.out.at[0]);
      });
  end_sums(c, workspace.out, out);
}

}  // namespace mpmfast
