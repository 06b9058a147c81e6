#include "engine/output/particle_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string_view>

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

template <int Dim>
FieldValues field_values(const Particles<Dim>& particles, const std::string& field) {
  const Quantity stress = Quantity::kirchhoff_stress;
  if (field == "pressure")
    return collect(particles, stress, field, "Pa",
                   [&](std::size_t p) { return cauchy_stress(particles, p).pressure(); });
  if (field == "von_mises")
    return collect(particles, stress, "von Mises stress", "Pa",
                   [&](std::size_t p) { return cauchy_stress(particles, p).von_mises(); });
  for (std::size_t k = 0; k < kStressNames.size(); ++k)
    if (field == kStressNames[k])
      return collect(particles, stress, "stress " + field.substr(7), "Pa",
                     [&](std::size_t p) { return cauchy_stress(particles, p).component[k]; });
  if (field == "speed")
    return collect(particles, Quantity::velocity, field, "m/s",
                   [&](std::size_t p) { return particles.vector(Quantity::velocity, p).norm(); });
  if (field == "body")
    return collect(particles, Quantity::position, field, "",
                   [&](std::size_t p) { return static_cast<double>(particles.body()[p]); });
  throw std::invalid_argument(
      fmt::format("unknown field '{}' (expected body, pressure, von_mises, speed, {})", field,
                  fmt::join(kStressNames, ", ")));
}

template std::vector<std::uint32_t> order_by_id(const Particles<2>&);
template std::vector<std::uint32_t> order_by_id(const Particles<3>&);
template CauchyStress cauchy_stress(const Particles<2>&, std::size_t);
template CauchyStress cauchy_stress(const Particles<3>&, std::size_t);
template FieldValues field_values(const Particles<2>&, const std::string&);
template FieldValues field_values(const Particles<3>&, const std::string&);

}  // namespace mpmfast
