#include "engine/output/particle_access.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <variant>

namespace mpmfast {

template <int Dim>
std::vector<std::uint32_t> order_by_id(const Particles<Dim>& particles) {
  const std::size_t n = particles.size();
  const auto& id = particles.id();
  // Ids are usually 0 … n − 1: then each goes straight to its place.
  constexpr auto kEmpty = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> order(n, kEmpty);
  bool permutation = true;
  for (std::size_t p = 0; p < n && permutation; ++p) {
    permutation = id[p] < n && order[id[p]] == kEmpty;
    if (permutation) order[id[p]] = static_cast<std::uint32_t>(p);
  }
  if (permutation) return order;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });
  return order;
}

double CauchyStress::von_mises() const {
  const auto& s = component;
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  const double shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * shear);
}

double CauchyStress::difference_in_plane() const {
  return std::hypot(component[0] - component[1], 2 * component[3]);
}

template <int Dim>
CauchyStress cauchy_stress(const Particles<Dim>& particles, std::size_t p) {
  CauchyStress stress;
  const double j = volume_ratio(particles, p);
  for (int k = 0; k < kSymmetric<Dim>; ++k)
    stress.component[static_cast<std::size_t>(k)] = particles.column(Quantity::kirchhoff_stress, k)[p] / j;
  return stress;
}

namespace {

constexpr std::array<std::string_view, 6> kStressNames{"stress_xx", "stress_yy", "stress_zz",
                                                       "stress_xy", "stress_yz", "stress_xz"};

template <int Dim, class Value>
FieldValues collect(const Particles<Dim>& particles, Quantity needed, std::string label, std::string unit,
                    Value value) {
  FieldValues field{std::vector<double>(particles.size(), std::numeric_limits<double>::quiet_NaN()),
                    std::move(label), std::move(unit)};
  if (particles.has(needed))
    for (std::size_t p = 0; p < particles.size(); ++p) field.value[p] = value(p);
  return field;
}

}  // namespace

std::vector<std::string> field_names(int dimension) {
  std::vector<std::string> names{"pressure",  "von_mises", "stress_difference", "stress_xx",
                                 "stress_yy", "stress_zz", "stress_xy"};
  if (dimension == 3) names.insert(names.end(), {"stress_yz", "stress_xz"});
  names.insert(names.end(), {"speed", "velocity_x", "velocity_y"});
  if (dimension == 3) names.emplace_back("velocity_z");
  names.insert(names.end(), {"volume_ratio", "plastic_strain", "temperature", "body", "material"});
  return names;
}

namespace {

template <int Dim>
FieldValues values_of_all(const Particles<Dim>& particles, const Scene& scene, const std::string& field) {
  const Quantity stress = Quantity::kirchhoff_stress;
  const auto names = [](FieldValues values) {
    values.names = true;
    return values;
  };
  if (field == "pressure")
    return collect(particles, stress, field, "Pa",
                   [&](std::size_t p) { return cauchy_stress(particles, p).pressure(); });
  if (field == "von_mises")
    return collect(particles, stress, "von Mises stress", "Pa",
                   [&](std::size_t p) { return cauchy_stress(particles, p).von_mises(); });
  if (field == "stress_difference")
    return collect(particles, stress, "stress difference in the plane", "Pa",
                   [&](std::size_t p) { return cauchy_stress(particles, p).difference_in_plane(); });
  for (std::size_t k = 0; k < kStressNames.size(); ++k)
    if (field == kStressNames[k])
      return collect(particles, stress, "stress " + field.substr(7), "Pa",
                     [&](std::size_t p) { return cauchy_stress(particles, p).component[k]; });
  if (field == "speed")
    return collect(particles, Quantity::velocity, field, "m/s",
                   [&](std::size_t p) { return particles.vector(Quantity::velocity, p).norm(); });
  for (int d = 0; d < Dim; ++d)
    if (field == std::string("velocity_") + "xyz"[d])
      return collect(particles, Quantity::velocity, std::string("velocity along ") + "xyz"[d], "m/s",
                     [&](std::size_t p) { return particles.column(Quantity::velocity, d)[p]; });
  if (field == "volume_ratio")
    return collect(particles, Quantity::deformation_gradient, "volume over initial volume", "-",
                   [&](std::size_t p) { return particles.volume_ratio(p); });
  if (field == "plastic_strain")
    return collect(particles, Quantity::plastic_strain, "plastic strain", "-",
                   [&](std::size_t p) { return particles.column(Quantity::plastic_strain)[p]; });
  if (field == "temperature")
    return collect(particles, Quantity::temperature, field, "K",
                   [&](std::size_t p) { return particles.column(Quantity::temperature)[p]; });
  if (field == "body")
    return names(collect(particles, Quantity::position, field, "",
                         [&](std::size_t p) { return static_cast<double>(particles.body()[p]); }));
  if (field == "material")
    return names(collect(particles, Quantity::position, field, "", [&](std::size_t p) {
      return static_cast<double>(scene.bodies[particles.body()[p]].material);
    }));
  throw std::invalid_argument(
      fmt::format("unknown field '{}' (one of {})", field, fmt::join(field_names(Dim), ", ")));
}

/// Stresses that are but round-off of the material's modulus, each body's own, become zero.
template <int Dim>
void clear_round_off(const Particles<Dim>& particles, const Scene& scene, std::vector<double>& stress) {
  constexpr double kRoundOff = 1e-12;
  std::vector<double> least;
  for (const BodySpec& body : scene.bodies)
    least.push_back(kRoundOff * std::visit([](const auto& law) { return law.modulus(); },
                                           scene.materials[static_cast<std::size_t>(body.material)].model));
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (std::abs(stress[p]) < least[particles.body()[p]]) stress[p] = 0;
}

}  // namespace

template <int Dim>
FieldValues field_values(const Particles<Dim>& particles, const Scene& scene, const std::string& field) {
  FieldValues values = values_of_all(particles, scene, field);
  if (values.names || values.unit == "m/s") return values;
  if (values.unit == "Pa") clear_round_off(particles, scene, values.value);
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (is_rigid(scene, scene.bodies[particles.body()[p]]))
      values.value[p] = std::numeric_limits<double>::quiet_NaN();
  return values;
}

template std::vector<std::uint32_t> order_by_id(const Particles<2>&);
template std::vector<std::uint32_t> order_by_id(const Particles<3>&);
template CauchyStress cauchy_stress(const Particles<2>&, std::size_t);
template CauchyStress cauchy_stress(const Particles<3>&, std::size_t);
template FieldValues field_values(const Particles<2>&, const Scene&, const std::string&);
template FieldValues field_values(const Particles<3>&, const Scene&, const std::string&);

}  // namespace mpmfast
