// The generator of configs/ellipses.png.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include "tests/source_folder.hpp"
#include "tools/pack_ellipses/packing.hpp"

namespace mpmfast {
namespace {

TEST_CASE("the packing fills 85 % of the box, without overlap, and near grains differ in grey") {
  const Packing packing = pack({});
  const auto pixels = paint(packing);  // throws where two grains claim a pixel
  CHECK(area_fraction(pixels) == doctest::Approx(0.85).epsilon(0.02));
  CHECK(packing.grains.size() > 60);
  CHECK(std::set<int>(packing.grey.begin(), packing.grey.end()).size() == kGreys);
  const auto gaps = all_gaps(packing.grains);
  const std::size_t n = packing.grains.size();
  double least_aspect = 10, most_aspect = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double aspect = packing.grains[i].major / packing.grains[i].minor;
    least_aspect = std::min(least_aspect, aspect);
    most_aspect = std::max(most_aspect, aspect);
    for (std::size_t j = 0; j < i; ++j) {
      REQUIRE(gaps[i * n + j] > 0);
      // Grains of one velocity field would be welded: they stay several cells (4 pixels each) apart.
      if (packing.grey[i] == packing.grey[j]) REQUIRE(gaps[i * n + j] > 40);
    }
  }
  CHECK(most_aspect > 1.5 * least_aspect);
}

TEST_CASE("the same seed gives the same packing, another seed another") {
  PackingOptions small;
  small.width = 140;
  small.height = 140;
  small.fraction = 0.7;
  const auto once = paint(pack(small)), again = paint(pack(small));
  small.seed = 2;
  CHECK(once == again);
  CHECK(once != paint(pack(small)));
}

TEST_CASE("configs/ellipses.png is what the generator writes") {
  int width = 0, height = 0, channels = 0;
  unsigned char* image =
      stbi_load((test::source_folder() / "configs/ellipses.png").c_str(), &width, &height, &channels, 1);
  REQUIRE(image != nullptr);
  const auto pixels = paint(pack({}));
  CHECK(channels == 1);
  REQUIRE(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) == pixels.size());
  CHECK(std::equal(pixels.begin(), pixels.end(), image));
  stbi_image_free(image);
}

}  // namespace
}  // namespace mpmfast
