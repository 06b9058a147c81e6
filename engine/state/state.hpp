#pragma once

/// @file All memory of a running scene.

#include <vector>

#include "engine/state/materials.hpp"
#include "engine/state/nodes.hpp"
#include "engine/state/particles.hpp"
#include "engine/state/surfaces.hpp"
#include "engine/state/tiling.hpp"

namespace mpmfast {

template <int Dim>
struct State {
  Particles<Dim> particles;
  Tiling<Dim> tiling;
  Surfaces<Dim> surfaces;  ///< empty: nothing follows any
  Nodes<Dim> nodes;
  GridView<Dim> grid;
  std::vector<BodyView<Dim>> bodies;
  std::vector<int> body_field;  ///< velocity field of each body
  std::vector<bool> field_rigid;
  std::vector<int> field_base;  ///< of sides of cracks the field of the body; of others themselves
  PlaneKind plane_kind = PlaneKind::plane_strain;
  std::vector<Material> materials;  ///< as Scene::materials; rigid ones hold a default
  int threads = 1;                  ///< that the passes use
  double time = 0;                  ///< s
  std::uint64_t step = 0;

  int fields() const { return static_cast<int>(field_rigid.size()); }

  DomainView<Dim> domains() const {
    DomainView<Dim> v{};
    const auto columns = [&](Quantity q, const double** out, int n) {
      for (int k = 0; k < n; ++k) out[k] = particles.has(q) ? particles.column(q, k) : nullptr;
    };
    columns(Quantity::position, v.position, Dim);
    columns(Quantity::deformation_gradient, v.deformation, Dim * Dim);
    columns(Quantity::domain_edges, v.edges, Dim * Dim);
    columns(Quantity::domain_share, v.domain_share, Dim);
    return v;
  }

  ParticleView<Dim> view() {
    ParticleView<Dim> v{};
    const auto columns = [&](Quantity q, double** out, int n) {
      for (int k = 0; k < n; ++k) out[k] = particles.has(q) ? particles.column(q, k) : nullptr;
    };
    columns(Quantity::position, v.position, Dim);
    columns(Quantity::velocity, v.velocity, Dim);
    columns(Quantity::deformation_gradient, v.deformation, Dim * Dim);
    columns(Quantity::kirchhoff_stress, v.stress, kSymmetric<Dim>);
    columns(Quantity::domain_edges, v.edges, Dim * Dim);
    columns(Quantity::reference_position, v.reference_position, Dim);
    columns(Quantity::initial_deformation, v.initial_deformation, Dim * Dim);
    columns(Quantity::domain_share, v.domain_share, Dim);
    columns(Quantity::velocity_slopes, v.slopes, Dim * Dim);
    columns(Quantity::mass, &v.mass, 1);
    columns(Quantity::initial_volume, &v.volume, 1);
    columns(Quantity::wave_speed, &v.wave_speed, 1);
    columns(Quantity::out_of_plane_stretch, &v.stretch, 1);
    columns(Quantity::temperature_slope, v.temperature_slope, Dim);
    columns(Quantity::thermal_stretch, &v.state.thermal_stretch, 1);
    v.plane_kind = plane_kind;
    columns(Quantity::dissipated_energy, &v.state.dissipated, 1);
    columns(Quantity::internal_energy, &v.state.internal_energy, 1);
    columns(Quantity::plastic_strain, &v.state.plastic_strain, 1);
    columns(Quantity::temperature, &v.state.temperature, 1);
    columns(Quantity::elastic_strain, v.state.elastic_strain, kSymmetric<Dim>);
    columns(Quantity::volume_ratio, &v.state.volume_ratio, 1);
    return v;
  }
};

}  // namespace mpmfast
