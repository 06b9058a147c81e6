#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"
#include "kernels/materials/at_rest.hpp"

namespace mpmfast {
namespace {

/// Σ over the particles of one body.
struct BodySums {
  double mass = 0, volume = 0, twice_kinetic = 0, warmth = 0;  ///< warmth: Σ M T, kg K
  Vec3 moment{}, momentum{};
  std::array<double, 6> stress{};  ///< Σ V₀ τ = Σ V σ, J

  /// For the balance, which asks for no places.
  void add(const BodySums& other) {
    volume += other.volume;
    twice_kinetic += other.twice_kinetic;
    for (std::size_t k = 0; k < 3; ++k) momentum[k] += other.momentum[k];
    for (std::size_t k = 0; k < 6; ++k) stress[k] += other.stress[k];
  }
  std::array<double, 6> mean_stress() const {
    std::array<double, 6> mean{};
    for (std::size_t k = 0; k < 6 && volume != 0; ++k) mean[k] = stress[k] / volume;
    return mean;
  }
};

template <int Dim>
void add_particle(const Particles<Dim>& particles, std::size_t p, bool rigid, BodySums& sums) {
  const double mass = particles.column(Quantity::mass)[p];
  sums.mass += mass;
  if (particles.has(Quantity::temperature_slope))
    sums.warmth += mass * particles.column(Quantity::temperature)[p];
  for (int d = 0; d < Dim; ++d) {
    const auto k = static_cast<std::size_t>(d);
    const double velocity = particles.column(Quantity::velocity, d)[p];
    sums.moment[k] += mass * particles.column(Quantity::position, d)[p];
    sums.momentum[k] += mass * velocity;
    sums.twice_kinetic += mass * velocity * velocity;
  }
  if (rigid || !particles.has(Quantity::kirchhoff_stress)) return;
  const double initial_volume = particles.column(Quantity::initial_volume)[p];
  sums.volume += initial_volume * volume_ratio(particles, p);
  for (int k = 0; k < kSymmetric<Dim>; ++k)
    sums.stress[static_cast<std::size_t>(k)] +=
        initial_volume * particles.column(Quantity::kirchhoff_stress, k)[p];
}

}  // namespace

template <int Dim>
void fill_particle_sums(const Particles<Dim>& particles, const Scene& scene, HistoryRow& row) {
  std::vector<BodySums> sums(scene.bodies.size());
  std::vector<bool> rigid(scene.bodies.size());
  for (std::size_t b = 0; b < rigid.size(); ++b) rigid[b] = is_rigid(scene, scene.bodies[b]);
  // By id, so that the rounding does not depend on how the particles happen to be sorted.
  for (const std::uint32_t p : order_by_id(particles)) {
    const std::size_t body = particles.body()[p];
    add_particle(particles, p, rigid[body], sums[body]);
  }

  BodySums all;
  row.bodies.assign(scene.bodies.size(), {});
  for (std::size_t b = 0; b < sums.size(); ++b) {
    HistoryRow::Body& body = row.bodies[b];
    body.mean_stress = sums[b].mean_stress();
    body.mass = sums[b].mass;
    if (body.mass != 0) body.temperature = sums[b].warmth / body.mass;
    for (std::size_t k = 0; k < 3 && body.mass != 0; ++k) {
      body.position[k] = sums[b].moment[k] / body.mass;
      body.velocity[k] = sums[b].momentum[k] / body.mass;
    }
    if (!rigid[b])
      all.add(sums[b]);  // rigid bodies move as told: theirs is no energy or momentum of the balance
  }
  row.kinetic = 0.5 * all.twice_kinetic;
  row.momentum = all.momentum;
  row.mean_stress = all.mean_stress();
}

bool flows(const Scene& scene, const BodySpec& body) {
  if (is_rigid(scene, body)) return false;
  return std::visit(
      []<class Law>(const Law& law) {
        return requires { Law::kParts; }
        || shear_at_rest(law) == 0;
      },
      scene.materials[static_cast<std::size_t>(body.material)].model);
}

template <int Dim>
Spacing widest_spacing(const Particles<Dim>& particles, const Scene& scene) {
  Spacing widest;
  if (!particles.has(Quantity::deformation_gradient)) return widest;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const BodySpec& body = scene.bodies[particles.body()[p]];
    if (is_rigid(scene, body) || flows(scene, body)) continue;
    const Mat<Dim> f = particles.deformation_gradient(p);
    for (int d = 0; d < Dim; ++d) {
      const double cells = f.col(d).norm() * particles.domain_share(p, d) /
                           body.particles_per_cell[static_cast<std::size_t>(d)];
      if (cells > widest.cells) widest = {cells, particles.body()[p]};
    }
  }
  return widest;
}

template void fill_particle_sums(const Particles<2>&, const Scene&, HistoryRow&);
template void fill_particle_sums(const Particles<3>&, const Scene&, HistoryRow&);
template Spacing widest_spacing(const Particles<2>&, const Scene&);
template Spacing widest_spacing(const Particles<3>&, const Scene&);

}  // namespace mpmfast
