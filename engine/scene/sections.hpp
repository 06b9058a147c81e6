#pragma once

/// @file The parts of a scene, each read by one file read_*.cpp.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/fields.hpp"
#include "engine/scene/geometry.hpp"
#include "engine/scene/scene.hpp"

namespace mpmfast {

/// False when the scene has no grid to check positions against (already reported).
bool read_grid(MapReader& top, int dimension, GridSpec& grid);
void read_time(MapReader& top, TimeSpec& time);
void read_gravity(MapReader& top, int dimension, GravitySpec& gravity);
void read_output(MapReader& top, int dimension, OutputSpec& output);
/// @return whether the scene states its strain
bool read_method(MapReader& top, MethodSpec& method);
/// @param strain  stated, or to be found: what suits the contact
void read_contact(MapReader& top, int dimension, bool strain_stated, StrainKind& strain,
                  ContactSpec& contact);
/// `law` and its parameters; what is absent keeps its value.
void read_law(MapReader& map, LawSpec& law);
/// Needs the contact section and the bodies.
void read_contact_pairs(MapReader& top, Scene& scene);
/// `rotation` of a body.
void read_rotation(MapReader& body, int dimension, BodySpec& spec);
/// Every name appears in the scene, also when its model is wrong, so that bodies may refer to it.
void read_materials(MapReader& top, std::vector<MaterialSpec>& materials);
/// Needs grid, materials and contact; checks bodies against them when `grid_known`.
void read_bodies(MapReader& top, bool grid_known, Scene& scene);
/// Needs the grid and the bodies.
void read_boundaries(MapReader& top, bool grid_known, Scene& scene);
/// Refuses walls with bodies behind them, and pistons that would go through the wall on the other side.
void check_walls(MapReader& boundaries, const Scene& scene);
/// `grid.leaving: wall`: a wall on each face that `boundaries` says nothing of. Needs everything else.
void close_faces(MapReader& top, Scene& scene);

/// Refuses laws that plane stress cannot have.
void check_plane_stress(MapReader& top, const Scene& scene);
/// Refuses what does not turn about the axis, and makes the axis a wall. Needs everything else.
void check_axisymmetric(MapReader& top, bool grid_known, Scene& scene);

/// A kind of body: the key that names it in a scene, and how its value is read.
struct ShapeKind {
  const char* name;
  int dimension;  ///< 2, 3, or 0 for both
  const char* says;
  std::optional<Shape> (*read)(const Value& value, const Scene& scene);  ///< needs the head of the scene
};
const std::vector<ShapeKind>& shape_kinds();

/// `stl` of a body.
std::optional<Shape> read_stl(const Value& value, const Scene& scene);

/// A bitmap entry: one shape for each grey level that is not skipped.
struct BitmapPart {
  BitmapShape shape;
  std::optional<Value> material;  ///< from `materials: {GREY: NAME}`
};
std::vector<BitmapPart> read_bitmap(MapReader& body, const Value& bitmap, const Scene& scene);

/// The content of a file that a scene names. On failure, as also below, returns nothing and says why.
std::optional<std::vector<unsigned char>> load_bytes(const std::filesystem::path& file, std::string& why_not);

/// Decodes an 8-bit grey PNG.
std::shared_ptr<const GreyImage> load_grey_png(const std::filesystem::path& file, std::string& why_not);
std::shared_ptr<const GreyImage> decode_grey_png(std::span<const unsigned char> bytes, std::string& why_not);

/// Reads an STL file, text or binary, in its own lengths: a closed surface, or nothing.
std::shared_ptr<const Surface> load_stl(const std::filesystem::path& file, std::string& why_not);
std::shared_ptr<const Surface> decode_stl(std::span<const unsigned char> bytes, std::string& why_not);

struct MaterialKind {
  const char* name;
  const char* says;
  decltype(MaterialSpec::model) (*read)(MapReader& map);
};
const std::vector<MaterialKind>& material_kinds();
/// `volumetric` (bulk or lambda) and shear, or young and poisson in their place.
void read_moduli(MapReader& map, const char* volumetric, double& modulus, double& shear);
decltype(MaterialSpec::model) read_mie_gruneisen(MapReader& map);
decltype(MaterialSpec::model) read_j2_plasticity(MapReader& map);
decltype(MaterialSpec::model) read_johnson_cook(MapReader& map);

/// A number that some laws have.
struct LawParameter {
  const char* name;
  Measure measure;
  Limit limit;
  double LawSpec::*value;
  std::vector<LawKind> laws;
  bool needed;  ///< has no default
};
const std::vector<LawParameter>& law_parameters();
bool has_parameter(LawKind law, const LawParameter& parameter);

/// A direction: x, +x, -x, left, up, out … or (when `any`) a vector, made a unit vector.
std::optional<Vec3> read_direction(const Value& value, int dimension, bool any);

/// The vector with length 1; one that has it to round-off is kept as it is, so that reading what was written
/// changes nothing. Nothing for a zero vector.
std::optional<Vec3> unit_vector(const Vec3& vector);

/// What a good scene says that is likely a mistake.
void find_suspicions(const Node& root, const Scene& scene, Problems& found);
/// Warns of a grid of which nearly all lies where nothing comes: its cells take memory and time.
/// @param place  of its size
void find_idle_cells(const Place& place, const Scene& scene, Problems& found);
/// Of what is written, whatever it comes to: degrees where radians are read.
void find_suspicious_text(const Node& root, Problems& found);

/// The keys of a metal.
std::string metal_text(const MetalSpec& metal);

/// The scene with every default, in the format that parse_scene reads.
std::string write_scene(const Scene& scene);

}  // namespace mpmfast
