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

/// A vector as three numbers; z is 0 in 2-D.
template <class T, int Dim>
void fill_vector(const Vec<Dim>& x, T* out) {
  for (int d = 0; d < 3; ++d) out[d] = d < Dim ? static_cast<T>(x[d < Dim ? d : 0]) : T{0};
}

template <int Dim>
void add_identity(const Particles<Dim>& particles, const Scene& scene,
                  const std::vector<std::uint32_t>& order, VtuFile& file) {
  const auto body = [&](std::size_t i) { return particles.body()[order[i]]; };
  file.add_point_data<std::uint32_t>(
      "id", [&](std::size_t i, std::uint32_t* out) { *out = particles.id()[order[i]]; });
  file.add_point_data<std::uint16_t>("body", [&](std::size_t i, std::uint16_t* out) { *out = body(i); });
  file.add_point_data<std::uint16_t>("material", [&](std::size_t i, std::uint16_t* out) {
    *out = static_cast<std::uint16_t>(scene.bodies[body(i)].material);
  });
}

template <int Dim>
void add_stress(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  const auto cauchy = [&](std::size_t i) { return cauchy_stress(particles, order[i]); };
  const auto all = [&](std::size_t i, float* out) {
    const CauchyStress stress = cauchy(i);
    for (std::size_t k = 0; k < 6; ++k) out[k] = static_cast<float>(stress.component[k]);
  };
  file.add_point_data<float>("stress", all, kSymmetricNames);
  file.add_point_data<float>(
      "von_mises", [&](std::size_t i, float* out) { *out = static_cast<float>(cauchy(i).von_mises()); });
  file.add_point_data<float>(
      "pressure", [&](std::size_t i, float* out) { *out = static_cast<float>(cauchy(i).pressure()); });
}

/// F in double precision: small strains are its small difference from the identity. The state's F holds the
/// angle at which a domain lay at the start, files do not.
template <int Dim>
void add_deformation(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order,
                     VtuFile& file) {
  const auto fill = [&](std::size_t i, double* out) {
    std::fill_n(out, 9, 0.0);
    const Mat<Dim> f = particles.deformation_gradient(order[i]) *
                       particles.initial_deformation(order[i]).transpose();  // of a rotation: its inverse
    for (int row = 0; row < Dim; ++row)
      for (int column = 0; column < Dim; ++column) out[3 * row + column] = f(row, column);
    if constexpr (Dim == 2)
      out[8] = particles.has(Quantity::out_of_plane_stretch)
                   ? particles.column(Quantity::out_of_plane_stretch)[order[i]]
                   : 1;
  };
  file.add_point_data<double>("deformation_gradient", fill, kMatrixNames);
}

/// Of particles whose domains lie along their body, for whoever draws them.
template <int Dim>
void add_domain_angle(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order,
                      VtuFile& file) {
  file.add_point_data<double>(kDomainAngle, [&](std::size_t i, double* out) {
    const Mat<Dim> start = particles.initial_deformation(order[i]);
    *out = std::atan2(start(1, 0), start(0, 0));
  });
}

template <int Dim>
void add_volume(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  file.add_point_data<float>("volume", [&](std::size_t i, float* out) {
    *out = static_cast<float>(particles.column(Quantity::initial_volume)[order[i]] *
                              volume_ratio(particles, order[i]));
  });
}

/// Of what is split, for whoever draws domains; z is 1 in 2-D.
template <int Dim>
void add_domain_share(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order,
                      VtuFile& file) {
  const auto fill = [&](std::size_t i, float* out) {
    for (int d = 0; d < 3; ++d)
      out[d] = d < Dim ? static_cast<float>(particles.domain_share(order[i], d < Dim ? d : 0)) : 1;
  };
  file.add_point_data<float>("domain_share", fill, kVectorNames);
}

/// Evolving state that users know.
template <int Dim>
void add_state(const Particles<Dim>& particles, const std::vector<std::uint32_t>& order, VtuFile& file) {
  if (particles.has(Quantity::volume_ratio)) {  // as F, for what is near 1
    const double* ratio = particles.column(Quantity::volume_ratio);
    file.add_point_data<double>(kQuantityTable[static_cast<std::size_t>(Quantity::volume_ratio)].name,
                                [&](std::size_t i, double* out) { *out = ratio[order[i]]; });
  }
  for (const Quantity quantity : {Quantity::dissipated_energy, Quantity::internal_energy,
                                  Quantity::plastic_strain, Quantity::temperature}) {
    if (!particles.has(quantity)) continue;
    const double* column = particles.column(quantity);
    file.add_point_data<float>(
        kQuantityTable[static_cast<std::size_t>(quantity)].name,
        [&](std::size_t i, float* out) { *out = static_cast<float>(column[order[i]]); });
  }
}

void add_lines(const Polylines& lines, VtuFile& file) {
  if (lines.empty()) return;
  std::vector<double> points;
  std::vector<std::uint32_t> lengths;
  for (const auto& line : lines) {
    for (const Vec<2>& x : line) points.insert(points.end(), {x[0], x[1], 0});
    lengths.push_back(static_cast<std::uint32_t>(line.size()));
  }
  file.add_field_data(kLinePoints, points, 3);
  file.add_field_data(kLineLengths, lengths);
}

/// The particles in `order`. @param place  of a particle, by its index
template <int Dim, class Position>
void write_particles(const std::filesystem::path& vtu, const Particles<Dim>& particles, const Scene& scene,
                     const std::vector<std::uint32_t>& order, const Position& position, double time,
                     const Polylines& lines = {}) {
  VtuFile file(order.size(),
               [&](std::size_t i, double* out) { fill_vector<double, Dim>(position(order[i]), out); });
  add_identity(particles, scene, order, file);
  if (particles.has(Quantity::velocity))
    file.add_point_data<float>(
        "velocity",
        [&](std::size_t i, float* out) {
          fill_vector<float, Dim>(particles.vector(Quantity::velocity, order[i]), out);
        },
        kVectorNames);
  if (particles.has(Quantity::kirchhoff_stress)) add_stress(particles, order, file);
  if (particles.has(Quantity::deformation_gradient)) add_deformation(particles, order, file);
  if (particles.has(Quantity::initial_deformation)) add_domain_angle(particles, order, file);
  if (particles.has(Quantity::initial_volume)) add_volume(particles, order, file);
  if (particles.has(Quantity::domain_share)) add_domain_share(particles, order, file);
  add_state(particles, order, file);
  add_lines(lines, file);
  file.write(vtu, time);
}

}  // namespace

template <int Dim>
void ParticleSeries<Dim>::append(const Particles<Dim>& particles, double time, const Polylines& lines) {
  write_particles(
      series_.next(), particles, *scene_, order_by_id(particles),
      [&](std::uint32_t p) { return particles.vector(Quantity::position, p); }, time, lines);
  series_.add(time);
}

template <int Dim>
void write_neighbourhood(const std::filesystem::path& vtu, const Particles<Dim>& particles,
                         const Scene& scene, const std::vector<Vec<Dim>>& positions, const Vec<Dim>& centre,
                         double reach, double time) {
  std::vector<std::uint32_t> order;
  for (const std::uint32_t p : order_by_id(particles)) {
    if (!((positions[p] - centre).template lpNorm<Eigen::Infinity>() <= reach)) continue;
    order.push_back(p);
  }
  write_particles(
      vtu, particles, scene, order, [&](std::uint32_t p) { return positions[p]; }, time);
}

template void write_neighbourhood(const std::filesystem::path&, const Particles<2>&, const Scene&,
                                  const std::vector<Vec<2>>&, const Vec<2>&, double, double);
template void write_neighbourhood(const std::filesystem::path&, const Particles<3>&, const Scene&,
                                  const std::vector<Vec<3>>&, const Vec<3>&, double, double);
template class ParticleSeries<2>;
template class ParticleSeries<3>;

}  // namespace mpmfast
