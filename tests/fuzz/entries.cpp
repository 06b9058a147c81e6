#include "entries.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/geometry/load.hpp"
#include "engine/geometry/shapes.hpp"
#include "engine/geometry/surface.hpp"
#include "engine/scene/read_scene.hpp"
#include "tests/source_folder.hpp"

namespace mpmfast::fuzz {

namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

std::string text_of(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Of the lattice in the box around a shape: small ones only are filled.
double estimated_count(const Shape& shape, const std::array<int, 3>& per_cell, const GridSpec& grid) {
  const Bounds box = bounds(shape);
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) count *= 1 + (box.upper[k] - box.lower[k]) / grid.cell * per_cell[k];
  return count;
}

void fill_bodies(const Scene& scene) {
  constexpr double kMost = 1e4;
  for (const BodySpec& body : scene.bodies) {
    if (estimated_count(body.shape, body.particles_per_cell, scene.grid) > kMost) continue;
    for (const Vec3& point : fill(body, scene.grid, scene.dimension()).position)
      require(std::isfinite(point[0] + point[1] + point[2]), "a particle lies nowhere");
  }
}

}  // namespace

void read_scene_bytes(Bytes bytes) {
  // The pictures and surfaces that scenes of the corpus name lie beside this.
  const std::filesystem::path file = test::source_folder() / "tests/fuzz/corpus/scene.yaml";
  Scene scene;
  try {
    scene = parse_scene(text_of(bytes), file);
  } catch (const SceneError& error) {
    require(!error.diagnostics().empty(), "refused without a reason");
    for (const Diagnostic& one : error.diagnostics())
      require((one.line > 0 && one.column > 0) || one.message.rfind("empty", 0) == 0,
              "no place: " + one.text());
    return;
  }
  try {
    require(parse_scene(scene.resolved_yaml, file).resolved_yaml == scene.resolved_yaml,
            "the scene as written is another");
  } catch (const SceneError& error) {
    throw std::logic_error(std::string("the scene as written is refused: ") + error.what());
  }
  fill_bodies(scene);
}

void read_bitmap_bytes(Bytes bytes) {
  std::string why_not;
  const auto image = decode_grey_png(bytes, why_not);
  require(image ? image->width > 0 && image->height > 0 &&
                      image->pixel.size() ==
                          static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height)
                : !why_not.empty(),
          "neither a picture nor a reason");
}

void read_stl_bytes(Bytes bytes) {
  std::string why_not;
  const auto surface = decode_stl(bytes, why_not);
  if (!surface) return require(!why_not.empty(), "neither a surface nor a reason");
  BodySpec body;
  body.shape = StlShape{"", 1, {0, 0, 1}, 0, {0, 0, 0}, surface};
  const Bounds box = bounds(body.shape);
  GridSpec grid;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.origin[k] = box.lower[k];
    grid.size[k] = box.upper[k] - box.lower[k];
    grid.cell = std::max(grid.cell, grid.size[k] / 8);
  }
  const Seeds seeds = fill(body, grid, 3);
  for (const Vec3& point : seeds.position) {
    require(contains(body.shape, point), "a particle lies outside");
    for (std::size_t k = 0; k < 3; ++k)
      require(point[k] >= box.lower[k] && point[k] <= box.upper[k], "a particle lies outside the bounds");
  }
}

}  // namespace mpmfast::fuzz
