#include <doctest/doctest.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <pugixml.hpp>
#include <stdexcept>

#include "engine/output/paint.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/scales.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

struct Png {
  explicit Png(const std::filesystem::path& path)
      : pixel(stbi_load(path.c_str(), &width, &height, &channels, 3), stbi_image_free) {
    REQUIRE(pixel);
  }
  std::array<int, 3> at(int x, int y) const {
    const unsigned char* p = pixel.get() + 3 * (y * width + x);
    return {p[0], p[1], p[2]};
  }
  std::size_t count(Colour colour) const {
    std::size_t found = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        found += at(x, y) == std::array<int, 3>{colour.red, colour.green, colour.blue} ? 1u : 0u;
    return found;
  }
  int width = 0, height = 0, channels = 0;
  std::unique_ptr<unsigned char, void (*)(void*)> pixel;
};

/// A square lattice that fills [0, 1]² with two bodies side by side.
Particles<2> lattice(int side) {
  Particles<2> particles;
  particles.allocate(static_cast<std::size_t>(side * side),
                     {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                      Quantity::initial_volume, Quantity::kirchhoff_stress, Quantity::out_of_plane_stretch});
  for (int i = 0; i < side * side; ++i) {
    const auto p = static_cast<std::size_t>(i);
    particles.id()[p] = static_cast<std::uint32_t>(i);
    particles.column(Quantity::position, 0)[p] = (i % side + 0.5) / side;
    particles.column(Quantity::position, 1)[p] = (i / side + 0.5) / side;
    particles.body()[p] = particles.column(Quantity::position, 0)[p] < 0.5 ? 0 : 1;
    particles.column(Quantity::initial_volume)[p] = 1.0 / (side * side);
    particles.column(Quantity::deformation_gradient, 0)[p] = 1;
    particles.column(Quantity::deformation_gradient, 3)[p] = 1;
    particles.column(Quantity::out_of_plane_stretch)[p] = 1;
    particles.column(Quantity::kirchhoff_stress, 0)[p] = particles.column(Quantity::position, 0)[p];
  }
  return particles;
}

}  // namespace

TEST_CASE("a picture is a PNG of the right size whose particles leave no gaps") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "picture_body.png";
  draw_particles(path, lattice(20), small_scene(Space::plane_strain), "body", 1e-3);
  const Png png(path);
  CHECK(std::max(png.width, png.height) == 1000);
  CHECK(std::min(png.width, png.height) > 800);
  const std::size_t first = png.count(body_colour(0)), second = png.count(body_colour(1));
  CHECK(first == doctest::Approx(static_cast<double>(second)).epsilon(0.01));
  // The plot box is the unit square and 5 % more, in a picture with some 90 pixels of margins.
  CHECK(first + second > 0.9 * std::pow((png.width - 120) / 1.05, 2));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "picture_body.png.tmp"));
}

TEST_CASE("rigid bodies have speeds and names, and neither stress nor strain") {
  const Scene scene = small_scene(Space::plane_strain);
  const Particles<2> particles = particles_in_order<2>(ascending(9));  // every third of the punch
  for (const char* field :
       {"pressure", "stress_xy", "volume_ratio", "speed", "velocity_x", "body", "material"}) {
    CAPTURE(std::string(field));
    const FieldValues values = field_values(particles, scene, field);
    const bool of_all = values.names || values.unit == "m/s";
    for (std::size_t p = 0; p < 9; ++p) CHECK(std::isnan(values.value[p]) == (p % 3 == 2 && !of_all));
  }
}

TEST_CASE("pictures of no particles, of NaN and of missing columns do not fail") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.png";
  const Scene flat = small_scene(Space::plane_strain), solid = small_scene(Space::three_dimensional);
  draw_particles(path, Particles<2>(), flat, "body", 0);
  CHECK(Png(path).width > 200);
  draw_particles(path, Particles<3>(), solid, "pressure", 0);
  CHECK(Png(path).width > 200);

  Particles<2> particles = lattice(4);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  particles.column(Quantity::position, 0)[0] = kNan;
  particles.column(Quantity::position, 1)[1] = std::numeric_limits<double>::infinity();
  particles.column(Quantity::kirchhoff_stress, 0)[2] = kNan;
  particles.column(Quantity::deformation_gradient, 0)[3] = kNan;
  for (const char* field : {"body", "pressure", "von_mises", "speed", "stress_xx", "stress_xz"}) {
    draw_particles(path, particles, flat, field, kNan);
    CHECK(Png(path).width > 200);
  }
  Particles<2> bare;
  bare.allocate(3, {Quantity::position});
  draw_particles(path, bare, flat, "pressure", 0);
  CHECK(Png(path).width > 200);
  CHECK_THROWS_AS(draw_particles(path, particles, flat, "colour", 0), std::invalid_argument);
}

TEST_CASE("a picture in 3-D shows the near bodies") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.png";
  draw_particles(path, particles_in_order<3>(ascending(2000)), small_scene(Space::three_dimensional), "body",
                 1e-3);
  const Png png(path);
  CHECK(std::max(png.width, png.height) == 1000);
  CHECK(png.count(body_colour(0)) > 1000);
}

TEST_CASE("vectors of a picture hold its title, particles of one colour in one path, and fit a page") {
  Scene scene = small_scene(Space::plane_strain);
  scene.title = "Two \"blocks\" & a <punch>, 3 µm";
  const Particles<2> particles = lattice(20);
  const Framing framing = framing_of(particles, scene, "body");
  const TemporaryFolder folder;
  for (const auto format : {PictureFormat::svg, PictureFormat::pdf})
    paint_particles(particles, scene, "body", 0, framing, format)
        .write(folder.path() / (format == PictureFormat::svg ? "x.svg" : "x.pdf"));
  pugi::xml_document svg;
  REQUIRE(svg.load_file((folder.path() / "x.svg").c_str()).status == pugi::status_ok);
  CHECK(svg.select_nodes("//path").size() < 25);  // ticks and the frame too
  bool titled = false;
  for (const auto& text : svg.select_nodes("//text"))
    titled = titled || text.node().text().as_string() == scene.title;
  CHECK(titled);
  const std::string pdf = read_text(folder.path() / "x.pdf");
  const std::size_t box = pdf.find("/MediaBox [ 0 0 ");
  REQUIRE(box != std::string::npos);
  CHECK(std::stod(pdf.substr(box + 16)) < 595);  // points of A4
}

TEST_CASE("the axes of a picture are x and y, about an axis of symmetry r and z") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.svg";
  const Particles<2> particles = lattice(5);
  for (const Space space : {Space::plane_strain, Space::plane_stress, Space::axisymmetric}) {
    const Scene scene = small_scene(space);
    const std::string unit = " (" + length_unit(scene).name + ")";
    paint_particles(particles, scene, "body", 0, framing_of(particles, scene, "body"), PictureFormat::svg)
        .write(path);
    pugi::xml_document svg;
    REQUIRE(svg.load_file(path.c_str()).status == pugi::status_ok);
    std::string axes;
    for (const auto& found : svg.select_nodes("//text")) {
      const std::string text = found.node().text().as_string();
      if (text.size() > unit.size() && text.substr(1) == unit) axes += text[0];
    }
    CHECK(axes == (space == Space::axisymmetric ? "rz" : "xy"));
  }
}

TEST_CASE("a few outliers do not stretch the colour range, and a constant field has one") {
  std::vector<double> values(1001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  values[0] = -1e30;
  values[1000] = std::numeric_limits<double>::quiet_NaN();
  const Range range = robust_range(values);
  CHECK(range.lower == doctest::Approx(10));
  CHECK(range.upper == doctest::Approx(989));
  const ColourScale constant(robust_range(std::vector<double>(10, 3.0)));
  CHECK(constant.has_one_value());
  CHECK(constant.range().lower < 3);
  CHECK(constant.range().upper > 3);
  CHECK_FALSE(ColourScale(range).has_one_value());
  std::vector<double> nearly(1000, 3.0);
  nearly[5] = 4;
  CHECK(robust_range(nearly).upper == 4);
  CHECK(robust_range({}).width() > 0);
}

TEST_CASE(
    "a field of both signs has a range symmetric about zero; a trace of the other sign does not count") {
  CHECK(ColourScale({-2, 5}).range().lower == -5);
  CHECK(ColourScale({-7, 5}).range().upper == 7);
  CHECK(ColourScale({-0.1, 5}).range().lower == -0.1);
  CHECK(ColourScale({1, 5}).range().lower == 1);
}

TEST_CASE("lengths have one unit in all pictures of a run, that of the grid") {
  Scene scene = small_scene(Space::plane_strain);
  scene.grid.size = {2e-3, 1e-3, 0};
  CHECK(length_unit(scene).name == "mm");
  scene.grid.size = {1e-3, 1e-3, 0};
  CHECK(length_unit(scene).name == "µm");
}

TEST_CASE("where a field has one value, the picture says it and has no bar") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.png";
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = lattice(10);
  draw_particles(path, particles, scene, "stress_xx", 0);
  const int with_bar = Png(path).width;
  for (std::size_t p = 0; p < particles.size(); ++p) particles.column(Quantity::kirchhoff_stress, 0)[p] = 5e6;
  draw_particles(path, particles, scene, "stress_xx", 0);
  CHECK(Png(path).width < with_bar);
}

TEST_CASE("what the colours do not reach has a line of its own in a narrow picture") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.png";
  const auto ink = [&](const Png& png, int y, int from, int to) {  // in the line of text at y
    int found = 0;
    for (int row = y - 8; row < y + 8; ++row)
      for (int x = from; x < std::min(to, png.width); ++x)
        found += png.at(x, row) == std::array<int, 3>{30, 30, 30} ? 1 : 0;
    return found;
  };
  Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = lattice(20);
  const auto draw = [&](double height) {
    scene.grid.size[1] *= height;  // pictures show what lies in the grid
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.column(Quantity::position, 1)[p] *= height;
      particles.column(Quantity::deformation_gradient, 3)[p] = height;
      particles.column(Quantity::kirchhoff_stress, 0)[p] = p == 0   ? -1.285e9
                                                           : p == 1 ? 2.801e8
                                                                    : 1e6 * double(p);
    }
    draw_particles(path, particles, scene, "stress_xx", 20.8e-3);
    return Png(path);
  };
  const Png wide = draw(1);
  CHECK(ink(wide, 44, 400, 700) > 50);
  CHECK(ink(wide, 68, 200, 700) == 0);
  const Png narrow = draw(8);
  CHECK(narrow.width < 600);
  CHECK(ink(narrow, 44, narrow.width - 14, narrow.width) == 0);
  CHECK(ink(narrow, 68, 200, 400) > 50);
}

TEST_CASE("a title tells the values that the colours do not reach") {
  const FieldValues field{{-3e6, 0, 5e6, std::numeric_limits<double>::quiet_NaN()}, "pressure", "Pa"};
  CHECK(beyond_text(field, {-3e6, 5e6}).empty());
  CHECK(beyond_text(field, {-3e6, 4e6}) == "values up to 5 MPa");
  CHECK(beyond_text(field, {-1e6, 9e6}) == "values down to -3 MPa");
  CHECK(beyond_text(field, {0, 1}) == "values from -3 MPa to 5 MPa");
  CHECK(beyond_text(FieldValues{}, {0, 1}).empty());
}

TEST_CASE("an axis has two ticks at least, or it has no scale") {
  for (const Range range : {Range{0.15, 1.9}, Range{0.4, 1.3}, Range{-0.9, 0.9}, Range{1.01e-3, 1.99e-3}})
    for (const int wanted : {1, 2, 3}) CHECK(round_ticks(range, wanted).size() >= 2);
}

TEST_CASE("what is written beside a picture is whole") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "x.png";
  Scene scene = small_scene(Space::plane_strain);
  scene.grid.size = {2e-3, 2e-3, 0};  // "y (mm)" is wider than the numbers
  draw_particles(path, lattice(10), scene, "stress_xx", 0);
  const Png png(path);
  for (int y = 0; y < png.height; ++y)
    for (const int x : {0, 1, 2, png.width - 1}) CHECK(png.at(x, y) == std::array<int, 3>{255, 255, 255});
}

TEST_CASE("stresses that are round-off of the modulus are zero") {
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = lattice(4);
  double* stress = particles.column(Quantity::kirchhoff_stress, 0);
  for (std::size_t p = 0; p < particles.size(); ++p) stress[p] = p == 0 ? 1e3 : 1e-9 * double(p);
  const std::vector<double> values = field_values(particles, scene, "stress_xx").value;
  CHECK(values[0] == 1e3);
  CHECK(values[1] == 0);
  CHECK(values[13] == 0);
}

TEST_CASE("a compression is no round-off: of either sign a stress is what it was") {
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = lattice(2);
  const std::array<double, 4> stresses{1e3, -1e3, 1e-9, -1e-9};  // Pa, of a modulus of 1 MPa
  std::copy(stresses.begin(), stresses.end(), particles.column(Quantity::kirchhoff_stress, 0));
  CHECK(field_values(particles, scene, "stress_xx").value == std::vector<double>{1e3, -1e3, 0, 0});
  CHECK(field_values(particles, scene, "pressure").value[0] ==
        -field_values(particles, scene, "pressure").value[1]);
}

TEST_CASE("ticks are round and units of a sensible size") {
  const auto ticks = round_ticks({-0.03, 1.02}, 5);
  REQUIRE(ticks.size() == 6);
  CHECK(ticks.front() == 0);
  CHECK(ticks.back() == doctest::Approx(1));
  CHECK(tick_label(0.6000000000000001, 0.2) == "0.6");
  CHECK(tick_label(-1e-17, 0.2) == "0");
  CHECK(tick_label(100, 20) == "100");
  CHECK(display_unit(1.05e11, "Pa").name == "GPa");
  CHECK(display_unit(2e-3, "m").name == "mm");
  CHECK(display_unit(1.5e-5, "s").name == "µs");
  CHECK(display_unit(3000, "s").name == "s");
  CHECK(display_unit(0, "Pa").name == "Pa");
}
