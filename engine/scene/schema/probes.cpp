#include <array>

#include "engine/scene/recorder.hpp"

namespace mpmfast {

namespace {

// Scenes that together make the reader ask for all that it knows. They need not be valid as a whole. What a
// key falls back to is noted where it is first seen: the first probe leaves out all that it can.
constexpr std::array kProbes{
    // The defaults.
    R"(
space: plane_strain
grid: {size: [10 m, 10 m], cell: 1 m}
time: {end: 1 s}
method: {}
contact: {}
output: {checkpoint: {}}
materials: {a: {model: neo_hookean, density: 1, bulk: 1, shear: 1}}
bodies: [{box: {from: [0, 0], to: [1 m, 1 m]}, material: a}]
)",
    // What only a solid has.
    R"(
space: 3d
grid: {origin: [0, 0, 0], size: [10 m, 10 m, 10 m], cell: 1 m}
time: {end: 1 s, max_step: none}
materials: {a: {model: neo_hookean, density: 1, bulk: 1, shear: 1}}
bodies:
  - {box: {from: [0, 0, 0], to: [1, 1, 1]}, material: a, particles_per_cell: [2, 2, 2], velocity: [0, 0, 0]}
  - {sphere: {}, material: a, rotation: {about: [0, 0, 0], axis: x, speed: 0}}
  - {ellipsoid: {}, material: a, rotation: {axis: [1, 0, 0]}}
  - {tube: {}, material: a}
  - {polygon: {points: [[0, 0], [1, 0], [0, 1]], z: [0, 1]}, material: a}
  - {stl: {file: a.stl, axis: x, translate: [0, 0, 0]}, material: a}
  - {stl: {file: a.stl, axis: [1, 0, 0]}, material: a}
boundaries:
  front: {piston: 0, direction: x}
  box: {box: {from: [0, 0, 0], to: [1, 1, 1]}, direction: [1, 0, 0], speed: 0}
  node: {node: [0, 0, 0], direction: x, speed: 0}
gravity: [0, 0, 0]
contact: {specified_normal: [1, 0, 0]}
output: {checkpoint: {every: 1 s, steps: 1}, picture: pressure}
)",
    // The plane, and every material.
    R"(
title: a
space: plane_strain
thickness: 1 m
grid: {origin: [0, 0], size: [10 m, 10 m], cell: 1 m, leaving: wall}
time: {end: 1 s, cfl: 0.5, max_step: 1 s}
method: {basis: ugimp, update: flip, strain: average, position: grid, deformation_terms: 2}
materials:
  a: {model: neo_hookean, density: 1, young: 1, poisson: 0}
  b: {model: linear_elastic, density: 1, young: 1, poisson: 0}
  c: {model: logarithmic_neo_hookean, density: 1, young: 1, poisson: 0}
  d: {model: logarithmic_neo_hookean, density: 1, lambda: 1, shear: 1}
  e: {model: mie_gruneisen}
  f: {model: j2_plasticity, bulk: 1, shear: 1, equation_of_state: {}}
  g: {model: j2_plasticity, young: 1, poisson: 0}
  h: {model: johnson_cook, bulk: 1, shear: 1, equation_of_state: {}}
  i: {model: johnson_cook, young: 1, poisson: 0}
  j: {model: rigid}
bodies:
  - {name: a, field: a, disk: {}, material: a, particles_per_cell: 2, seeding: rings, velocity: [0, 0]}
  - {ellipse: {}, material: a, particles_per_cell: [2, 2], seeding: {angle: 0}, rotation: {speed: 0}}
  - {ring: {}, material: a, rotation: {about: [0, 0], speed: [[0, 0]]}}
  - {polygon: [[0, 0], [1, 0], [0, 1]], material: a}
  - {polygon: {points: [[0, 0], [1, 0], [0, 1]]}, material: a}
  - {bitmap: a.png, extent: [1, 1], origin: [0, 0], skip: [0], materials: {1: a}, material: a}
  - {bitmap: {file: a.png}, extent: [1, 1]}
boundaries:
  left: wall
  right: {wall: held, position: 1 m, at: nodes}
  bottom: {wall: sliding, at: surface, friction: 0.2}
  top: {piston: 1 m/s, direction: x, held: true, position: 1 m, at: plane}
  box: {box: {from: [0, 0], to: [1, 1]}, direction: [1, 0], speed: 0}
  node: {node: [0, 0], direction: x, speed: 0}
gravity: [0, 0]
contact:
  normal: specified
  specified_normal: [1, 0]
  pairs: [{between: [a, body2], law: coulomb}, {materials: [a, a]}]
output: {picture: pressure, checkpoint: {every: none, steps: none}}
)",
    R"(
space: axisymmetric
grid: {size: [10 m, 10 m], cell: 1 m}
time: {end: 1 s}
gravity: {acceleration: [0, 0]}
contact: none
output: {checkpoint: none}
)",
    R"(
space: 3d
gravity: {acceleration: [0, 0, 0]}
contact: {law: adhesion, pairs: [{law: adhesion}]}
)",
};

}  // namespace

void record_probes(Recorder& recorder) {
  for (const char* probe : kProbes) record_scene(probe, "probe.yaml", recorder);
}

const std::map<std::string, Known>& known_values() {
  static const Recorder kRecorder = [] {
    Recorder recorder;
    record_probes(recorder);
    return recorder;
  }();
  return kRecorder.found();
}

}  // namespace mpmfast
