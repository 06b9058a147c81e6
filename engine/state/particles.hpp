#pragma once

/// @file The particles: a structure of arrays, one column per component.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/state/columns.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// Every particle quantity there is. A plan lists the ones that a scene needs; the others are not allocated.
enum class Quantity {
  position,
  velocity,
  deformation_gradient,
  kirchhoff_stress,
  mass,
  initial_volume,
  wave_speed,
  domain_edges,
  reference_position,
  velocity_slopes,
  dissipated_energy,
  internal_energy,
  plastic_strain,
  temperature,
  elastic_strain,
  out_of_plane_stretch,
  initial_deformation,
  temperature_slope,
  thermal_stretch,
  volume_ratio,
  domain_share
};
inline constexpr int kQuantities = 21;

struct QuantityInfo {
  Quantity quantity;
  std::string_view name, unit;
  int components_2d, components_3d;
  std::string_view reason;  ///< who needs it, for `mpmfast check`
  bool extensive = false;   ///< the parts of a particle that is split share it
};

/// The one table of particle columns: allocation, sorting, output and `check` follow it.
inline constexpr std::array<QuantityInfo, kQuantities> kQuantityTable{{
    {Quantity::position, "position", "m", 2, 3, "every scene"},
    {Quantity::velocity, "velocity", "m/s", 2, 3, "every scene"},
    {Quantity::deformation_gradient, "deformation_gradient", "-", 4, 9,
     "strain (row-major F in the plane or in space)"},
    {Quantity::kirchhoff_stress, "kirchhoff_stress", "Pa", 4, 6,
     "internal force, output (xx yy zz xy yz xz)"},
    {Quantity::mass, "mass", "kg", 1, 1, "every scene", true},
    {Quantity::initial_volume, "initial_volume", "m^3", 1, 1, "internal force", true},
    {Quantity::wave_speed, "wave_speed", "m/s", 1, 1, "time step"},
    {Quantity::domain_edges, "domain_edges", "m", 4, 9, "CPDI (half-edge vectors, row-major)"},
    {Quantity::reference_position, "reference_position", "m", 2, 3, "displacements"},
    {Quantity::velocity_slopes, "velocity_slopes", "1/s", 4, 9, "APIC (row-major C = B/D)"},
    {Quantity::dissipated_energy, "dissipated_energy", "J/m^3", 1, 1, "plastic work, viscous heat"},
    {Quantity::internal_energy, "internal_energy", "J/m^3", 1, 1, "equation of state"},
    {Quantity::plastic_strain, "plastic_strain", "-", 1, 1, "plastic flow"},
    {Quantity::temperature, "temperature", "K", 1, 1, "equation of state, thermal softening, heat"},
    {Quantity::elastic_strain, "elastic_strain", "-", 4, 6,
     "plastic flow (elastic B, of metals isochoric; xx yy zz xy yz xz)"},
    {Quantity::out_of_plane_stretch, "out_of_plane_stretch", "-", 1, 1,
     "plane stress, axisymmetry (F_zz; about the axis that of the hoop)"},
    {Quantity::initial_deformation, "initial_deformation", "-", 4, 9,
     "displacements where domains lie at an angle at the start (row-major F)"},
    {Quantity::temperature_slope, "temperature_slope", "K/m", 2, 3, "heat (its gradient)"},
    {Quantity::thermal_stretch, "thermal_stretch", "-", 1, 1, "thermal expansion (of a length)"},
    {Quantity::volume_ratio, "volume_ratio", "-", 1, 1, "laws that flow (J, by its own rate)"},
    {Quantity::domain_share, "domain_share", "-", 2, 3,
     "splitting (size of the undeformed domain over that of the body's)"},
}};

/// Structure of arrays over all particles of a scene, grouped by the sort (engine/state/tiling.hpp).
template <int Dim>
class Particles {
 public:
  static constexpr int components(Quantity q) {
    const auto& info = kQuantityTable[static_cast<std::size_t>(q)];
    return Dim == 2 ? info.components_2d : info.components_3d;
  }

  /// Space for n particles in the columns of `quantities` (id and body are always there). Contents are zero.
  void allocate(std::size_t n, const std::vector<Quantity>& quantities) {
    count_ = n;
    quantities_ = quantities;
    for (Quantity q : quantities_) {
      auto& columns = columns_[static_cast<std::size_t>(q)];
      columns.resize(static_cast<std::size_t>(components(q)));
      for (auto& c : columns) c.resize_discard(n);
    }
    id_.resize_discard(n);
    body_.resize_discard(n);
    next_id_ = static_cast<std::uint32_t>(n);
  }

  /// Makes space for particles up to the n-th behind those that are there, which keep what they have. The
  /// caller fills in what the new ones are.
  void grow(std::size_t n) {
    for (Quantity q : quantities_)
      for (auto& c : columns_[static_cast<std::size_t>(q)]) c.grow(n);
    id_.grow(n);
    body_.grow(n);
    count_ = n;
  }

  /// Forgets the particles from the n-th on; the memory stays.
  void keep_first(std::size_t n) { count_ = std::min(n, count_); }

  std::size_t size() const { return count_; }
  bool has(Quantity q) const { return !columns_[static_cast<std::size_t>(q)].empty(); }
  const std::vector<Quantity>& quantities() const { return quantities_; }

  /// The column of component k of q; valid until the next sort.
  double* column(Quantity q, int k = 0) {
    return columns_[static_cast<std::size_t>(q)][static_cast<std::size_t>(k)].data();
  }
  const double* column(Quantity q, int k = 0) const {
    return columns_[static_cast<std::size_t>(q)][static_cast<std::size_t>(k)].data();
  }
  Column<double>& raw(Quantity q, int k) {
    return columns_[static_cast<std::size_t>(q)][static_cast<std::size_t>(k)];
  }

  /// Stable number of a particle, from its seeding or from the split that made it.
  Column<std::uint32_t>& id() { return id_; }
  const Column<std::uint32_t>& id() const { return id_; }
  /// The number of the next particle that comes to be: none had it, not even one that has left.
  std::uint32_t& next_id() { return next_id_; }
  std::uint32_t next_id() const { return next_id_; }
  /// Index into Scene::bodies.
  Column<std::uint16_t>& body() { return body_; }
  const Column<std::uint16_t>& body() const { return body_; }

  Vec<Dim> vector(Quantity q, std::size_t p) const {
    Vec<Dim> v;
    for (int k = 0; k < Dim; ++k) v[k] = column(q, k)[p];
    return v;
  }
  Mat<Dim> deformation_gradient(std::size_t p) const {
    Mat<Dim> f;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f(i, j) = column(Quantity::deformation_gradient, Dim * i + j)[p];
    return f;
  }

  /// F of the domain at the start: a rotation where it lies at an angle.
  Mat<Dim> initial_deformation(std::size_t p) const {
    Mat<Dim> f = Mat<Dim>::Identity();
    if (!has(Quantity::initial_deformation)) return f;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f(i, j) = column(Quantity::initial_deformation, Dim * i + j)[p];
    return f;
  }

  /// Of the undeformed domain along a direction, over that of the body's domains: less than 1 of a particle
  /// that was split.
  double domain_share(std::size_t p, int direction) const {
    return has(Quantity::domain_share) ? column(Quantity::domain_share, direction)[p] : 1;
  }

  /// J: carried by its own rate where a law of the scene flows, else det F with the stretch out of the plane.
  double volume_ratio(std::size_t p) const {
    if (has(Quantity::volume_ratio)) return column(Quantity::volume_ratio)[p];
    const double j = deformation_gradient(p).determinant();
    return has(Quantity::out_of_plane_stretch) ? column(Quantity::out_of_plane_stretch)[p] * j : j;
  }

  /// Of all columns, with their padding: large pages leave some over.
  std::size_t bytes() const {
    std::size_t sum = id_.bytes() + body_.bytes();
    for (Quantity q : quantities_)
      for (const auto& c : columns_[static_cast<std::size_t>(q)]) sum += c.bytes();
    return sum;
  }

  /// Bytes of all columns as planned (without padding).
  std::size_t planned_bytes() const {
    std::size_t doubles = 0;
    for (Quantity q : quantities_) doubles += static_cast<std::size_t>(components(q));
    return count_ * (doubles * sizeof(double) + sizeof(std::uint32_t) + sizeof(std::uint16_t));
  }

 private:
  std::size_t count_ = 0;
  std::uint32_t next_id_ = 0;
  std::vector<Quantity> quantities_;
  std::array<std::vector<Column<double>>, kQuantities> columns_;
  Column<std::uint32_t> id_;
  Column<std::uint16_t> body_;
};

}  // namespace mpmfast
