// The pixels of shapes against samples that are counted one by one, and files against what was drawn.

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "engine/output/canvas.hpp"
#include "tests/random.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;
using mpmfast::test::Random;

namespace {

constexpr int kWidth = 30, kHeight = 22, kSide = Canvas::kSamples;
constexpr Colour kBlue{40, 90, 200}, kGreen{20, 160, 31};

struct Polygon {
  std::vector<PixelPoint> corners;
  Colour colour;
};

/// Upright, the corners one way round or the other: along their edges Cairo takes samples at their centres.
Polygon rectangle(Random& random, double size, Colour colour) {
  const PixelPoint low{random.in(-4, kWidth + 1), random.in(-4, kHeight + 1)},
      high{low.x + random.in(0.4, 1) * size, low.y + random.in(0.4, 1) * size};
  Polygon out{{low, {high.x, low.y}, high, {low.x, high.y}}, colour};
  if (random.in(0, 1) < 0.5) std::reverse(out.corners.begin(), out.corners.end());
  return out;
}

/// How far a point is within the polygon's edges, negative outside.
double depth_in(const Polygon& polygon, double x, double y) {
  double least = 1e9, turn = 0;
  const auto& c = polygon.corners;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const PixelPoint &a = c[i], &b = c[(i + 1) % c.size()];
    turn += a.x * b.y - a.y * b.x;
  }
  for (std::size_t i = 0; i < c.size(); ++i) {
    const PixelPoint &a = c[i], &b = c[(i + 1) % c.size()];
    const double cross = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    least = std::min(least, (turn < 0 ? -1 : 1) * cross / std::hypot(b.x - a.x, b.y - a.y));
  }
  return least;
}

TEST_CASE("a pixel is the mean of its nine samples, each in the colour of the last polygon over its centre") {
  constexpr double kUnsure = 0.1 / kSide;  // a tenth of a sample: Cairo rounds corners
  Random random(1);
  for (int picture = 0; picture < 3; ++picture) {
    std::vector<Polygon> polygons;
    for (int k = 0; k < 14; ++k)
      polygons.push_back(rectangle(random, k % 2 == 0 ? 12 : 1.2, k % 5 == 0 ? kGreen : kBlue));
    for (int k = 0; k < 30; ++k) {  // small ones, each twice, the second the other way round
      polygons.push_back(rectangle(random, 0.7, kGreen));
      polygons.push_back(polygons.back());
      std::reverse(polygons.back().corners.begin(), polygons.back().corners.end());
    }
    polygons.push_back({{{-1, -1}, {2.5, -1}, {2.5, 2.5}, {-1, 2.5}}, kBlue});  // the first pixel
    polygons.push_back({{{27, 20}, {40, 20}, {40, 40}, {27, 40}}, kGreen});     // the last
    Canvas canvas(kWidth, kHeight);
    for (const Polygon& p : polygons) canvas.fill_convex(p.corners, p.colour);
    const std::vector<std::uint8_t> pixels = canvas.pixels();
    REQUIRE(pixels.size() == 3 * kWidth * kHeight);
    int known = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        std::array<unsigned, 3> sum{};
        bool sure = true;
        for (int j = 0; j < kSide; ++j)
          for (int i = 0; i < kSide; ++i) {
            Colour colour{255, 255, 255};
            for (const Polygon& p : polygons) {
              const double depth = depth_in(p, x + (i + 0.5) / kSide, y + (j + 0.5) / kSide);
              if (std::abs(depth) < kUnsure) sure = false;
              if (depth > 0) colour = p.colour;
            }
            sum[0] += colour.red;
            sum[1] += colour.green;
            sum[2] += colour.blue;
          }
        if (!sure) continue;
        ++known;
        for (std::size_t c = 0; c < 3; ++c)
          CHECK(pixels[3 * static_cast<std::size_t>(y * kWidth + x) + c] == std::lround(sum[c] / 9.0));
      }
    CHECK(known > kWidth * kHeight * 2 / 3);
  }
}

TEST_CASE("a PNG file has the pixels that were drawn, and an image of its size") {
  Random random(2);
  for (int picture = 0; picture < 3; ++picture) {
    const TemporaryFolder folder;
    Canvas canvas(kWidth, kHeight);
    for (int k = 0; k < 20; ++k) {
      const Polygon p = rectangle(random, 6, k % 2 == 0 ? kBlue : Colour{250, 100, 3});
      canvas.fill_convex(p.corners, p.colour);
    }
    const std::vector<std::uint8_t> pixels = canvas.pixels();
    canvas.write(folder.path() / "x.png");
    const std::string file = read_text(folder.path() / "x.png");
    int width = 0, height = 0, channels = 0;
    stbi_uc* read = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()),
                                          static_cast<int>(file.size()), &width, &height, &channels, 3);
    REQUIRE(read != nullptr);
    CHECK(width == kWidth);
    CHECK(height == kHeight);
    CHECK(std::equal(pixels.begin(), pixels.end(), read));
    stbi_image_free(read);
  }
}

TEST_CASE("a page of PDF has two pixels a point, and shapes of a vector picture are where they were drawn") {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair(120, 80), std::pair(600, 900)}) {
    Canvas page(width, height, PictureFormat::pdf);
    page.fill_disc({50, 40}, 20, kBlue);
    page.write(folder.path() / "x.pdf");
    const std::string size = std::to_string(width / 2) + " " + std::to_string(height / 2) + " ]";
    CHECK(read_text(folder.path() / "x.pdf").find("/MediaBox [ 0 0 " + size) != std::string::npos);
  }
  Canvas vectors(120, 80, PictureFormat::svg);
  vectors.fill_convex(std::array<PixelPoint, 3>{{{10, 20}, {50, 30}, {15, 60}}}, kBlue);
  vectors.write(folder.path() / "x.svg");
  const std::string svg = read_text(folder.path() / "x.svg");
  CHECK(svg.find("M 10 20 L 50 30 L 15 60 Z") != std::string::npos);
  CHECK(svg.find("width=\"120px\"") != std::string::npos);
  CHECK(svg.find("height=\"80px\"") != std::string::npos);
}

}  // namespace
