#pragma once

/// @file The sections of a scene: each is described once, and read, written and listed by its description
/// (keys.hpp). What follows from several sections is checked after they are read.

#include <string>
#include <utility>
#include <vector>

#include "engine/scene/keys/keys.hpp"

namespace mpmfast {

/// Where a body was written.
struct BodyLocation {
  Value entry, name;
};
/// The whole scene.
/// @return the places of the bodies that are read
std::vector<BodyLocation> describe_scene(Keys& top, Scene& scene);
/// The scene with every default, in the format that is read.
std::string write_scene(const Scene& scene);

/// False when there is no grid to check positions against.
bool describe_grid(Keys& top, int dimension, GridSpec& grid);
void describe_time(Keys& top, TimeSpec& time);
void describe_gravity(Keys& top, int dimension, GravitySpec& gravity);
/// Needs the bodies.
void describe_loads(Keys& top, Scene& scene);
/// Needs the grid.
void describe_heat(Keys& top, bool grid_known, Scene& scene);
void describe_output(Keys& top, int dimension, OutputSpec& output);
/// @return whether the strain is stated
bool describe_method(Keys& top, MethodSpec& method);
/// Chooses the strain that suits the contact where the scene states none. Needs the bodies.
void describe_contact(Keys& top, bool strain_stated, Scene& scene);
/// `law` and its parameters; what is absent keeps its value, also where another law has it.
/// @param heat  the scene has temperatures
void describe_law(Keys& map, const char* description, bool heat, SurfaceLaw& law);
/// The same without heat.
void describe_tractions(Keys& map, const char* description, SurfaceLaw& law);
/// `contact.pairs`. Needs the bodies.
/// @param top  the scene, where bodies stand that could not be read
void describe_pairs(Keys& contact, Keys& top, Scene& scene);
/// `cracks`. Needs the grid, the bodies and the contact.
void describe_cracks(Keys& top, Scene& scene);
/// Every name appears in the scene, also when its model is wrong, so that bodies may refer to it.
void describe_materials(Keys& top, std::vector<MaterialSpec>& materials);
/// Needs grid and materials.
/// @return the places of the bodies that are read
std::vector<BodyLocation> describe_bodies(Keys& top, Scene& scene);
/// Needs the grid and the bodies.
void describe_boundaries(Keys& top, bool grid_known, Scene& scene);

/// A direction: x, +x, -x, left, up, out … or (when `any`) a vector, made a unit vector.
void describe_direction(Slot& slot, int dimension, bool any, Vec3& direction);
/// A vector, made a unit vector where it is read.
void take_unit_vector(Slot& slot, int dimension, Vec3& direction);
/// {from, to}: the corners of a box along the axes.
void describe_corners(Slot& slot, int dimension, Vec3& lower, Vec3& upper);
/// The same, of which `to` may lie beside `from`, as of a row of nodes, but not below.
void describe_region(Slot& slot, int dimension, Vec3& lower, Vec3& upper);
/// Points in the plane, at least so many. @return whether they are read and good
bool take_points(Slot& slot, int least, const char* expected, std::vector<std::array<double, 2>>& points);
/// A path as written; made absolute from the folder of the scene where it is read.
void describe_file(Slot& slot, const Scene& scene, std::filesystem::path& file);

// Checks of a scene that was read.

/// Refuses walls with bodies behind them, and pistons that would go through the wall on the other side.
void check_walls(const Value& top, const Scene& scene);
/// `grid.leaving: wall`: a wall on each face that `boundaries` says nothing of. Needs everything else.
void close_faces(const Value& top, Scene& scene);
/// Refuses laws that plane stress cannot have.
void check_plane_stress(const Value& top, const Scene& scene);
/// Refuses loads on surfaces where these are not known.
void check_loads(const Value& top, const Scene& scene);
/// Refuses what cracks do not know.
void check_cracks(const Value& top, const Scene& scene);
/// Refuses what heat does not know, and materials that it knows too little of.
void check_heat(const Value& top, const Scene& scene, const std::vector<BodyLocation>& locations);
/// Refuses what does not turn about the axis, and makes the axis a wall. Needs everything else.
void check_axisymmetric(const Value& top, bool grid_known, Scene& scene);

/// What a body must not be, beside others, in this grid, of this material.
void check_bodies(const Scene& scene, const std::vector<BodyLocation>& locations, bool grid_known);
/// How the particles of a body lie where a scene does not say: along its outline where they can.
SeedingKind usual_seeding(const Scene& scene, const BodySpec& body);
/// Tables make sense only where the body obeys them.
void check_tables(const Value& entry, const Scene& scene, const BodySpec& body);

// What there is to choose from.

/// A kind of body: the key that names it in a scene.
struct ShapeKind {
  const char* name;
  int dimension;                                                   ///< 2, 3, or 0 for both
  const char* description;                                         ///< a line for `mpmfast list`
  const char* note;                                                ///< what the key means
  void (*describe)(Slot& slot, Shape& shape, const Scene& scene);  ///< none for a bitmap, which is several
  Shape standard;                                                  ///< the struct that holds it
  bool written;                                                    ///< shapes of this struct have this name
};
const std::vector<ShapeKind>& shape_kinds();

/// A bitmap and the keys beside it: one body for each grey level that is not skipped.
struct BitmapEntry {
  BitmapShape shape;  ///< its lower corner and image
  Vec3 extent{};
  std::vector<int> skip;
  std::vector<int> levels;                             ///< that are read and not skipped
  std::vector<std::pair<std::string, int>> materials;  ///< grey level, index of its material; −1: unknown
};
/// What one entry of `bodies` says: one body, or one for each grey level of a bitmap.
struct BodyEntry {
  BodySpec body;
  BitmapEntry bitmap;
  bool shaped = false, made = false;  ///< has it a good shape, and a material?
};

/// The bodies as the entries that they came from.
std::vector<BodyEntry> entries_of(const Scene& scene);
/// `bitmap` itself, and what stands beside it.
void describe_bitmap(Slot& slot, const Scene& scene, BitmapEntry& entry);
void describe_bitmap_keys(Keys& body, const Scene& scene, const std::vector<std::string>& material_names,
                          BitmapEntry& entry);

/// A law that a model may be.
struct LawChoice {
  const char* with;        ///< the key that asks for it, where the model has several; else empty
  MaterialModel standard;  ///< the law with its defaults
  void (*describe)(Keys& map, MaterialModel& model);
};
struct MaterialKind {
  const char* name;
  const char* description;
  std::vector<LawChoice> laws;  ///< that which needs no key first
};
/// Every model that a scene may name, from kernels/materials/laws.hpp.
const std::vector<MaterialKind>& material_kinds();

/// A parameter of a contact law.
struct LawParameter {
  std::string name;
  bool needed;  ///< has no default
};
struct ContactLawKind {
  const char* name;
  const char* description;
  AnyLaw standard;
  std::vector<LawParameter> parameters;
};
/// Every contact law, from kernels/contact/laws.hpp.
const std::vector<ContactLawKind>& contact_laws();
/// The parameters that any of them has.
std::vector<std::string> contact_parameters();

/// Keys that are done with before the sections are read: their name and what they mean.
const std::vector<KnownKeyword>& early_keys();

}  // namespace mpmfast
