#pragma once

/// @file The scene: what a user states, resolved to SI units with every default filled in.
/// Read by engine/scene/read_scene.hpp, consumed by engine/plan. Plain values, no behaviour.

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/geometry/fill.hpp"
#include "engine/quantities/time_table.hpp"
#include "engine/scene/loads.hpp"
#include "kernels/basis/bases.hpp"
#include "kernels/contact/laws.hpp"
#include "kernels/contact/penalty_spec.hpp"
#include "kernels/materials/laws.hpp"

namespace mpmfast {

enum class Space { plane_strain, plane_stress, axisymmetric, three_dimensional };
enum class UpdateKind { flip, pic, xpic, fmpm, apic };
/// When the particles' strain is updated within a step (USF, USL, USAVG), and whether that which comes last
/// is taken from the particles' new momenta (NN §2.8: USL+, USAVG+).
enum class StrainKind { first, last, average, last_re_extrapolated, average_re_extrapolated };
/// How particles move: with the grid's velocity at the end of the step, with its midpoint velocity, with
/// ½(V_old + V_new), with V_new.
enum class PositionKind { grid_end, grid, trapezoid, particle };
enum class NormalKind {
  logistic_regression,
  smoothed_logistic_regression,
  max_margin,
  smoothed_max_margin,
  logistic_irls,
  linear_regression,
  average_gradient,
  max_gradient,
  max_volume,
  own_gradient,
  specified
};
enum class SeparationKind {
  ellipsoid,
  ellipsoid_support,
  parallelogram_support,
  displacement,
  position_offset,
  position_power,
  position_piecewise,
  none
};
/// What makes two fields of a node touch: both their approach and their separation, or one alone.
enum class DetectionKind { both, velocity, separation };
/// How the contact area of a node is found, for the laws that need it.
enum class AreaKind { volume_gradient, nodal_volume };
/// Nodes of three or more fields: each against the lump of the others, pair by pair where one or two touch
/// (N20 §3.4), or all pairs that touch at once.
enum class ManyFields { lump, pairs, simultaneous };
/// Where interfaces know the jump of displacements from, as their bodies move through the cells.
enum class JumpKind { extrapolated, integrated };

/// What becomes of a particle a cell beyond the grid: the run stops as failed, or goes on without it; or
/// walls let none come there.
enum class OutflowKind { stop, outflow, wall };

struct GridSpec {
  Vec3 origin{0, 0, 0};  ///< m, lower corner of the domain that particles may occupy; a node lies there
  Vec3 size{0, 0, 0};    ///< m
  double cell = 0;       ///< m, edge of a (cubic) cell
  OutflowKind outflow = OutflowKind::stop;
};

struct TimeSpec {
  double end = 0;                                             ///< s
  double cfl = 0.5;                                           ///< Δt = cfl Δx / max_p(c_p + |v_p|)
  double max_step = std::numeric_limits<double>::infinity();  ///< s
  double collapse = 1e-3;  ///< a time step below this share of the first ends the run as failed; 0: never
};

struct MethodSpec {
  BasisKind basis = BasisKind::ugimp;
  UpdateKind update = UpdateKind::flip;
  int xpic_order = 1;    ///< m of XPIC(m) and FMPM(m), 2..20 when update is one of these
  int filter_every = 1;  ///< steps: XPIC(m) and FMPM(m) filter every n-th one, FLIP updates the others
  bool contact_correction = true;  ///< the Δv* terms of N20 Eq. 42
  /// XPIC filters each field's velocities from before the first contact correction, which then needs no Δv.
  bool own_filter = false;
  StrainKind strain =
      StrainKind::average_re_extrapolated;         ///< `average` where contact decides more than once
  PositionKind position = PositionKind::grid_end;  ///< FLIP moves with the grid, APIC with its velocity
  /// Terms of exp(Δt ∇v) kept after the identity: 1 or 2, kAllTerms or kInverse.
  int deformation_terms = 2;
  static constexpr int kAllTerms = 0;
  static constexpr int kInverse = -1;  ///< (I − Δt ∇v)⁻¹
  bool extended =
      false;  ///< splines: nodes with too little material near follow those with enough (K24 §3.3)
  double occupation = 0.6;  ///< C_c: a cell has enough that is filled to more than this share
  bool split = false;  ///< convected domains: particles are halved across edges that have become too long
  double split_edge = 1.5;  ///< cells, the longest edge
};

/// A law of kernels/materials, with its parameters.
struct MaterialSpec {
  std::string name;
  MaterialModel model;
  double heat_capacity = 0;  ///< J/(kg K), of laws that have none of their own; 0: not stated
  double conductivity = 0;   ///< W/(m K)
  double expansion = 0;      ///< of a length, 1/K
};

/// About an axis through a point that moves with the body's velocity; the speed of a deformable body is that
/// at the start.
struct RotationSpec {
  Vec3 about{};        ///< m, at time 0
  Vec3 axis{0, 0, 1};  ///< unit; z in 2-D
  TimeTable speed;     ///< rad/s, right-handed about the axis
};

struct BodySpec {
  std::string name;
  Shape shape;
  int material = 0;   ///< index into Scene::materials
  std::string field;  ///< bodies with the same name here share a velocity field; default: own name
  std::array<int, 3> particles_per_cell{2, 2, 2};  ///< per cell side
  Seeding seeding;
  Vec3 velocity{0, 0, 0};  ///< m/s, initial; of a rigid body: constant unless tables are given
  std::array<std::optional<TimeTable>, 3> rigid_velocity;  ///< rigid bodies: velocity component in time
  std::optional<RotationSpec> rotation;
  Vec3 acceleration{0, 0, 0};         ///< m/s², of a body that deforms, beside gravity and with its ramp
  std::optional<double> temperature;  ///< K, at the start; of its material or of the scene if not given
};

/// Where a wall acts: on the nodes at and beyond its plane; at the plane where that cuts a cell; or on what
/// reaches the plane, which it pushes and never pulls.
enum class WallEnforcement { nodes, plane, surface };

/// A half-space beyond a plane normal to an axis: wall, piston, symmetry plane.
struct WallSpec {
  int axis = 0;         ///< 0..2
  bool upper = false;   ///< what is at and beyond `position` in +axis (true) or −axis direction
  double position = 0;  ///< m, at time 0
  TimeTable speed;      ///< m/s along +axis; the plane moves with it
  bool fixed = false;   ///< also fixes the tangential velocity
  WallEnforcement enforcement = WallEnforcement::nodes;
  double friction = 0;  ///< Coulomb's, of a wall at the surface of bodies
};
/// Prescribed velocity along one direction at every node inside a box.
struct VelocityBoxSpec {
  Vec3 lower{}, upper{};  ///< m
  Vec3 direction{};       ///< unit vector
  TimeTable speed;        ///< m/s along `direction`
};

struct BoundarySpec {
  std::string name;
  std::variant<WallSpec, VelocityBoxSpec> condition;
};

/// A heat condition on the nodes at and beyond a face of the grid, or in a box.
struct HeatConditionSpec {
  enum class Kind { temperature, flux, ambient };
  std::string name;
  bool face = true;
  int axis = 0;
  bool upper = false;
  Vec3 lower{}, corner{};  ///< of a box, m
  Kind kind = Kind::temperature;
  TimeTable value;         ///< K; of a flux into the bodies W/m²; of what is around K
  double coefficient = 0;  ///< of heat transfer to what is around, W/(m² K)
};

struct HeatSpec {
  bool active = false;
  double temperature = 293;  ///< K, at the start
  /// Particles take what the temperatures of nodes change by; from time to time, if this is not 0, these
  /// temperatures themselves, through so many terms of an inverse of the full capacity matrix.
  int filter_order = 2;
  double filter_every = 1;  ///< in units of the time in which heat crosses a cell, h²/κ of the best conductor
  std::vector<HeatConditionSpec> conditions;
};

struct GravitySpec {
  Vec3 acceleration{0, 0, 0};  ///< m/s²
  double ramp = 0;             ///< s, linear from 0 to full
};

/// How heat crosses surfaces that touch.
struct ConductanceSpec {
  double touching = std::numeric_limits<double>::infinity();  ///< W/(m² K)
  double gap = 0;                                             ///< conductivity of what fills a gap, W/(m K)
};

/// What surfaces do that touch.
struct SurfaceLaw {
  AnyLaw acts;          ///< with its parameters
  double friction = 0;  ///< as stated, also beside a law that has none: another may take its place
  ConductanceSpec conductance;
};

/// A pair of bodies (that is, of their velocity fields) or of materials with a law of its own.
struct PairLawSpec {
  bool materials = false;  ///< `between` counts Scene::materials; else Scene::bodies
  std::array<int, 2> between{0, 0};
  SurfaceLaw law;
};

/// Where contact acts: on the nodes that several velocity fields share, or between surfaces that are
/// followed.
enum class ContactFamily { nodes, surface, penalty };

struct ContactSpec {
  bool active = true;  ///< false: every body shares one velocity field
  ContactFamily family = ContactFamily::nodes;
  PenaltySpec springs;  ///< of penalty contact
  SurfaceLaw law;       ///< of all pairs but those in `pairs`
  NormalKind normal = NormalKind::smoothed_max_margin;
  Vec3 specified_normal{0, 0, 0};  ///< from the lower-numbered field to the higher
  SeparationKind separation = SeparationKind::ellipsoid;
  double position_offset = 0.8;  ///< c of `position_offset`, in cells
  int piecewise_particles = 2;   ///< particles a cell side that `position_piecewise` is made for: 1 or 2
  DetectionKind detection = DetectionKind::both;
  double penalty = 1e-7;      ///< λ of the regression in cell units
  double offset_penalty = 0;  ///< the same on its offset (NN §3.4.5)
  double tolerance = 1e-5;    ///< on 1 − n'·n, where the regression stops
  int max_iterations = 15;    ///< of the regression
  bool warm_start = true;     ///< regressions start from the last step's plane
  double refit = 0;           ///< cells that fields may move (slide: 1/30) before normals are found anew
  /// Rigid bodies give the normal by their gradient unless it is this factor smaller than the other's; ≥ 10:
  /// in place of a regression too (NN §3.5). 0: off.
  double rigid_bias = 0;
  double volume_screen = 0;  ///< nodes with less material than this share of a cell have no contact (DC)
  bool advance_separation = true;  ///< corrections judge by δ + Δv·n Δt, Δv the free velocities (NN Eq. 3.56)
  /// Which pairs touch is decided once a step: the first correction holds them, parting or not, the second
  /// presses, and the momenta that are re-extrapolated hold what no force parted.
  bool persistent = true;
  /// Share of the first correction's impulse that FLIP's particles take too (N20: none). With strains that
  /// never see v′ they keep for good, without it, the approach that the grid is relieved of every step.
  double first_correction_share = 0;
  static constexpr double kDrained = 0.03;  ///< that share with strain first, last and average
  JumpKind jumps = JumpKind::extrapolated;  ///< of interfaces
  double hysteresis = 0;                    ///< cells; a node in contact stays so up to this gap
  /// Pairs with m_a/m_tot outside (s, 1 − s) are skipped. NN Eq. 4.1 has 1e-5; but a field of that little
  /// mass, left alone between pressed bodies, is thrown by its force and strains its particles: screen
  /// round-off only.
  double mass_screen = 1e-12;
  int corrections = 2;  ///< a step; 1: only after the momentum update ('LR once' of N20 Fig. 5)
  ManyFields fields = ManyFields::simultaneous;
  AreaKind area = AreaKind::volume_gradient;
  std::vector<PairLawSpec> pairs;
  bool cracked = false;               ///< surfaces in a box have no cohesive bond at the start
  Vec3 crack_lower{}, crack_upper{};  ///< its corners, m

  /// Can it be decided once a step which pairs touch? Else re-extrapolated strains make energy of contact.
  bool decides_once() const {
    return corrections == 2 && persistent && advance_separation && detection == DetectionKind::both &&
           separation != SeparationKind::none;
  }

  /// Does this hold of the law of all pairs, or of one of `pairs`?
  template <class F>
  bool any(F holds) const {
    return holds(law) ||
           std::any_of(pairs.begin(), pairs.end(), [&](const PairLawSpec& pair) { return holds(pair.law); });
  }
};

/// When a crack grows, and whereto.
enum class GrowthRule { hoop_stress, energy };

struct GrowthSpec {
  bool active = false;
  double toughness = 0;  ///< J/m²
  GrowthRule rule = GrowthRule::hoop_stress;
  double advance = 0.5;  ///< cells, at once
  double zone = 6;       ///< cells in which bonds of new pieces soften, where the crack's law has none
};

/// A surface inside a body, closed at the start, whose sides touch by a law.
struct CrackSpec {
  std::string name;
  int body = -1;
  std::vector<std::array<double, 2>> points;  ///< m; its corners, or those of an arc
  double spacing = 0;                         ///< of the points that follow it, m
  double contour = 6;                         ///< cells about an end, where J is found
  SurfaceLaw law;                             ///< between its sides
  GrowthSpec growth;
};

/// When a run writes its state down, beside at a signal and at its end.
struct CheckpointSpec {
  bool active = true;  ///< false: never
  double every = 600;  ///< s of wall time; 0: not by time
  int steps = 0;       ///< 0: not by steps
};

struct OutputSpec {
  int frames = 20;       ///< particle files, evenly spaced in time, beside the initial one; 0: none at all
  int history = 200;     ///< rows of history.csv beside the initial one
  bool overlap = false;  ///< 2-D: the history measures how much bodies enter each other
  bool grid = false;  ///< with each frame after the first, a file of the nodes: masses, velocities, contact
  CheckpointSpec checkpoint;
  std::string picture = "pressure";  ///< field of the second picture: pressure, von_mises, stress_xx, …
};

struct Scene {
  std::string title;
  std::filesystem::path file;  ///< where it was read from
  Space space = Space::plane_strain;
  double thickness = 1;  ///< m, of planes; 1 in axisymmetric scenes, which are whole round the axis
  GridSpec grid;
  TimeSpec time;
  MethodSpec method;
  std::vector<MaterialSpec> materials;
  std::vector<BodySpec> bodies;
  std::vector<BoundarySpec> boundaries;
  GravitySpec gravity;
  ContactSpec contact;
  std::vector<CrackSpec> cracks;
  HeatSpec heat;
  OutputSpec output;
  std::vector<LoadSpec> loads;  ///< beside gravity
  std::string resolved_yaml;  ///< the scene with every default written out; reading it gives this scene again
  int dimension() const { return space == Space::three_dimensional ? 3 : 2; }
};

/// Volume of a grid cell, m³.
double cell_volume(const Scene& scene);
/// Density of the undeformed material, kg/m³.
double density_of(const MaterialSpec& material);
/// Is the body made of a rigid material?
bool is_rigid(const Scene& scene, const BodySpec& body);
/// Do the particles of a body leave each other by its law?
bool parts(const Scene& scene, const BodySpec& body);
/// Is the body the right half of a shape that lies across the axis of an axisymmetric scene? A box begins
/// there.
bool is_halved(const Scene& scene, const BodySpec& body);
/// The particles that fill a body.
Seeds fill(const BodySpec& body, const GridSpec& grid, int dimension);

}  // namespace mpmfast
