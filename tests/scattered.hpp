#pragma once

/// @file A scene that bodies leave.

namespace mpmfast::test {

/// Two disks meet off the middle; what bounces back leaves, the one on the left before the other.
inline constexpr const char* kScattered = R"(
space: plane_strain
grid: {size: [24 mm, 16 mm], cell: 0.25 mm, leaving: outflow}
time: {end: 250 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: stone, disk: {centre: [6 mm, 8 mm], radius: 3 mm}, material: m, velocity: [-60 m/s, 10 m/s]}
  - {name: rock, disk: {centre: [15 mm, 8.3 mm], radius: 4 mm}, material: m, velocity: [2 m/s, 0 m/s]}
contact: {law: coulomb, friction: 0.3}
output: {frames: 3, history: 25, overlap: true}
)";

}  // namespace mpmfast::test
