#include "engine/plan/seed.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/scene/diagnostic.hpp"
#include "engine/scene/geometry.hpp"
#include "engine/scene/time_table.hpp"

namespace mpmfast {

namespace {

Material make_material(const MaterialSpec& spec) {
  if (const auto* m = std::get_if<NeoHookeanSpec>(&spec.model))
    return NeoHookean{m->density, m->bulk, m->shear};
  if (const auto* m = std::get_if<LinearElasticSpec>(&spec.model)) {
    const double shear = m->young / (2 * (1 + m->poisson));
    return LinearElastic{m->density, m->young * m->poisson / ((1 + m->poisson) * (1 - 2 * m->poisson)),
                         shear};
  }
  return NeoHookean{};
}

double density_of(const MaterialSpec& spec) {
  return std::visit([](const auto& m) { return m.density; }, spec.model);
}

[[noreturn]] void refuse(const Scene& scene, std::size_t body, std::string message) {
  throw SceneError({Diagnostic{scene.file.string(), 0, 0, fmt::format("bodies.{}", scene.bodies[body].name),
                               std::move(message), ""}});
}

/// Calls f(law, first particle, F by lanes) for the whole state, particle by particle.
template <int Dim, class F>
void for_each_deformable(const State<Dim>& state, const F& f) {
  for (std::size_t p = 0; p < state.particles.size(); ++p) {
    const auto& body = state.bodies[state.particles.body()[p]];
    if (body.rigid) continue;
    double deformation[Dim * Dim];
    for (int e = 0; e < Dim * Dim; ++e)
      deformation[e] = state.particles.column(Quantity::deformation_gradient, e)[p];
    std::visit([&](const auto& law) { f(p, law, deformation); },
               state.materials[static_cast<std::size_t>(body.material)]);
  }
}

}  // namespace

template <int Dim>
void seed(const Scene& scene, const Plan& plan, State<Dim>& state) {
  std::array<int, 3> nodes{1, 1, 1};
  for (std::size_t d = 0; d < Dim; ++d) {
    state.grid.origin[d] = scene.grid.origin[d];
    nodes[d] = static_cast<int>(std::lround(scene.grid.size[d] / scene.grid.cell)) + 1;
  }
  state.grid.cell = scene.grid.cell;
  state.grid.inverse_cell = 1 / scene.grid.cell;
  state.tiling.set_domain(nodes);
  state.body_field = plan.body_field;
  state.field_rigid = plan.field_rigid;
  for (const auto& m : scene.materials) state.materials.push_back(make_material(m));

  std::vector<Seeds> seeds;
  std::size_t count = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    seeds.push_back(fill(scene.bodies[b], scene.grid, Dim));
    count += seeds.back().position.size();
    if (seeds.back().position.empty())
      refuse(scene, b, "no particle lies in the body (it is smaller than the particle spacing)");
    for (const Vec3& x : seeds.back().position)
      for (std::size_t d = 0; d < Dim; ++d)
        if (!(x[d] > scene.grid.origin[d] && x[d] < scene.grid.origin[d] + scene.grid.size[d]))
          refuse(scene, b,
                 fmt::format("a particle at ({:.6g}, {:.6g}, {:.6g}) m lies outside the grid", x[0], x[1],
                             x[2]));
    BodyView<Dim> view;
    for (std::size_t d = 0; d < Dim; ++d) view.half_size[d] = seeds.back().half_size[d];
    view.material = scene.bodies[b].material;
    view.rigid = is_rigid(scene, scene.bodies[b]);
    state.bodies.push_back(view);
  }

  auto& particles = state.particles;
  particles.allocate(count, plan.particle_columns);
  std::size_t p = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    double volume = Dim == 2 ? scene.thickness : 1.0;
    for (std::size_t d = 0; d < Dim; ++d) volume *= 2 * seeds[b].half_size[d];
    const double mass =
        volume * density_of(scene.materials[static_cast<std::size_t>(scene.bodies[b].material)]);
    for (const Vec3& x : seeds[b].position) {
      for (int d = 0; d < Dim; ++d) {
        particles.column(Quantity::position, d)[p] = x[static_cast<std::size_t>(d)];
        if (particles.has(Quantity::reference_position))
          particles.column(Quantity::reference_position, d)[p] = x[static_cast<std::size_t>(d)];
        particles.column(Quantity::velocity, d)[p] = scene.bodies[b].velocity[static_cast<std::size_t>(d)];
        particles.column(Quantity::deformation_gradient, (Dim + 1) * d)[p] = 1;
      }
      particles.column(Quantity::mass)[p] = mass;
      particles.column(Quantity::initial_volume)[p] = volume;
      particles.id()[p] = static_cast<std::uint32_t>(p);
      particles.body()[p] = static_cast<std::uint16_t>(b);
      ++p;
    }
  }
  refresh_stress(state);
}

template <int Dim>
void refresh_stress(State<Dim>& state) {
  for_each_deformable(state, [&](std::size_t p, const auto& law, const double(&f)[Dim * Dim]) {
    double tau[kSymmetric<Dim>], c2;
    law.template stress<Dim>(f, tau, c2);
    for (int s = 0; s < kSymmetric<Dim>; ++s)
      state.particles.column(Quantity::kirchhoff_stress, s)[p] = tau[s];
    state.particles.column(Quantity::wave_speed)[p] = std::sqrt(c2);
  });
}

template <int Dim>
double stored_energy(const State<Dim>& state) {
  std::vector<double> by_id(state.particles.size(), 0.0);
  for_each_deformable(state, [&](std::size_t p, const auto& law, const double(&f)[Dim * Dim]) {
    by_id[state.particles.id()[p]] =
        state.particles.column(Quantity::initial_volume)[p] * law.template energy<Dim>(f);
  });
  double sum = 0;
  for (double w : by_id) sum += w;
  return sum;
}

template void seed<2>(const Scene&, const Plan&, State<2>&);
template void seed<3>(const Scene&, const Plan&, State<3>&);
template void refresh_stress<2>(State<2>&);
template void refresh_stress<3>(State<3>&);
template double stored_energy<2>(const State<2>&);
template double stored_energy<3>(const State<3>&);

}  // namespace mpmfast
