#pragma once

/// @file Particles to nodes: mass, momentum and internal force, and what grid-based contact asks for beside
/// them.

#include <cstring>

#include "kernels/materials/kinematics.hpp"
#include "kernels/transfer/stress.hpp"
#include "kernels/transfer/sums.hpp"
#include "kernels/transfer/window.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// Of a node's record: mass and momentum, nothing in 2-D, and the force; in 2-D this is in two parts, those
/// that come with ∂/∂x and with ∂/∂y.
template <int Dim>
inline constexpr int kLoadEntries = Dim == 2 ? 8 : 7;

template <int Dim, class Basis>
struct ProjectWorkspace {
  using LoadWindow = Window<Dim, kLoadEntries<Dim>>;
  WeightWorkspace<Dim, Basis> weights;
  Window<Dim, 1 + Dim> mass_momentum;
  LoadWindow load;
  Window<Dim, Dim> gradient_volume, mass_position, mass_displacement;
  Window<Dim, 1> volume;
  Window<Dim, Dim + Dim * Dim> displaced;
  Window<Dim, 2 * Dim> given;  ///< what boundary points give to the grid
  Record record[kChunk<Dim>];
  // Entries that are never set stay zero: those of the other half of a wide record.
  typename LoadWindow::Node inertia[kChunk<Dim>], stress[kGradientRecords<Dim>][kChunk<Dim>];
};

namespace detail {

/// Mass and momentum of a chunk of particles as records.
template <int Dim, class R>
inline void pack_inertia(const ParticleView<Dim>& p, std::uint32_t begin, int count, R* out) {
  pack<1 + Dim>(count, out, 0, [&](int c, int k) {
    const Row mass = load_row(p.mass + begin + k);
    return c == 0 ? mass : mass * load_row(p.velocity[c > 0 ? c - 1 : 0] + begin + k);
  });
}

}  // namespace detail

/// What mass and momentum are made of, and N columns.
template <class Basis, int N, int Dim>
inline auto fetch_inertia(const ParticleView<Dim>& p) {
  auto ahead = fetch_ahead<Basis, Dim + 1 + N>(p);
  ahead.add(p.velocity);
  ahead.add(p.mass);
  return ahead;
}

/// Nodal mass and momentum of one tile (N20 Eq. 5): m_i = Σ S_pi M_p, p_i = Σ S_pi M_p V_p.
/// @param out  mass, momentum; accumulated
/// @return     false if the tile must be sorted anew (out is then untouched)
template <int Dim, class Basis>
bool project_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                  const NodeColumns<1 + Dim>& out) {
  auto ahead = fetch_inertia<Basis, 0>(*c.particles);
  begin_sums(c, workspace.mass_momentum, out);
  const bool inside = for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        ahead.start_at(begin + static_cast<std::uint32_t>(count));
        detail::pack_inertia(*c.particles, begin, count, workspace.record);
        scatter_chunk_values(w, count, workspace.record, workspace.mass_momentum.at[0], ahead);
      });
  if (inside) end_sums(c, workspace.mass_momentum, out);
  return inside;
}

/// As project_tile, with the internal force f_i −= Σ_p V_p0 τ_p·G_pi beside: for stresses that the step does
/// not change before its forces. (Flattened, as update_tile.)
/// @param out  see kLoadEntries; accumulated
template <int Dim, class Basis>
[[gnu::flatten]] bool project_force_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                                         const NodeColumns<kLoadEntries<Dim>>& out) {
  const ParticleView<Dim>& p = *c.particles;
  auto& at = workspace.load.at;
  constexpr bool wide = ProjectWorkspace<Dim, Basis>::LoadWindow::kRecords == 1;
  constexpr bool single = wide && Dim == 2;  // one record has all of a particle
  auto ahead = fetch_inertia<Basis, kSymmetric<Dim> + 1>(p);
  ahead.add(p.stress);
  ahead.add(p.volume);
  begin_sums(c, workspace.load, out);
  const bool inside = for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::both, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        ahead.start_at(begin + static_cast<std::uint32_t>(count));
        detail::pack_inertia(p, begin, count, workspace.inertia);
        pack_stress(p, stress_columns(p, begin), begin, count, wide ? 1 : 0,
                    single ? &workspace.inertia : workspace.stress);
        if constexpr (single) {
          scatter_chunk_pairs(w, count, workspace.inertia, at[0], ahead);
        } else if constexpr (wide) {
          for_each_apart(count, [&](int k) {
            ahead(k);
            scatter(w, k, workspace.inertia[k],
                    {workspace.stress[0][k], workspace.stress[1][k], workspace.stress[2][k]}, at[0]);
          });
        } else {
          scatter_chunk_values(w, count, workspace.inertia, at[0], ahead);
          scatter_stress<Dim>(w, count, workspace.stress, at[1]);
        }
      });
  if (inside) end_sums(c, workspace.load, out);
  return inside;
}

/// What grid-based contact asks for; null columns are not wanted.
template <int Dim>
struct GeometryColumns {
  NodeColumns<Dim> volume_gradient;    ///< g_i = Σ G_pi V_p: out of the material (G_pi turns from p to i)
  NodeColumns<Dim> mass_position;      ///< Σ S_pi M_p X_p, relative to the grid's origin
  NodeColumns<Dim> mass_displacement;  ///< Σ S_pi M_p (X_p − X_p0)
  NodeColumns<1> volume;               ///< Σ S_pi V_p
};

/// J V_p0 as surfaces see it: of planes that stretch along their normal, at the undeformed depth; of rings,
/// the section (the volume of a turn grows with the radius, inside a body too).
template <int Dim>
inline double section_volume(const ParticleView<Dim>& p, std::uint32_t q) {
  double f[Dim * Dim];
  for (int e = 0; e < Dim * Dim; ++e) f[e] = p.deformation[e][q];
  const double volume = p.volume[q] * determinant<Dim>(f);
  const bool ring = Dim == 2 && p.plane_kind == PlaneKind::axisymmetric;
  return ring ? volume * p.stretch[q] / (kFullTurn * p.position[0][q]) : volume;
}

/// The sums that gradient normals, volume screening, contact areas and grid-based separations are made of
/// (theory §2).
template <int Dim, class Basis>
void project_geometry_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                           const GeometryColumns<Dim>& out) {
  const ParticleView<Dim>& p = *c.particles;
  const bool displaced = out.mass_displacement.column[0];
  clear(workspace.gradient_volume);
  clear(workspace.mass_position);
  clear(workspace.mass_displacement);
  clear(workspace.volume);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::both, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          const auto volume = static_cast<Real>(section_volume<Dim>(p, q));
          const double m = p.mass[q];  // m³ (of rings the section, m²) and kg
          Record x{}, u{};
          Record unit[Dim] = {};
          for (int d = 0; d < Dim; ++d) {
            x[d] = static_cast<Real>(m * (p.position[d][q] - c.grid->origin[d]));
            if (displaced) u[d] = static_cast<Real>(m * (p.position[d][q] - p.reference_position[d][q]));
            unit[d][d] = volume;
          }
          if (out.mass_position.column[0]) scatter_values(w, k, x, workspace.mass_position.at[0]);
          if (out.volume.column[0]) scatter_values(w, k, Record{volume}, workspace.volume.at[0]);
          if (displaced) scatter_values(w, k, u, workspace.mass_displacement.at[0]);
          if (out.volume_gradient.column[0]) scatter_gradients(w, k, unit, workspace.gradient_volume.at[0]);
        }
      });
  const auto flush = [&](auto& window, const auto& columns) {
    if (columns.column[0]) flush_window(window, *c.tile, columns);
  };
  flush(workspace.gradient_volume, out.volume_gradient);
  flush(workspace.mass_position, out.mass_position);
  flush(workspace.mass_displacement, out.mass_displacement);
  flush(workspace.volume, out.volume);
}

/// Displacements for interfaces, exact at a node where they are linear, on whichever side of it the particles
/// lie: Σ S_pi M_p (u_p + H_p (x_i − X_p)), H = ∂u/∂x = I − F₀F⁻¹, as the part that is not of x_i and the sum
/// of M_p H_p. (Means alone, Σ S_pi M_p u_p, are those of the places where the particles lie: the jump
/// between two bodies that are strained by ε then errs by ε times what these places differ by.)
/// @param out  Nodal::mass_offset, mass_slope; accumulated
template <int Dim, class Basis>
void project_displaced_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                            const NodeColumns<Dim + Dim * Dim>& out) {
  using Displaced = Window<Dim, Dim + Dim * Dim>;
  using Node = typename Displaced::Node;
  Displaced& window = workspace.displaced;
  const ParticleView<Dim>& p = *c.particles;
  const bool turned = p.initial_deformation[0];
  clear(window);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k) {
          const std::uint32_t q = begin + static_cast<std::uint32_t>(k);
          double f[Dim * Dim], inverse[Dim * Dim], back[Dim * Dim];  // ∂X/∂x = F₀ F⁻¹
          for (int e = 0; e < Dim * Dim; ++e) f[e] = p.deformation[e][q];
          invert<Dim>(f, inverse);
          for (int i = 0; i < Dim; ++i)
            for (int j = 0; j < Dim; ++j) {
              back[i * Dim + j] = turned ? 0 : inverse[i * Dim + j];
              for (int l = 0; turned && l < Dim; ++l)
                back[i * Dim + j] += p.initial_deformation[i * Dim + l][q] * inverse[l * Dim + j];
            }
          alignas(Node) Real entries[Displaced::kRecords * Displaced::kPerNode] = {};
          const auto set = [&](int entry, double value) {
            entries[entry] = static_cast<Real>(p.mass[q] * value);
          };
          for (int d = 0; d < Dim; ++d) {
            double offset = p.position[d][q] - p.reference_position[d][q];
            for (int j = 0; j < Dim; ++j) {
              const double slope = (d == j) - back[d * Dim + j];
              offset -= slope * (p.position[j][q] - c.grid->origin[j]);
              set(Dim + d * Dim + j, slope);
            }
            set(d, offset);
          }
          for (int r = 0; r < Displaced::kRecords; ++r) {
            Node record;
            std::memcpy(&record, entries + r * Displaced::kPerNode, sizeof record);
            scatter_values(w, k, record, window.at[r]);
          }
        }
      });
  flush_window(window, *c.tile, out);
}

/// The volume of the particles of each cell of the basis, at the first node of their supports: what share of
/// it is filled (K24 §3.3).
template <int Dim, class Basis>
void occupy_tile(const TileContext<Dim>& c, ProjectWorkspace<Dim, Basis>& workspace,
                 const NodeColumns<1>& out) {
  clear(workspace.volume);
  for_each_chunk<Dim, Basis>(
      c, workspace.weights, Wanted::values, [&](const auto& w, const auto&, std::uint32_t begin, int count) {
        for (int k = 0; k < count; ++k)
          workspace.volume.at[0][w.first[k]][0] +=
              static_cast<Real>(section_volume<Dim>(*c.particles, begin + static_cast<std::uint32_t>(k)));
      });
  flush_window(workspace.volume, *c.tile, out);
}

}  // namespace mpmfast
