// What pictures show of cracks, of balls in 3-D and of the stress that they name.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/output/paint.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

/// The pixels of one colour: how many, and the rectangle around them.
struct Found {
  int count = 0, left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};

template <class IsIt>
Found find_pixels(Canvas canvas, const IsIt& is_it) {
  const std::vector<std::uint8_t> pixels = canvas.pixels();
  Found found;
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x) {
      const std::uint8_t* p = &pixels[3 * static_cast<std::size_t>(y * canvas.width() + x)];
      if (!is_it(Colour{p[0], p[1], p[2]})) continue;
      ++found.count;
      found.left = std::min(found.left, x);
      found.right = std::max(found.right, x);
      found.top = std::min(found.top, y);
      found.bottom = std::max(found.bottom, y);
    }
  return found;
}

/// Of what lies in a box of 1 m by 2 m, without particles: lines alone.
Canvas picture_of(const Polylines& lines) {
  Scene scene = small_scene(Space::plane_strain);
  scene.grid.size = {1, 2, 0};
  return paint_particles(Particles<2>(), scene, "body", 0, Framing{}, PictureFormat::png, lines);
}

/// Cracks are darker than the text and the frame.
Found find_lines(const Polylines& lines) {
  return find_pixels(picture_of(lines), [](Colour c) { return c.red < 30 && c.green < 30 && c.blue < 30; });
}

/// One ball in the middle of the box, with F = diag(f, 1, 1).
Particles<3> one_ball(double f) {
  Particles<3> particles;
  particles.allocate(1, {Quantity::position, Quantity::deformation_gradient, Quantity::initial_volume});
  particles.id()[0] = 0;
  particles.body()[0] = 0;
  for (int d = 0; d < 3; ++d) {
    particles.column(Quantity::position, d)[0] = 0.5;
    particles.column(Quantity::deformation_gradient, 4 * d)[0] = d == 0 ? f : 1;
  }
  particles.column(Quantity::initial_volume)[0] = 0.1;
  return particles;
}

Canvas picture_of(const Particles<3>& particles) {
  Scene scene = small_scene(Space::three_dimensional);
  scene.grid.cell = 1;  // domains are drawn no longer than a cell
  return paint_particles(particles, scene, "body", 0, Framing{});
}

}  // namespace

TEST_CASE("a crack is drawn wherever the box shows it, also above its width, and nowhere beyond") {
  const Found low = find_lines({{Vec<2>(0.25, 0.25), Vec<2>(0.5, 0.5), Vec<2>(0.75, 0.25)}});
  const Found high = find_lines({{Vec<2>(0.25, 1.5), Vec<2>(0.5, 1.75), Vec<2>(0.75, 1.5)}});
  CHECK(low.count > 100);
  CHECK(high.count > 100);
  CHECK(high.left == low.left);
  CHECK(high.right == low.right);
  CHECK(high.bottom < low.top);
  for (const Vec<2>& end : {Vec<2>(1.5, 0.25), Vec<2>(-0.5, 0.25), Vec<2>(0.25, 2.5), Vec<2>(0.25, -0.5)})
    CHECK(find_lines({{Vec<2>(0.5, 0.5), end}}).count == 0);
  CHECK(find_lines({{Vec<2>(0.5, 0.5)}, {}}).count == 0);
}

TEST_CASE("a ball has a dark rim all around it") {
  const Colour light = body_colour(0);
  const auto of_ball = [&](Colour c) {  // light, the rim's seven tenths of it, or a mean of the two
    return std::abs(c.red * light.blue - c.blue * light.red) < 6 * 255 && c.blue != c.red;
  };
  const Found ball = find_pixels(picture_of(one_ball(1)), of_ball);
  const Found face = find_pixels(picture_of(one_ball(1)), [&](Colour c) { return c == light; });
  const int width = ball.right - ball.left;
  REQUIRE(width > 100);
  CHECK(std::abs(ball.bottom - ball.top - width) < 3);
  for (const int rim :
       {face.left - ball.left, ball.right - face.right, face.top - ball.top, ball.bottom - face.bottom}) {
    CHECK(rim > 0.01 * width);
    CHECK(rim < 0.2 * width);
  }
}

TEST_CASE("a ball that is turned inside out is drawn as large as before") {
  CHECK(picture_of(one_ball(-1)).pixels() == picture_of(one_ball(1)).pixels());
}

TEST_CASE("a picture names the stress that it shows") {
  const Particles<3> particles = particles_in_order<3>(ascending(4));
  const Scene scene = small_scene(Space::three_dimensional);
  for (const std::string axes : {"xx", "zz", "xy", "yz", "xz"}) {
    const FieldValues values = field_values(particles, scene, "stress_" + axes);
    CHECK(values.label == "stress " + axes);
    CHECK(values.unit == "Pa");
  }
}
