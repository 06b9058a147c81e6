#include <fmt/format.h>

#include <algorithm>

#include "engine/output/output.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/vtu.hpp"

namespace mpmfast {
namespace {

constexpr std::array<std::string_view, 3> kVectorNames{"X", "Y", "Z"};
constexpr std::array<std::string_view, 6> kSymmetricNames{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
constexpr std::array<std::string_view, 9> kMatrixNames{"XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"};

/// A vector column as three numbers a particle; z is 0 in 2-D.
template <class T, int Dim>
std::vector<T> gather_vector(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order,
                             Quantity quantity) {
  std::vector<T> values(3 * order.size(), T{0});
  for (int d = 0; d < Dim; ++d) {
    const double* column = particles.column(quantity, d);
    for (std::size_t i = 0; i < order.size(); ++i)
      values[3 * i + static_cast<std::size_t>(d)] = static_cast<T>(column[order[i]]);
  }
  return values;
}

template <int Dim>
void add_identity(const Particles<Dim>& particles, const Scene& scene,
                  const std::vector<std::uint32_t>& order, VtuFile& file) {
  std::vector<std::uint32_t> id(order.size());
  std::vector<std::uint16_t> body(order.size()), material(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    id[i] = particles.id()[order[i]];
    body[i] = particles.body()[order[i]];
    material[i] = static_cast<std::uint16_t>(scene.bodies[body[i]].material);
  }
  file.add_point_data("id", id);
  file.add_point_data("body", body);
  file.add_point_data("material", material);
}

template <int Dim>
void add_stress(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  std::vector<float> stress(6 * order.size()), von_mises(order.size()), pressure(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const CauchyStress cauchy = cauchy_stress(particles, order[i]);
    for (std::size_t k = 0; k < 6; ++k) stress[6 * i + k] = static_cast<float>(cauchy.component[k]);
    von_mises[i] = static_cast<float>(cauchy.von_mises());
    pressure[i] = static_cast<float>(cauchy.pressure());
  }
  file.add_point_data("stress", stress, kSymmetricNames);
  file.add_point_data("von_mises", von_mises);
  file.add_point_data("pressure", pressure);
}

/// F in double precision: small strains are its small difference from the identity.
template <int Dim>
void add_deformation(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order,
                     VtuFile& file) {
  std::vector<double> deformation(9 * order.size(), 0.0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Mat<Dim> f = particles.deformation_gradient(order[i]);
    for (int row = 0; row < Dim; ++row)
      for (int column = 0; column < Dim; ++column)
        deformation[9 * i + static_cast<std::size_t>(3 * row + column)] = f(row, column);
    if constexpr (Dim == 2)
      deformation[9 * i + 8] = particles.has(Quantity::out_of_plane_stretch)
                                   ? particles.column(Quantity::out_of_plane_stretch)[order[i]]
                                   : 1;
  }
  file.add_point_data("deformation_gradient", deformation, kMatrixNames);
}

template <int Dim>
void add_volume(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  std::vector<float> volume(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    volume[i] = static_cast<float>(particles.column(Quantity::initial_volume)[order[i]] *
                                   volume_ratio(particles, order[i]));
  file.add_point_data("volume", volume);
}

/// Evolving state that users know.
template <int Dim>
void add_state(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  for (const Quantity quantity : {Quantity::dissipated_energy, Quantity::internal_energy,
                                  Quantity::plastic_strain, Quantity::temperature}) {
    if (!particles.has(quantity)) continue;
    std::vector<float> values(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      values[i] = static_cast<float>(particles.column(quantity)[order[i]]);
    file.add_point_data(std::string(kQuantityTable[static_cast<std::size_t>(quantity)].name), values);
  }
}

/// The particles in `order` at these points (three coordinates each).
template <int Dim>
void write_particles(const std::filesystem::path& vtu, const Particles<Dim>& particles, const Scene& scene,
                     const std::vector<std::uint32_t>& order, const std::vector<double>& points,
                     double time) {
  VtuFile file(points);
  add_identity(particles, scene, order, file);
  if (particles.has(Quantity::velocity))
    file.add_point_data("velocity", gather_vector<float>(particles, order, Quantity::velocity), kVectorNames);
  if (particles.has(Quantity::kirchhoff_stress)) add_stress(particles, order, file);
  if (particles.has(Quantity::deformation_gradient)) add_deformation(particles, order, file);
  if (particles.has(Quantity::initial_volume)) add_volume(particles, order, file);
  add_state(particles, order, file);
  file.write(vtu, time);
}

}  // namespace

template <int Dim>
void ParticleSeries<Dim>::append(const Particles<Dim>& particles, double time) {
  const std::vector<std::uint32_t> order = order_by_id(particles);
  write_particles(series_.next(), particles, *scene_, order,
                  gather_vector<double>(particles, order, Quantity::position), time);
  series_.add(time);
}

template <int Dim>
void write_neighbourhood(const std::filesystem::path& vtu, const Particles<Dim>& particles,
                         const Scene& scene, const std::vector<Vec<Dim>>& places, const Vec<Dim>& centre,
                         double reach, double time) {
  std::vector<std::uint32_t> order;
  std::vector<double> points;
  for (const std::uint32_t p : order_by_id(particles)) {
    if (!((places[p] - centre).template lpNorm<Eigen::Infinity>() <= reach)) continue;
    order.push_back(p);
    for (int d = 0; d < 3; ++d) points.push_back(d < Dim ? places[p][std::min(d, Dim - 1)] : 0);
  }
  write_particles(vtu, particles, scene, order, points, time);
}

template void write_neighbourhood(const std::filesystem::path&, const Particles<2>&, const Scene&,
                                  const std::vector<Vec<2>>&, const Vec<2>&, double, double);
template void write_neighbourhood(const std::filesystem::path&, const Particles<3>&, const Scene&,
                                  const std::vector<Vec<3>>&, const Vec<3>&, double, double);
template class ParticleSeries<2>;
template class ParticleSeries<3>;

}  // namespace mpmfast
