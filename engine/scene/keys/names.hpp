#pragma once

/// @file Every word of a scene that stands for a choice: read, written and listed from these tables.

#include <array>
#include <string_view>

#include "engine/scene/scene.hpp"
#include "kernels/measure.hpp"

namespace mpmfast {

inline constexpr std::array<Keyword<Space>, 4> kSpaces{{
    {Space::plane_strain, "plane_strain", "2-D, no strain along z"},
    {Space::plane_stress, "plane_stress", "2-D, no stress along z: thin plates; elastic laws only"},
    {Space::axisymmetric, "axisymmetric",
     "2-D, whole round the axis x = 0: x is the radius, zz the hoop; figures are those of the full turn"},
    {Space::three_dimensional, "3d", "three dimensions"},
}};

inline constexpr std::array<Keyword<OutflowKind>, 3> kOutflowKinds{{
    {OutflowKind::stop, "stop", "the run ends as failed when a particle is a cell beyond the grid (default)"},
    {OutflowKind::outflow, "outflow",
     "the run goes on without it; history.csv and run.json book what left: mass, energy, momentum"},
    {OutflowKind::wall, "wall", "each face that boundaries say nothing of is a wall without friction"},
}};

/// xpic and fmpm are written with their order, xpic(5).
inline constexpr std::array<Keyword<UpdateKind>, 5> kUpdates{{
    {UpdateKind::flip, "flip", "particles take the grid's acceleration; no dissipation (default)"},
    {UpdateKind::pic, "pic", "particles take the grid's velocity; strong damping"},
    {UpdateKind::xpic, "xpic(m)",
     "order m = 2..20: removes noise that the grid cannot see, little dissipation"},
    {UpdateKind::fmpm, "fmpm(m)",
     "order m = 2..20: as pic through an inverse of the full mass matrix; loses less than xpic(m)"},
    {UpdateKind::apic, "apic",
     "pic with an affine velocity about each particle: keeps angular momentum; B-splines only"},
}};

inline constexpr std::array<Keyword<StrainKind>, 5> kStrains{{
    {StrainKind::first, "first",
     "before the forces: keeps the energy of bodies that bounce or vibrate; may gain in what spins"},
    {StrainKind::last, "last", "after the particles: the cheapest"},
    {StrainKind::average, "average",
     "half before, half after: stable everywhere, takes energy from bodies of few cells"},
    {StrainKind::last_re_extrapolated, "last+",
     "after the particles, from the velocities that they give back to the grid (MUSL)"},
    {StrainKind::average_re_extrapolated, "average+",
     "half before, half after from the velocities that particles give back (default): keeps energy"},
}};

inline constexpr std::array<Keyword<PositionKind>, 4> kPositions{{
    {PositionKind::grid_end, "grid_end",
     "particles move with the grid's velocity at the end of the step: stable under any pressure (default)"},
    {PositionKind::grid, "grid",
     "particles move with the grid's midpoint velocity: exact in free fall, unstable where the pressure "
     "comes near the moduli"},
    {PositionKind::trapezoid, "trapezoid", "particles move with the mean of old and new velocity"},
    {PositionKind::particle, "particle", "particles move with their new velocity"},
}};

/// What is kept of exp(Δt ∇v) after the identity.
inline constexpr std::array<Keyword<int>, 4> kDeformationTerms{{
    {1, "1", "F advances by I + dt grad v"},
    {2, "2", "the same with the square of dt grad v (default of strain last and average, also with +)"},
    {MethodSpec::kInverse, "inverse",
     "F advances by (I - dt grad v)^-1: exact for a gradient at the end of the motion (default of strain "
     "first)"},
    {MethodSpec::kAllTerms, "exponential", "F advances by exp(dt grad v): rotations and det F are exact"},
}};

inline constexpr std::array<Keyword<ContactFamily>, 3> kFamilies{{
    {ContactFamily::nodes, "nodes",
     "on nodes that two bodies share: their velocities are corrected (default)"},
    {ContactFamily::surface, "surface",
     "at points of the surfaces that meet: one condition where the surface is"},
    {ContactFamily::penalty, "penalty",
     "between surfaces that points follow: springs push out what overlaps (K24)"},
}};

/// Normals and separations of contact on nodes as publications have them.
struct PublishedContact {
  NormalKind normal;
  SeparationKind separation;
  constexpr bool operator==(const PublishedContact&) const = default;
};

inline constexpr std::array<Keyword<PublishedContact>, 3> kPublishedContacts{{
    {{NormalKind::logistic_regression, SeparationKind::ellipsoid},
     "N20",
     "normal: logistic_regression, separation: ellipsoid (N20 Eq. 20 to 25)"},
    {{NormalKind::average_gradient, SeparationKind::position_power},
     "DF",
     "normal: average_gradient, separation: position_power (N20 section 2.3)"},
    {{NormalKind::average_gradient, SeparationKind::position_offset},
     "CP",
     "normal: average_gradient, separation: position_offset (N20 Eq. 16 with 0.8 cells)"},
}};

inline constexpr std::array<Keyword<NormalKind>, 11> kNormals{{
    {NormalKind::smoothed_max_margin, "smoothed_max_margin",
     "the mean of max_margin over the touching nodes around; with all that follows (default)"},
    {NormalKind::max_margin, "max_margin",
     "the plane that stays furthest from the particles of both sides; with warm starts, an advanced "
     "separation, persistent and simultaneous contact"},
    {NormalKind::logistic_regression, "logistic_regression",
     "the plane that best parts the particles, as published"},
    {NormalKind::smoothed_logistic_regression, "smoothed_logistic_regression",
     "its mean over the touching nodes around, with all of max_margin"},
    {NormalKind::logistic_irls, "logistic_irls", "the same by maximum likelihood (reweighted least squares)"},
    {NormalKind::linear_regression, "linear_regression", "the plane by linear regression alone"},
    {NormalKind::average_gradient, "average_gradient", "difference of the two volume gradients"},
    {NormalKind::max_gradient, "max_gradient", "the steeper of the two volume gradients"},
    {NormalKind::max_volume, "max_volume", "the volume gradient of the field with more volume on the node"},
    {NormalKind::own_gradient, "own_gradient",
     "each field by its own volume gradient; momentum is not conserved"},
    {NormalKind::specified, "specified", "specified_normal, from the lower-numbered field to the higher"},
}};

inline constexpr std::array<Keyword<SeparationKind>, 8> kSeparations{{
    {SeparationKind::ellipsoid, "ellipsoid",
     "gap between the particles' ellipsoids, radii straight along the normal (default)"},
    {SeparationKind::ellipsoid_support, "ellipsoid_support",
     "the same with the ellipsoids' full extent along the normal"},
    {SeparationKind::parallelogram_support, "parallelogram_support",
     "the same with the extent of the deformed domains"},
    {SeparationKind::displacement, "displacement",
     "difference of extrapolated displacements: for bodies that touch at the start"},
    {SeparationKind::position_offset, "position_offset",
     "gap of extrapolated positions less position_offset cells"},
    {SeparationKind::position_power, "position_power",
     "the same with a power law fitted to an edge's position"},
    {SeparationKind::position_piecewise, "position_piecewise",
     "the same, linear where that is exact; for piecewise_particles = 1 or 2 a cell side"},
    {SeparationKind::none, "none", "fields that approach are in contact"},
}};

inline constexpr std::array<Keyword<DetectionKind>, 3> kDetections{{
    {DetectionKind::both, "both", "surfaces that approach and overlap (default)"},
    {DetectionKind::velocity, "velocity", "surfaces that approach, near or far"},
    {DetectionKind::separation, "separation", "surfaces that overlap, also where they part: they stick"},
}};

inline constexpr std::array<Keyword<ManyFields>, 3> kManyFields{{
    {ManyFields::lump, "lump",
     "each field against all others of the node together (default of published normals)"},
    {ManyFields::pairs, "pairs", "one or two touching pairs are solved by themselves, more are lumped"},
    {ManyFields::simultaneous, "simultaneous",
     "all touching pairs of the node at once; conserves momentum (default)"},
}};

inline constexpr std::array<Keyword<GrowthRule>, 2> kGrowthRules{{
    {GrowthRule::hoop_stress, "hoop_stress",
     "across the largest hoop stress at the end, where K of it reaches sqrt(E' toughness) (default)"},
    {GrowthRule::energy, "energy", "straight on, where J reaches the toughness"},
}};

inline constexpr std::array<Keyword<JumpKind>, 2> kJumps{{
    {JumpKind::extrapolated, "extrapolated", "by the displacements of the particles (default)"},
    {JumpKind::integrated, "integrated", "by the sum of what each step adds, of the nodes around"},
}};

inline constexpr std::array<Keyword<AreaKind>, 2> kAreas{{
    {AreaKind::volume_gradient, "volume_gradient", "the node's share of the surface itself (default)"},
    {AreaKind::nodal_volume, "nodal_volume", "from the nodal volumes of the two fields"},
}};

/// Fields that output.picture can show.
inline constexpr std::array<const char*, 14> kPictures{
    "pressure",  "von_mises", "stress_difference", "stress_xx", "stress_yy",   "stress_zz",
    "stress_xy", "stress_yz", "stress_xz",         "speed",     "temperature", "plastic_strain",
    "body",      "none"};

/// What a face of the grid is in a word.
enum class FaceKind { wall, symmetry, fixed, free };
inline constexpr std::array<Keyword<FaceKind>, 4> kFaceKinds{{
    {FaceKind::wall, "wall", "nothing moves through it, it slides freely"},
    {FaceKind::symmetry, "symmetry", "another word for wall"},
    {FaceKind::fixed, "fixed", "a wall that also holds sideways"},
    {FaceKind::free, "free", "no condition (default)"},
}};

/// Does a wall hold sideways?
inline constexpr std::array<Keyword<bool>, 2> kWallKinds{{
    {false, "sliding", "it slides freely"},
    {true, "held", "it also holds sideways"},
}};

/// Where a wall acts.
inline constexpr std::array<Keyword<WallEnforcement>, 3> kWallEnforcements{{
    {WallEnforcement::nodes, "nodes", "it holds the nodes at and beyond its plane"},
    {WallEnforcement::plane, "plane", "it holds its plane, where that cuts a cell"},
    {WallEnforcement::surface, "surface", "it pushes what reaches its plane, which may part again and rub"},
}};

inline constexpr std::array<Keyword<SeedingKind>, 3> kSeedings{{
    {SeedingKind::lattice, "lattice", "on the grid's lattice, of a box on one of its own"},
    {SeedingKind::rings, "rings", "about the centre of a disk or a ring, so that its outline is smooth"},
    {SeedingKind::conforming, "conforming",
     "one layer along the outline of any shape in the plane, the grid's lattice inside"},
}};

struct FaceName {
  const char* name;
  int axis;
  bool upper;
};
/// The faces of the grid; back and front in 3-D only.
inline constexpr std::array<FaceName, 6> kFaces{{{"left", 0, false},
                                                 {"right", 0, true},
                                                 {"bottom", 1, false},
                                                 {"top", 1, true},
                                                 {"back", 2, false},
                                                 {"front", 2, true}}};

/// The face of this name; none.
inline const FaceName* face_named(std::string_view name) {
  for (const FaceName& face : kFaces)
    if (name == face.name) return &face;
  return nullptr;
}

/// The name of a choice, as a scene writes it.
template <class E, std::size_t N>
std::string_view name_of(const std::array<Keyword<E>, N>& words, E value) {
  for (const Keyword<E>& word : words) {
    if (word.value == value) return word.name;
  }
  return "";
}

}  // namespace mpmfast
