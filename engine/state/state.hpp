#pragma once

/// @file All memory of a running scene.

#include <variant>
#include <vector>

#include "engine/state/nodes.hpp"
#include "engine/state/particles.hpp"
#include "engine/state/tiling.hpp"
#include "kernels/materials/linear_elastic.hpp"
#include "kernels/materials/neo_hookean.hpp"

namespace mpmfast {

/// A constitutive law with its parameters. A new law is one more entry here and one in
/// engine/plan/materials.cpp.
using Material = std::variant<NeoHookean, LinearElastic>;

template <int Dim>
struct State {
  Particles<Dim> particles;
  Tiling<Dim> tiling;
  Nodes<Dim> nodes;
  GridView<Dim> grid;
  std::vector<BodyView<Dim>> bodies;
  std::vector<int> body_field;  ///< velocity field of each body
  std::vector<bool> field_rigid;
  std::vector<Material> materials;  ///< as Scene::materials; rigid ones hold a default
  int threads = 1;                  ///< that the passes use
  double time = 0;                  ///< s
  std::uint64_t step = 0;

  int fields() const { return static_cast<int>(field_rigid.size()); }

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
    columns(Quantity::velocity_slopes, v.slopes, Dim * Dim);
    columns(Quantity::mass, &v.mass, 1);
    columns(Quantity::initial_volume, &v.volume, 1);
    columns(Quantity::wave_speed, &v.wave_speed, 1);
    return v;
  }
};

}  // namespace mpmfast
