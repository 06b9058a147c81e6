#include "engine/scene/schema/key_notes.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/scene/recorder.hpp"

namespace mpmfast {

namespace {

/// What each key means, in a sentence. Units, limits, words and defaults are the reader's own and are not
/// told here. `*` is any one part of a path; the first line that fits counts.
constexpr std::array kNotes{
    KeyNote{"title", "Name of the scene; that of its file if not given."},
    KeyNote{"space", "Whether the scene lies in a plane, turns about an axis or is solid."},
    KeyNote{"thickness", "Planes only: masses, forces and energies are those of this depth."},

    KeyNote{"grid", "The grid of cubic cells, and with it the room that bodies may move in."},
    KeyNote{"grid.origin", "Lower corner of the grid."},
    KeyNote{"grid.size", "Edges of the grid, each a whole number of cells."},
    KeyNote{"grid.cell", "Edge of a cell."},
    KeyNote{"grid.leaving", "What becomes of a particle that goes a cell beyond the grid."},

    KeyNote{"time", "How long the run lasts, and its time step."},
    KeyNote{"time.end", "When the run ends."},
    KeyNote{"time.cfl", "Time step over the time that the fastest wave or particle takes through a cell."},
    KeyNote{"time.collapse", "A time step below this share of the first ends the run as failed; 0: never."},
    KeyNote{"time.max_step", "Longest time step; none: as long as `cfl` allows."},

    KeyNote{"method", "How the grid and the particles exchange; the defaults suit most scenes."},
    KeyNote{"method.basis", "Shape functions of the nodes."},
    KeyNote{"method.update", "How particles take their velocity from the grid."},
    KeyNote{"method.strain",
            "When within a step the strain of the particles is updated; `average` by default where contact "
            "is as published."},
    KeyNote{"method.position", "Which velocity moves the particles; `particle` with the update apic."},
    KeyNote{"method.every", "xpic and fmpm: they filter every n-th step, and flip updates those between."},
    KeyNote{"method.contact_correction",
            "xpic: its filter knows of the changes that contact makes (N20 Eq. 42)."},
    KeyNote{
        "method.own_filter",
        "xpic: filter the velocities from before the first contact correction; saves half of its passes."},
    KeyNote{"method.deformation_terms",
            "How the deformation gradient follows the velocity gradient; `inverse` with strain: first."},

    KeyNote{"gravity", "Acceleration of all bodies: its components, or a map with a ramp."},
    KeyNote{"gravity.acceleration", "Its components."},
    KeyNote{"gravity.ramp", "It grows linearly from zero to full over this time."},

    KeyNote{"output", "What a run leaves in its folder, and how often."},
    KeyNote{"output.frames",
            "Particle files, evenly spaced in time, beside the initial one; 0: none at all."},
    KeyNote{"output.history", "Rows of history.csv beside the initial one."},
    KeyNote{"output.overlap", "2-D: history.csv and run.json say how much bodies enter each other."},
    KeyNote{"output.grid",
            "With each frame after the first a file of the nodes (grid.pvd): masses, velocities, contact."},
    KeyNote{"output.picture", "What the second picture shows, beside the bodies; none: no pictures."},
    KeyNote{
        "output.checkpoint",
        "When the state is written for `mpmfast resume`, beside at a signal and at the end; none: never."},
    KeyNote{"output.checkpoint.every", "After so much wall time; none where only `steps` is given."},
    KeyNote{"output.checkpoint.steps", "After so many steps."},

    KeyNote{"materials", "The materials by name; bodies refer to them."},
    KeyNote{"materials.NAME", "A material: its model, and what that needs."},
    KeyNote{"materials.NAME.model", "The law that the material obeys."},
    KeyNote{"materials.NAME<model=rigid>.density",
            "Only weighs the velocities of several rigid particles at a node."},
    KeyNote{"materials.NAME.density", "Mass over volume, unstrained."},
    KeyNote{"materials.NAME.bulk", "Bulk modulus."},
    KeyNote{"materials.NAME.shear", "Shear modulus."},
    KeyNote{"materials.NAME.lambda", "First Lamé constant."},
    KeyNote{"materials.NAME.young",
            "Young's modulus; where both are known here, with `poisson` in place of them."},
    KeyNote{"materials.NAME.poisson", "Poisson's ratio."},
    KeyNote{"materials.NAME.equation_of_state",
            "Pressure by Mie and Grüneisen in place of the bulk modulus alone."},
    KeyNote{"*.gruneisen", "Grüneisen's gamma: pressure that heat adds."},
    KeyNote{"*.hugoniot_slope", "Slope of shock speed over particle speed."},
    KeyNote{"*.linear_viscosity", "Artificial viscosity against ringing behind a shock, linear in the rate."},
    KeyNote{"*.quadratic_viscosity", "The same, quadratic in the rate: spreads the shock over a few cells."},
    KeyNote{"materials.NAME.heat_capacity", "Heat per mass and temperature, at constant volume."},
    KeyNote{"materials.NAME.temperature", "At the start."},
    KeyNote{"materials.NAME.taylor_quinney", "Share of the plastic work that heats."},
    KeyNote{"materials.NAME.yield", "Stress at which it first yields (A of Johnson and Cook)."},
    KeyNote{"materials.NAME.hardening",
            "How the yield stress grows with plastic strain (B of Johnson and Cook)."},
    KeyNote{"materials.NAME.exponent", "Exponent of the plastic strain, n."},
    KeyNote{"materials.NAME.rate_factor", "Factor of the logarithm of the strain rate, C."},
    KeyNote{"materials.NAME.reference_rate", "Strain rate at which that logarithm is zero."},
    KeyNote{"materials.NAME.softening", "Exponent of the homologous temperature, m."},
    KeyNote{"materials.NAME.reference",
            "Temperature at which softening begins; that at the start if not given."},
    KeyNote{"materials.NAME.melt", "Temperature at which no strength is left."},

    KeyNote{"bodies", "The bodies, each a shape of one material with a velocity field of its own."},
    KeyNote{"bodies[].name", "Heads its columns in history.csv; body1, body2, … if not given."},
    KeyNote{"bodies[].material",
            "One of `materials`; of a bitmap, of every level that its `materials` leave out."},
    KeyNote{"bodies[].field",
            "Bodies that name one velocity field share it: they move as one and do not touch."},
    KeyNote{"bodies[].particles_per_cell",
            "Particles along the side of a cell, for all directions or for each."},
    KeyNote{"bodies[].seeding", "How the particles lie; a map turns their lattice."},
    KeyNote{"bodies[].seeding.angle",
            "Of the lattice, about z: along the edges of a body that lies across the grid."},
    KeyNote{"bodies[].velocity",
            "At the start; of a rigid body always, and each component may be a table in time."},
    KeyNote{"bodies[].rotation", "Turns a rigid body; of one that deforms, its spin at the start."},
    KeyNote{"bodies[].rotation.about", "A point of the axis at time 0; it moves with the body's velocity."},
    KeyNote{"bodies[].rotation.axis", "Direction of the axis; in the plane it is z."},
    KeyNote{"bodies[].rotation.speed", "Right-handed about the axis."},
    KeyNote{"bodies[].box", "A box along the axes."},
    KeyNote{"bodies[].disk", "A disk, in 2-D."},
    KeyNote{"bodies[].sphere", "A sphere, in 3-D."},
    KeyNote{"bodies[].ellipse", "An ellipse, in 2-D."},
    KeyNote{"bodies[].ellipsoid", "An ellipsoid, in 3-D."},
    KeyNote{"bodies[].ring", "A ring, in 2-D."},
    KeyNote{"bodies[].tube", "A tube or a cylinder along z, in 3-D."},
    KeyNote{"bodies[].polygon",
            "A polygon by its corners, closed by itself; in 3-D a map, extruded along z."},
    KeyNote{"bodies[].bitmap", "A grey PNG with 8 bits, in 2-D: each grey level is a body NAME_LEVEL."},
    KeyNote{"bodies[].stl", "A closed surface from a file, in 3-D."},
    KeyNote{"*.from", "The corner that is lower in every direction."},
    KeyNote{"*.to", "The corner that is upper in every direction."},
    KeyNote{"bodies[].*.centre", "Its middle."},
    KeyNote{"bodies[].*.radius", "Its radius."},
    KeyNote{"bodies[].*.radii", "Its radii along the axes, before it is turned."},
    KeyNote{"bodies[].*.inner", "Inner radius."},
    KeyNote{"bodies[].*.outer", "Outer radius."},
    KeyNote{"bodies[].tube.length", "Along z."},
    KeyNote{"bodies[].stl.angle", "Turns it about `axis` through the origin of the file."},
    KeyNote{"bodies[].*.angle", "Turns it about z."},
    KeyNote{"bodies[].polygon.points", "The corners."},
    KeyNote{"bodies[].polygon.z", "Lower and upper end."},
    KeyNote{"bodies[].*.file", "Path, counted from the folder of the scene."},
    KeyNote{"bodies[].stl.scale", "Length of the file's unit."},
    KeyNote{"bodies[].stl.axis", "The axis that `angle` turns it about."},
    KeyNote{"bodies[].stl.translate", "Moves it, after it is turned."},
    KeyNote{"bodies[].extent", "Width and height that the picture is stretched over."},
    KeyNote{"bodies[].origin", "Lower left corner of the picture; that of the grid if not given."},
    KeyNote{"bodies[].skip", "Grey levels that are empty, such as 255."},
    KeyNote{"bodies[].materials", "Materials of single grey levels."},
    KeyNote{"bodies[].materials.GREY", "The material of this grey level."},

    KeyNote{"boundaries", "Walls on the faces of the grid, and nodes whose velocity is given."},
    KeyNote{"boundaries.FACE",
            "A face of the grid: a word, or a map for a wall elsewhere or one that moves."},
    KeyNote{"boundaries.FACE.wall", "A wall, at another place than the face of the grid."},
    KeyNote{"boundaries.FACE.piston", "A wall that moves, and its speed."},
    KeyNote{"boundaries.FACE.direction", "Where the piston moves, along its axis; inwards if not given."},
    KeyNote{"boundaries.FACE.held", "The piston also holds sideways."},
    KeyNote{"boundaries.FACE.position", "Where the wall is at time 0; the face of the grid if not given."},
    KeyNote{
        "boundaries.FACE.at",
        "Where the wall acts: on the nodes at and beyond its plane, on its plane, which is exact for a body "
        "that stands against it, or on the surface of what reaches it."},
    KeyNote{"boundaries.FACE<at=surface>.friction", "Coulomb's coefficient of the wall on what touches it."},
    KeyNote{"boundaries.NAME",
            "A velocity given at some nodes, along one direction; the name heads its columns."},
    KeyNote{"boundaries.NAME.box", "All nodes in this box."},
    KeyNote{"boundaries.NAME.node", "The node nearest to this point."},
    KeyNote{"boundaries.NAME.direction",
            "The direction in which the velocity is given; the others are free."},
    KeyNote{"boundaries.NAME.speed", "The velocity along it."},

    KeyNote{"contact", "How bodies touch; none: all share one velocity field and stick together."},
    KeyNote{"contact.normal", "Where the normal of contact comes from."},
    KeyNote{"contact.specified_normal",
            "The normal, from the body listed first to the other, or into a rigid one."},
    KeyNote{"contact.separation", "How the gap between two bodies is measured."},
    KeyNote{"contact.position_offset", "Cells that position_offset takes off the gap."},
    KeyNote{"contact.piecewise_particles",
            "Particles along a cell's side that position_piecewise is made for."},
    KeyNote{"contact.detection", "What makes two bodies touch."},
    KeyNote{"contact.law", "What surfaces do that touch: the law of all pairs but those in `pairs`."},
    KeyNote{"contact.pairs[].law", "The law of this pair; what it leaves out is that of `contact`."},
    KeyNote{"*.friction", "Coefficient of friction while sliding; may stand beside any law."},
    KeyNote{"*.static_friction", "Coefficient up to which surfaces at rest stick; 0: as `friction`."},
    KeyNote{"*.decay_speed", "Speed over which friction falls from static to sliding."},
    KeyNote{"*.normal_strength", "Tension at which a bond breaks."},
    KeyNote{"*.shear_strength", "Shear at which a bond breaks."},
    KeyNote{"*.reach", "Cells: a bond acts up to this gap."},
    KeyNote{"*.viscosity", "Of the film between the surfaces."},
    KeyNote{"*.film", "Thickness of the film."},
    KeyNote{"contact.penalty", "Regression: holds the plane back, in units of the cell."},
    KeyNote{"contact.offset_penalty", "The same for the plane's offset."},
    KeyNote{"contact.tolerance", "Regression: it stops when the normal turns less (1 - n·n')."},
    KeyNote{"contact.max_iterations", "Regression: at most so many passes."},
    KeyNote{"contact.warm_start", "A regression starts from the plane of the last step."},
    KeyNote{
        "contact.rigid_bias",
        "A rigid body gives the normal unless its gradient is smaller by this factor; 10 or more: also in "
        "place of a regression; 0: off."},
    KeyNote{"contact.advance_separation",
            "The gap is judged where the bodies will be at the end of the step."},
    KeyNote{"contact.persistent",
            "One set of touching pairs a step, for both corrections and the strain: keeps energy."},
    KeyNote{"contact.first_correction_share", "flip: share of the first correction that particles take too."},
    KeyNote{"contact.hysteresis", "Cells: what touches goes on touching up to this gap."},
    KeyNote{"contact.mass_screen",
            "Nodes where a body has less than this share of the mass have no contact."},
    KeyNote{"contact.volume_screen", "Nodes with less material than this share of a cell have no contact."},
    KeyNote{"contact.corrections", "Contact corrections a step; 1: only after the forces have acted."},
    KeyNote{"contact.area", "How the area of contact is found, for bonds and films."},
    KeyNote{"contact.fields", "What is done where three or more bodies meet."},
    KeyNote{"contact.pairs", "Pairs of bodies or of materials with a law of their own."},
    KeyNote{"contact.pairs[].between", "Two bodies, by name."},
    KeyNote{"contact.pairs[].materials",
            "Two materials; also one and the same. A pair of bodies counts before it."},
};

constexpr std::array kEarly{
    KeyNote{"variables", "Numbers and quantities by name, for expressions `${…}` anywhere in the scene."},
    KeyNote{"include", "A scene that this one starts from, or several: paths counted from its folder."},
};

/// Is this the pattern, where `*` stands for one part or, at the front, for all that comes before?
bool fits(std::string_view note, std::string_view pattern) {
  if (note.starts_with("*.")) return pattern.ends_with(note.substr(1));
  const std::size_t star = note.find('*');
  if (star == std::string_view::npos) return note == pattern;
  const std::string_view before = note.substr(0, star), after = note.substr(star + 1);
  if (!pattern.starts_with(before) || !pattern.ends_with(after)) return false;
  if (pattern.size() < before.size() + after.size()) return false;
  const std::string_view middle =
      pattern.substr(before.size(), pattern.size() - before.size() - after.size());
  return middle.find('.') == std::string_view::npos;
}

}  // namespace

std::span<const KeyNote> key_notes() { return kNotes; }

std::span<const KeyNote> early_keys() { return kEarly; }

const KeyNote* note_on(const std::string& pattern) {
  for (const std::string& written : {pattern, unconditional(pattern)}) {
    const auto found = std::find_if(kNotes.begin(), kNotes.end(),
                                    [&](const KeyNote& n) { return fits(n.pattern, written); });
    if (found != kNotes.end()) return &*found;
  }
  return nullptr;
}

}  // namespace mpmfast
