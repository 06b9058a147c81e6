// N20 section 4.2: the grains of configs/ellipses.yaml at half its resolution. How much they enter each other
// with the scene's own normals, against average gradients with a separation of positions ('DF').

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

#include "engine/geometry/shapes.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

using Overrides = std::vector<Override>;

struct Entered {
  Overlap overlap;
  double stress = 0;  ///< Pa, mean axial stress at the end
};

Entered pressed(Overrides overrides, const Overrides& more) {
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Overrides common{{"method.update", "xpic(5)"},
                         {"grid.cell", "1/35 mm"},
                         {"output.frames", "0"},
                         {"output.history", "4"},
                         {"output.overlap", "true"}};
  overrides.insert(overrides.end(), common.begin(), common.end());
  const Outcome outcome = run(scene_file("ellipses.yaml", overrides));
  REQUIRE(outcome.failure == "");
  REQUIRE(outcome.history.at("overlap_m2").front() < 1e-18);  // each place of the picture goes to one grain
  return {outcome.summary.overlap.value(), outcome.history.at("all.mean_stress_yy_Pa").back()};
}

Entered with_default_normals(const Overrides& scene) { return pressed(scene, {}); }

Entered with_average_gradients(const Overrides& scene) {
  return pressed(scene, {{"contact.normal", "average_gradient"}, {"contact.separation", "position_power"}});
}

/// The lowest three tenths of the picture, in a die of 1 x 0.6 mm.
Overrides lowest_grains(const Folder& folder) {
  const Scene scene = scene_file("ellipses.yaml");
  const GreyImage& image = *std::get<BitmapShape>(scene.bodies.front().shape).image;
  const int rows = 3 * image.height / 10;
  const auto upper = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height - rows);
  const std::string file = (folder / "lowest.png").string();
  REQUIRE(stbi_write_png(file.c_str(), image.width, rows, 1, image.pixel.data() + upper, image.width) != 0);
  return {{"bodies.0.bitmap", file}, {"bodies.0.extent", "[1 mm, 0.6 mm]"}, {"grid.size", "[1 mm, 0.6 mm]"}};
}

TEST_CASE("ellipses: grains pressed by 40 % enter each other at most a tenth as much as with DF") {
  const Folder folder;
  Overrides scene = lowest_grains(folder);
  scene.push_back({"time.end", "2.4 us"});
  const Entered ours = with_default_normals(scene), df = with_average_gradients(scene);
  CHECK(ours.overlap.area < df.overlap.area / 10);      // measured: 0.0028 against 0.051 mm²
  CHECK(ours.overlap.inside < df.overlap.inside / 10);  // 0.0022 against 0.100 mm²
  CHECK(ours.stress < 1.5 * df.stress);                 // compression: −44.7 against −22.7 GPa
}

TEST_CASE("slow: ellipses: grains pressed by 75 % enter each other at most a tenth as much as with DF") {
  const Entered ours = with_default_normals({}), df = with_average_gradients({});
  CHECK(ours.overlap.area < df.overlap.area / 10);      // measured: 0.070 against 1.91 mm²
  CHECK(ours.overlap.inside < df.overlap.inside / 10);  // 0.072 against 1.36 mm²
}

}  // namespace
}  // namespace mpmfast
