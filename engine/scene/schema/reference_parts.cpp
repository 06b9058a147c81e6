#include "engine/scene/schema/reference_parts.hpp"

namespace mpmfast {

namespace {

const std::vector<ReferencePart>& parts() {
  using List = ReferencePart::List;
  static const std::vector<ReferencePart> kParts{
      {"Quantities",
       "",
       "A quantity is a number with a unit, or a bare number in SI: `5 mm`, `2.78 g/cm^3`, `1/70 mm`, "
       "`0.005`. Other "
       "units of the same kind may be put together: `kN/mm^2`, `cm/us`. A list of 2 or 3 has one entry for "
       "each "
       "direction of the scene.\n\n"
       "A *table* gives a quantity in time: pairs `[[0 us, 0 m/s], [50 us, 5 m/s]]`, or "
       "`{times: [0 us, 50 us], values: [0 m/s, 5 m/s]}`. It is linear between the points and constant "
       "outside. "
       "A *name* has letters, digits, `_` and `-`.",
       "",
       {},
       List::units},
      {"Head",
       "",
       "",
       "title: A wheel on a rubber block\nspace: plane_strain\n",
       {{"", "", {"title", "space", "thickness", "variables", "include"}}}},
      {"Grid",
       "grid",
       "Bodies must lie in the grid, and what leaves it is lost or ends the run.",
       "grid: {size: [40 mm, 20 mm], cell: 1 mm, leaving: outflow}\n",
       {{"", "grid", {}}}},
      {"Time", "time", "", "time: {end: 100 us, cfl: 0.4}\n", {{"", "time", {}}}},
      {"Materials",
       "materials",
       "`model` is the law that a material obeys; the other keys depend on it. What stands "
       "behind `=` is\n"
       "the default.",
       "materials:\n"
       "  rubber: {model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.33}\n"
       "  copper:\n"
       "    model: j2_plasticity\n"
       "    density: 8.96 g/cm^3\n"
       "    young: 124 GPa\n"
       "    poisson: 0.34\n"
       "    yield: 90 MPa\n"
       "    hardening: 300 MPa\n"
       "  tool: {model: rigid}\n",
       {},
       List::models},
      {"Bodies",
       "bodies",
       "A body has one shape, and the keys below beside it.",
       "bodies:\n"
       "  - {name: block, box: {from: [4 mm, 0 mm], to: [16 mm, 6 mm]}, material: rubber}\n"
       "  - name: wheel\n"
       "    disk: {centre: [10 mm, 9 mm], radius: 3 mm}\n"
       "    material: copper\n"
       "    seeding: rings                 # particles along the outline\n"
       "    velocity: [10 m/s, 0 m/s]\n"
       "    rotation: {about: [10 mm, 9 mm], speed: -300 rad/s}\n"
       "  - name: wedge\n"
       "    polygon: [[24 mm, 2 mm], [32 mm, 2 mm], [28 mm, 8 mm]]\n"
       "    material: tool                 # rigid: its velocity may be a table in time\n"
       "    velocity: [{times: [0 us, 50 us], values: [0 m/s, -20 m/s]}, 0 m/s]\n",
       {{"Beside the shape:",
         "bodies[]",
         {"name", "material", "field", "particles_per_cell", "seeding", "velocity", "rotation"}},
        {"Beside a `bitmap`:", "bodies[]", {}}},
       List::shapes},
      {"Boundaries",
       "boundaries",
       "Faces are `left` and `right` (lower and upper x), `bottom` and `top` (y) and, in 3-D, `back` and "
       "`front` "
       "(z: the floor is `back` where gravity is along z); one that is not named is free. A wall holds "
       "velocities "
       "on the grid and lets nothing go: what comes to it stops up to a cell before it, and stays. For an "
       "impact "
       "take a rigid body. Other names give nodes their velocity, in a place that does not move.",
       "boundaries:\n"
       "  bottom: wall\n"
       "  left: {wall: held, position: 2 mm}\n"
       "  top: {piston: [[0 us, 0 m/s], [20 us, 5 m/s]], position: 18 mm}\n"
       "  pull: {box: {from: [14 mm, 0 mm], to: [16 mm, 6 mm]}, direction: x, speed: 1 m/s}\n",
       {{"A face of the grid:", "boundaries", {"FACE"}},
        {"A map in the place of the word:", "boundaries.FACE", {}},
        {"Under any other name, a velocity that is given at some nodes:", "boundaries.NAME", {}}}},
      {"Gravity",
       "",
       "",
       "gravity: {acceleration: [0 m/s^2, -9.81 m/s^2], ramp: 10 us}\n",
       {{"", "", {"gravity"}}}},
      {"Contact",
       "contact",
       "Most scenes state the law and leave the rest to the defaults.",
       "contact:\n"
       "  law: coulomb\n"
       "  friction: 0.3\n"
       "  pairs:                             # a pair leaves out what it shares with the above\n"
       "    - {between: [wheel, block], law: adhesion, normal_strength: 2 MPa, shear_strength: 1 MPa}\n"
       "    - {materials: [rubber, tool], friction: 0.1, static_friction: 0.2}\n",
       {{"The law:",
         "contact",
         {"law", "friction", "static_friction", "decay_speed", "normal_strength", "shear_strength", "reach",
          "viscosity", "film", "area", "pairs"}},
        {"A pair has the keys of its law and, first, which pair it is:",
         "contact.pairs[]",
         {"between", "materials"}},
        {"Where surfaces touch:",
         "contact",
         {"normal", "specified_normal", "separation", "position_offset", "piecewise_particles", "detection",
          "rigid_bias", "hysteresis", "mass_screen", "volume_screen"}},
        {"The corrections:",
         "contact",
         {"corrections", "fields", "persistent", "first_correction_share", "advance_separation"}},
        {"Normals by regression:", "contact", {}}},
       List::laws},
      {"Method", "method", "", "method: {basis: lcpdi, update: xpic(5)}\n", {{"", "method", {}}}},
      {"Output",
       "output",
       "",
       "output: {frames: 50, history: 500, picture: von_mises, checkpoint: {every: 5 min}}\n",
       {{"", "output", {}}}},
  };
  return kParts;
}

}  // namespace

std::span<const ReferencePart> reference_parts() { return parts(); }

}  // namespace mpmfast
