#pragma once

/// @file A scene whose bodies overlap.

namespace mpmfast::test {

/// Two disks that share a part of their area: the hulls of their clouds meet, and normals fall back.
inline constexpr const char* kOverlapping = R"(
space: plane_strain
grid: {size: [16 mm, 12 mm], cell: 1 mm}
time: {end: 500 us}
materials: {rubber: {model: neo_hookean, density: 1000 kg/m^3, bulk: 8 MPa, shear: 3 MPa}}
bodies:
  - {name: left, disk: {centre: [5.2 mm, 6 mm], radius: 3 mm}, seeding: lattice, material: rubber, velocity: [5 m/s, 0 m/s]}
  - {name: right, disk: {centre: [10.6 mm, 6 mm], radius: 3 mm}, seeding: lattice, material: rubber, velocity: [-5 m/s, 0 m/s]}
contact: {law: frictionless}
)";

}  // namespace mpmfast::test
