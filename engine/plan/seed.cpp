#include "engine/plan/seed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/constants.hpp"
#include "engine/geometry/clip.hpp"
#include "engine/geometry/shapes.hpp"
#include "engine/plan/materials.hpp"
#include "engine/plan/surfaces.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/text/diagnostic.hpp"

namespace mpmfast {

namespace {

[[noreturn]] void refuse(const Scene& scene, std::size_t body, std::string message) {
  throw SceneError({Diagnostic{scene.file.string(), 0, 0, fmt::format("bodies.{}", scene.bodies[body].name),
                               std::move(message), ""}});
}

/// Calls f(p, law, F), unless particle p is rigid.
template <int Dim, class F>
void with_law(const State<Dim>& state, std::size_t p, const F& f) {
  const auto& body = state.bodies[state.particles.body()[p]];
  if (body.rigid) return;
  double deformation[Dim * Dim];
  for (int e = 0; e < Dim * Dim; ++e)
    deformation[e] = state.particles.column(Quantity::deformation_gradient, e)[p];
  std::visit([&](const auto& law) { f(p, law, deformation); },
             state.materials[static_cast<std::size_t>(body.material)]);
}

template <int Dim, class F>
void for_each_deformable(const State<Dim>& state, const F& f) {
  for (std::size_t p = 0; p < state.particles.size(); ++p) with_law(state, p, f);
}

/// The evolving state of particle p, as far as its law has columns.
template <class Law, int Dim>
MaterialState<Dim, double> state_of(const StateView<Dim>& columns, std::size_t p) {
  MaterialState<Dim, double> state{};
  if constexpr (Evolving<Law>)
    detail::for_each_state_column<Dim, Law>(columns, state,
                                            [&](const double* column, double& value) { value = column[p]; });
  return state;
}

/// F without what heat has stretched.
template <int Dim, int N>
void cool_at(const StateView<Dim>& columns, std::size_t p, double (&deformation)[N]) {
  if (!columns.thermal_stretch) return;
  for (double& entry : deformation) entry /= columns.thermal_stretch[p];
}

/// 1/θ³, or 1 where heat stretches nothing.
template <int Dim>
double cooled_volume(const StateView<Dim>& columns, std::size_t p) {
  if (!columns.thermal_stretch) return 1;
  const double stretch = columns.thermal_stretch[p];
  return 1 / (stretch * stretch * stretch);
}

/// Calls f(F, evolving state) in the dimensions that a law is asked in: three where the plane stretches along
/// its normal.
template <class Law, int Dim, class F>
auto as_law_sees(const State<Dim>& state, const StateView<Dim>& columns, std::size_t p,
                 const double (&deformation)[Dim * Dim], const F& f) {
  MaterialState<Dim, double> evolving = state_of<Law>(columns, p);
  if constexpr (Evolving<Law>) evolving.volume_ratio = columns.volume_ratio[p] * cooled_volume(columns, p);
  if constexpr (Dim == 2) {
    if (state.plane_kind != PlaneKind::plane_strain || columns.thermal_stretch) {
      double full[9];
      embed(deformation,
            state.plane_kind == PlaneKind::plane_strain
                ? 1.0
                : state.particles.column(Quantity::out_of_plane_stretch)[p],
            full);
      cool_at(columns, p, full);
      return f.template operator()<3>(full, widened(evolving));
    }
  }
  double seen[Dim * Dim];
  std::copy(deformation, deformation + Dim * Dim, seen);
  cool_at(columns, p, seen);
  return f.template operator()<Dim>(seen, evolving);
}

/// Every particle of an evolving law starts at rest.
template <int Dim>
void start_history(State<Dim>& state) {
  const StateView<Dim> columns = state.view().state;
  for_each_deformable(state, [&]<class Law>(std::size_t p, const Law& law, const double(&)[Dim * Dim]) {
    if constexpr (Evolving<Law>) {
      auto rest = resting_state<Dim, double>(law.start_temperature);
      detail::for_each_state_column<Dim, Law>(columns, rest,
                                              [&](double* column, double value) { column[p] = value; });
    }
  });
}

/// Temperatures at the start.
template <int Dim>
void start_heat(State<Dim>& state) {
  auto& particles = state.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::temperature)[p] = state.bodies[particles.body()[p]].heat.start;
    if (particles.has(Quantity::thermal_stretch)) particles.column(Quantity::thermal_stretch)[p] = 1;
  }
}

/// Σ V0 density over all particles in order of their ids; density as for_each_deformable calls it.
template <int Dim, class F>
double sum_by_id(const State<Dim>& state, const F& density) {
  const auto& id = state.particles.id();  // not 0 … n − 1 where particles have left
  std::uint32_t most = 0;
  for (std::size_t p = 0; p < state.particles.size(); ++p) most = std::max(most, id[p]);
  std::vector<double> by_id(std::size_t{most} + 1, 0.0);
  for_each_deformable(state, [&](std::size_t p, const auto& law, const double(&f)[Dim * Dim]) {
    by_id[state.particles.id()[p]] = state.particles.column(Quantity::initial_volume)[p] * density(p, law, f);
  });
  double sum = 0;
  for (double w : by_id) sum += w;
  return sum;
}

/// Of a body that may spin.
Vec3 velocity_at(const BodySpec& body, const Vec3& x) {
  Vec3 out = body.velocity;
  if (!body.rotation) return out;
  const Vec3 &about = body.rotation->about, &axis = body.rotation->axis;
  const double speed = body.rotation->speed.value.front();
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    out[d] += speed * (axis[e] * (x[f] - about[f]) - axis[f] * (x[e] - about[e]));
  }
  return out;
}

/// A domain that lies at an angle (about z) is a turned one: F = R.
template <int Dim>
void turn_domain(Particles<Dim>& particles, std::size_t p, double angle) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  const auto f = [&](int i, int j) -> double& {
    return particles.column(Quantity::deformation_gradient, Dim * i + j)[p];
  };
  f(0, 0) = f(1, 1) = cosine;
  f(1, 0) = sine;
  f(0, 1) = -sine;
}

[[noreturn]] void refuse_outside(const Scene& scene, std::size_t b, const Vec3& x) {
  refuse(scene, b,
         fmt::format("a particle at ({:.6g}, {:.6g}, {:.6g}) m lies outside the grid", x[0], x[1], x[2]));
}

/// Moves a boundary point that round-off has outside the grid to its edge (check_bodies lets bodies stand out
/// by as much). @return whether it is inside then
template <int Dim>
bool move_inside(const GridSpec& grid, Vec3& x) {
  const double slack = constants::plan::kOutsideTolerance * grid.cell;
  for (std::size_t d = 0; d < Dim; ++d) {
    const double inside = std::clamp(x[d], grid.origin[d], grid.origin[d] + grid.size[d]);
    if (!(std::abs(x[d] - inside) <= slack)) return false;
    x[d] = inside;
  }
  return true;
}

/// Whether the outline cuts domains. (Grains of a picture, four cells wide and pressed, hold longer with
/// whole ones.)
bool ends_in_steps(const BodySpec& body, const Seeds& seeds) {
  return seeds.angle.empty() && !std::holds_alternative<BoxShape>(body.shape) &&
         !std::holds_alternative<BitmapShape>(body.shape);
}

/// A domain's volume, m³, and the mass of what fills it, kg.
struct Filling {
  double volume, mass;
};

/// Particle p of body b, unstrained at x. @param share  of a domain that is its own
template <int Dim>
void seed_particle(const BodySpec& body, std::size_t b, const Vec3& x, double share, const Filling& domain,
                   std::size_t p, Particles<Dim>& particles) {
  if (particles.has(Quantity::out_of_plane_stretch)) particles.column(Quantity::out_of_plane_stretch)[p] = 1;
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    particles.column(Quantity::position, d)[p] = x[k];
    if (particles.has(Quantity::domain_share)) particles.column(Quantity::domain_share, d)[p] = 1;
    if (particles.has(Quantity::reference_position))
      particles.column(Quantity::reference_position, d)[p] = x[k];
    particles.column(Quantity::velocity, d)[p] = velocity_at(body, x)[k];
    particles.column(Quantity::deformation_gradient, (Dim + 1) * d)[p] = 1;
  }
  if (particles.has(Quantity::volume_ratio)) particles.column(Quantity::volume_ratio)[p] = 1;
  particles.column(Quantity::mass)[p] = share * domain.mass;
  particles.column(Quantity::initial_volume)[p] = share * domain.volume;
  particles.id()[p] = static_cast<std::uint32_t>(p);
  particles.body()[p] = static_cast<std::uint16_t>(b);
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
  state.plane_kind = plan.plane_kind;
  state.body_field = plan.body_field;
  state.field_rigid = plan.field_rigid;
  state.field_base.clear();
  for (std::size_t f = 0; f < plan.fields.size(); ++f) state.field_base.push_back(static_cast<int>(f));
  for (std::size_t f = 0; f < plan.first_side.size(); ++f)
    for (int side = 0; side < plan.sides[f]; ++side)
      state.field_base[static_cast<std::size_t>(plan.first_side[f] + side)] = static_cast<int>(f);
  if (std::any_of(plan.sides.begin(), plan.sides.end(), [](int sides) { return sides > 0; }))
    state.tiling.set_sides(plan.first_side);
  if (plan.keeps_fits) state.tiling.follow_moves();
  for (const auto& m : scene.materials)
    state.materials.push_back(make_material(m, scene.grid.cell, plan.heat));

  std::vector<Outline> surfaces = outlines(scene, plan);
  if (!surfaces.empty()) state.tiling.part_surfaces();
  std::vector<Seeds> seeds;
  std::size_t count = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    seeds.push_back(fill(scene.bodies[b], scene.grid, Dim));
    if (seeds.back().position.empty())
      refuse(scene, b, "no particle lies in the body (it is smaller than the particle spacing)");
    if (Dim == 2 && !surfaces.empty() && ends_in_steps(scene.bodies[b], seeds.back()))
      clip(surfaces[b], scene.grid.origin, seeds.back());
    count += seeds.back().position.size();
    for (const Vec3& x : seeds.back().position)
      for (std::size_t d = 0; d < Dim; ++d)
        if (!(x[d] > scene.grid.origin[d] && x[d] < scene.grid.origin[d] + scene.grid.size[d]))
          refuse_outside(scene, b, x);
    if (!surfaces.empty()) {
      for (Vec3& x : surfaces[b].points)
        if (!move_inside<Dim>(scene.grid, x)) refuse_outside(scene, b, x);
      add_surface(surfaces[b], static_cast<std::uint32_t>(count), scene.thickness, state.surfaces);
      count += surfaces[b].points.size();
    }
    BodyView<Dim> view;
    for (std::size_t d = 0; d < Dim; ++d) view.half_size[d] = seeds.back().half_size[d];
    view.material = scene.bodies[b].material;
    view.rigid = is_rigid(scene, scene.bodies[b]);
    if (plan.heat) view.heat = body_heat(scene, scene.bodies[b]);
    state.bodies.push_back(view);
  }
  if (!surfaces.empty()) connect_facets(state.surfaces);
  const std::vector<double> areas = tributary_areas(state.surfaces);

  auto& particles = state.particles;
  particles.allocate(count, plan.particle_columns);
  std::size_t p = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    double volume = Dim == 2 ? scene.thickness : 1.0;
    for (std::size_t d = 0; d < Dim; ++d) volume *= 2 * seeds[b].half_size[d];
    const double density = density_of(scene.materials[static_cast<std::size_t>(scene.bodies[b].material)]);
    const Filling domain{volume, volume * density};
    // Axisymmetric particles are rings of a full turn.
    const auto around = [&](const Vec3& x) {
      return plan.plane_kind == PlaneKind::axisymmetric ? kFullTurn * x[0] : 1.0;
    };
    const auto share_of = [&](std::size_t k) {
      return around(seeds[b].position[k]) * (seeds[b].share.empty() ? 1.0 : seeds[b].share[k]);
    };
    double inside = 1;
    if (!surfaces.empty()) {
      const auto& surface = state.surfaces.bodies[b];
      const auto first = areas.begin() + surface.first;
      const double area = std::accumulate(first, first + surface.count, 0.0);
      double filled = 0;
      for (std::size_t k = 0; k < seeds[b].position.size(); ++k) filled += share_of(k);
      const double of_body = filled * domain.volume, layer = std::min(of_body, area * scene.grid.cell);
      inside -= constants::plan::kBoundaryShare * layer / of_body;
      std::size_t at = p + seeds[b].position.size();
      for (int k = 0; k < surface.count; ++k)
        seed_particle(scene.bodies[b], b, surfaces[b].points[static_cast<std::size_t>(k)],
                      constants::plan::kBoundaryShare * layer / domain.volume * first[k] / area, domain, at++,
                      particles);
    }
    for (std::size_t k = 0; k < seeds[b].position.size(); ++k, ++p) {
      seed_particle(scene.bodies[b], b, seeds[b].position[k], inside * share_of(k), domain, p, particles);
      if (!seeds[b].angle.empty()) turn_domain(particles, p, seeds[b].angle[k]);
    }
    if (!surfaces.empty()) p += static_cast<std::size_t>(state.surfaces.bodies[b].count);
  }
  if (particles.has(Quantity::initial_deformation))
    for (int e = 0; e < Dim * Dim; ++e)
      std::copy_n(particles.column(Quantity::deformation_gradient, e), particles.size(),
                  particles.column(Quantity::initial_deformation, e));
  start_history(state);
  if (plan.heat) start_heat(state);
  refresh_stress(state);
}

/// An evolving law answers to a step that strains nothing, which leaves its state as it is.
template <int Dim>
void refresh_stress(State<Dim>& state) {
  const StateView<Dim> columns = state.view().state;
  for_each_deformable(state, [&]<class Law>(std::size_t p, const Law& law, const double(&f)[Dim * Dim]) {
    double tau[kSymmetric<3>]{}, c2;
    as_law_sees<Law>(state, columns, p, f, [&]<int N>(const double(&g)[N * N], auto evolving) {
      double t[kSymmetric<N>];
      if constexpr (Evolving<Law>) {
        constexpr double still[N * N] = {};
        const double j = evolving.volume_ratio;
        law.template advance<N>(StrainStep<N, double>{still, g, j, j, 0.0, 1.0}, evolving, t, c2);
      } else {
        law.template stress<N>(g, t, c2);
      }
      std::copy(t, t + kSymmetric<N>, tau);
    });
    if constexpr (Dim == 2 && HasPlaneStress<Law>)
      if (state.plane_kind == PlaneKind::plane_stress)
        c2 = law.plate_wave_speed_squared(f, state.particles.column(Quantity::out_of_plane_stretch)[p]);
    for (int s = 0; s < kSymmetric<Dim>; ++s)
      state.particles.column(Quantity::kirchhoff_stress, s)[p] = tau[s];
    state.particles.column(Quantity::wave_speed)[p] = std::sqrt(c2);
  });
}

namespace {

/// W of a particle, J/m³ of its undeformed volume.
template <int Dim>
auto stored_density(State<Dim>& state) {
  return [&state, columns = state.view().state]<class Law>(std::size_t p, const Law& law,
                                                           const double(&f)[Dim * Dim]) {
    return as_law_sees<Law>(state, columns, p, f, [&]<int N>(const double(&g)[N * N], const auto& evolving) {
      if constexpr (Evolving<Law>)
        return law.template energy<N>(g, evolving);
      else
        return law.template energy<N>(g);
    });
  };
}

}  // namespace

template <int Dim>
double stored_energy(State<Dim>& state) {
  return sum_by_id(state, stored_density(state));
}

template <int Dim>
double inner_energy(State<Dim>& state, std::size_t p) {
  const auto& particles = state.particles;
  double density =
      particles.has(Quantity::dissipated_energy) ? particles.column(Quantity::dissipated_energy)[p] : 0;
  with_law(state, p,
           [&, stored = stored_density(state)](std::size_t, const auto& law, const double(&f)[Dim * Dim]) {
             density += stored(p, law, f);
           });
  return particles.column(Quantity::initial_volume)[p] * density;
}

template <int Dim>
double dissipated_energy(State<Dim>& state) {
  if (!state.particles.has(Quantity::dissipated_energy)) return 0;
  const double* dissipated = state.particles.column(Quantity::dissipated_energy);
  return sum_by_id(state,
                   [&](std::size_t p, const auto&, const double(&)[Dim * Dim]) { return dissipated[p]; });
}

template void seed<2>(const Scene&, const Plan&, State<2>&);
template void seed<3>(const Scene&, const Plan&, State<3>&);
template void refresh_stress<2>(State<2>&);
template void refresh_stress<3>(State<3>&);
template double stored_energy<2>(State<2>&);
template double stored_energy<3>(State<3>&);
template double inner_energy<2>(State<2>&, std::size_t);
template double inner_energy<3>(State<3>&, std::size_t);
template double dissipated_energy<2>(State<2>&);
template double dissipated_energy<3>(State<3>&);

}  // namespace mpmfast
