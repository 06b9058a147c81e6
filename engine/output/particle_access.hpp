#pragma once

/// @file Reading particles for output: in the order of their ids, with the stress that users know.

#include <Eigen/LU>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// The name in particle files of the angle about z at which undeformed domains lie, rad.
inline constexpr const char* kDomainAngle = "domain_angle";

/// Indices of the particles by ascending id: the one order that does not depend on the sort.
template <int Dim>
std::vector<std::uint32_t> order_by_id(const Particles<Dim>& particles);

/// J; 1 without a deformation gradient.
template <int Dim>
double volume_ratio(const Particles<Dim>& particles, std::size_t p) {
  return particles.has(Quantity::deformation_gradient) ? particles.volume_ratio(p) : 1.0;
}

/// Cauchy stress σ = τ / J, Pa, in the order xx yy zz xy yz xz.
struct CauchyStress {
  std::array<double, 6> component{};
  double pressure() const { return -(component[0] + component[1] + component[2]) / 3; }
  double von_mises() const;
  /// σ1 − σ2 of the xy plane: fringes of photo-elastic pictures follow it (K24 Eq. 50).
  double difference_in_plane() const;
};
template <int Dim>
CauchyStress cauchy_stress(const Particles<Dim>& particles, std::size_t p);

/// One scalar of every particle, in the particles' own order; NaN where the columns for it are missing,
/// and for rigid bodies, which move and have no stress or strain.
struct FieldValues {
  std::vector<double> value;
  std::string label, unit;
  bool names = false;  ///< of bodies or materials, by their numbers
};
/// Names of all fields of particles in so many dimensions, the usual ones first.
std::vector<std::string> field_names(int dimension);
/// @param field  one of field_names; throws std::invalid_argument for another one.
template <int Dim>
FieldValues field_values(const Particles<Dim>& particles, const Scene& scene, const std::string& field);

}  // namespace mpmfast
