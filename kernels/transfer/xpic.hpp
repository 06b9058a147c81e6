#pragma once

/// @file One order of the XPIC(m) recursion (N20 Eq. 43, 44): nodes → particles → nodes.

#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

template <int Dim, class Basis, int NC>
struct XpicWorkspace {
  WeightWorkspace<Dim, Basis> weights;
  Window<Dim, NC> in, out;
};

/// out_i += Σ_p S_pi M_p (Σ_j S_pj in_j) for NC nodal columns: v* alone (NC = Dim), or v* and Δv* fused (NC =
/// 2 Dim). Divided by the nodal mass this is S⁺ S.
template <int Dim, class Basis, int NC>
void xpic_tile(const TileContext<Dim>& c, XpicWorkspace<Dim, Basis, NC>& workspace, const NodeColumns<NC>& in,
               const NodeColumns<NC>& out) {
  const ParticleView<Dim>& p = *c.particles;
  auto ahead = fetch_ahead<Basis, 1>(p);
  ahead.add(p.mass);
  load_window(in, *c.tile, workspace.in);
  begin_sums(c, workspace.out, out);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        ahead.start_at(begin + static_cast<std::uint32_t>(count));
        for (int k = 0; k < count; ++k) {
          ahead(k);
          for (int r = 0; r < workspace.in.kRecords; ++r) {
            const auto a = gather_values(w, k, workspace.in.at[r]);
            scatter_values(w, k, static_cast<Real>(p.mass[begin + static_cast<std::uint32_t>(k)]) * a,
                           workspace.out.at[r]);
          }
        }
      });
  end_sums(c, workspace.out, out);
}

}  // namespace mpmfast
