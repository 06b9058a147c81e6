// Pictures of a run that is over: frames read back, what they share, and animations.

#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <stdexcept>

#include "engine/errors.hpp"
#include "engine/output/animated_png.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/read_frame.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

/// Are all columns of a the same in b, to the precision of the files?
template <int Dim>
void check_same(const Particles<Dim>& a, const Particles<Dim>& b) {
  REQUIRE(a.size() == b.size());
  for (const Quantity quantity : a.quantities()) {
    REQUIRE(b.has(quantity));
    for (int k = 0; k < Particles<Dim>::components(quantity); ++k) {
      double worst = 0, size = 0;
      for (std::size_t p = 0; p < a.size(); ++p) {
        worst = std::max(worst, std::abs(a.column(quantity, k)[p] - b.column(quantity, k)[p]));
        size = std::max(size, std::abs(a.column(quantity, k)[p]));
      }
      CHECK(worst <= 2e-7 * size);
    }
  }
}

template <int Dim>
void check_round_trip(Space space, std::vector<Quantity> beside) {
  const TemporaryFolder folder;
  const Scene scene = small_scene(space);
  const Particles<Dim> first = particles_in_order<Dim>(shuffled(50));
  Particles<Dim> written;
  std::vector<Quantity> columns = first.quantities();
  std::erase(columns, Quantity::mass);  // which files do not hold
  columns.insert(columns.end(), beside.begin(), beside.end());
  written.allocate(first.size(), columns);
  for (std::size_t p = 0; p < first.size(); ++p) {
    written.id()[p] = static_cast<std::uint32_t>(p);
    written.body()[p] = first.body()[p];
    for (const Quantity quantity : columns)
      for (int k = 0; k < Particles<Dim>::components(quantity); ++k)
        written.column(quantity, k)[p] =
            first.has(quantity) ? first.column(quantity, k)[p] : 0.7 + 0.01 * static_cast<double>(p);
  }
  ParticleSeries<Dim> series(folder.path(), scene);
  series.append(written, 1e-6);
  const auto path = folder.path() / "particles/000000.vtu";
  const Particles<Dim> read = read_frame<Dim>(VtuReader(path), path, scene);
  check_same(written, read);
  for (std::size_t p = 0; p < read.size(); ++p) {
    CHECK(read.id()[p] == p);
    CHECK(read.body()[p] == written.body()[p]);
  }
  for (const std::string& field : field_names(Dim)) {
    const FieldValues before = field_values(written, scene, field), after = field_values(read, scene, field);
    double size = 0;
    for (const double v : before.value) size = std::max(size, std::isnan(v) ? 0 : std::abs(v));
    for (std::size_t p = 0; p < read.size(); ++p) {
      CHECK(std::isnan(before.value[p]) == std::isnan(after.value[p]));
      if (!std::isnan(before.value[p])) CHECK(std::abs(before.value[p] - after.value[p]) <= 1e-6 * size);
    }
  }
}

struct Chunk {
  std::string name, content;
};

std::uint32_t number(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// As a viewer takes a PNG apart; every check sum must hold.
std::vector<Chunk> chunks_of(const std::string& file) {
  REQUIRE(file.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at < file.size();) {
    const std::size_t length = number(file, at, 4);
    REQUIRE(at + 12 + length <= file.size());
    const std::string named = file.substr(at + 4, 4 + length);
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()));
    CHECK(number(file, at + 8 + length, 4) == sum);
    chunks.push_back({named.substr(0, 4), named.substr(4)});
    at += 12 + length;
  }
  return chunks;
}

/// Puts a frame's pixels where its control says.
void apply(const std::string& control, const std::string& data, int width,
           std::vector<std::uint8_t>& pixels) {
  const std::uint32_t w = number(control, 4, 4), h = number(control, 8, 4), x = number(control, 12, 4),
                      y = number(control, 16, 4);
  std::vector<unsigned char> rows((3 * w + 1) * h);
  uLongf size = rows.size();
  REQUIRE(uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(data.data()), data.size()) == Z_OK);
  REQUIRE(size == rows.size());
  for (std::uint32_t j = 0; j < h; ++j) {
    const unsigned char* row = &rows[(3 * w + 1) * j];
    REQUIRE(row[0] == 1);  // differences to the left
    for (std::uint32_t i = 0; i < 3 * w; ++i) {
      const std::size_t at = 3 * (static_cast<std::size_t>(width) * (y + j) + x) + i;
      pixels[at] = static_cast<std::uint8_t>(row[1 + i] + (i < 3 ? 0 : pixels[at - 3]));
    }
  }
}

}  // namespace

TEST_CASE("particles read back from a frame are those that were written") {
  check_round_trip<2>(Space::plane_strain, {Quantity::plastic_strain, Quantity::temperature});
  check_round_trip<2>(Space::plane_stress, {Quantity::out_of_plane_stretch});
  check_round_trip<3>(Space::three_dimensional, {Quantity::internal_energy, Quantity::dissipated_energy});
}

TEST_CASE("the cracks of a frame are read back as they were written, and none where there are none") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  const Polylines lines{{Vec<2>(0.1, 1.0 / 3), Vec<2>(2, -1e-30), Vec<2>(0, 4)},
                        {Vec<2>(5, 6), Vec<2>(7, 8)}};
  series.append(particles_in_order<2>(ascending(9)), 0, lines);
  series.append(particles_in_order<2>(ascending(9)), 1);
  const auto first = folder.path() / "particles/000000.vtu", second = folder.path() / "particles/000001.vtu";
  CHECK(read_lines(VtuReader(first), first) == lines);
  CHECK(read_lines(VtuReader(second), second).empty());
  CHECK(VtuReader(first).size() == 9);
  CHECK(VtuReader(first).time() == 0);

  VtuFile file(std::vector<double>{0, 0, 0});  // a line of more points than there are
  file.add_field_data(kLinePoints, std::vector<double>{1, 2, 0}, 3);
  file.add_field_data(kLineLengths, std::vector<std::uint32_t>{2});
  file.add_field_data("empty", std::vector<double>{});
  file.write(first, 0);
  CHECK_THROWS_AS(read_lines(VtuReader(first), first), FileError);
  CHECK(VtuReader(first).read_of_file<double>("empty").empty());
  file = VtuFile(std::vector<double>{0, 0, 0});
  file.add_field_data(kLinePoints, std::vector<double>{1, 2, 0}, 3);
  file.add_field_data(kLineLengths, std::vector<std::uint32_t>{0});
  file.add_field_data("Points", std::vector<double>{1, 2, 3, 4, 5, 6}, 3);  // of the file: no point moves
  file.write(first, 0);
  CHECK_THROWS_AS(read_lines(VtuReader(first), first), FileError);
  CHECK(VtuReader(first).points() == std::vector<double>{0, 0, 0});
  file = VtuFile(std::vector<double>{0, 0, 0});
  file.add_field_data(kLinePoints, std::vector<double>{1, std::nan(""), 0}, 3);
  file.add_field_data(kLineLengths, std::vector<std::uint32_t>{1});
  file.write(first, 0);
  CHECK_THROWS_AS(read_lines(VtuReader(first), first), FileError);
}

TEST_CASE("a frame of another scene is refused") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>(ascending(9)), 0);
  scene.bodies.pop_back();
  const auto path = folder.path() / "particles/000000.vtu";
  CHECK_THROWS_AS(read_frame<2>(VtuReader(path), path, scene), FileError);
}

TEST_CASE("a framing holds what each of its frames shows") {
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = particles_in_order<2>(ascending(30));
  Framing both = framing_of(particles, scene, "pressure");
  const Framing first = both;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    particles.column(Quantity::position, 0)[p] += 5;
    particles.column(Quantity::kirchhoff_stress, 0)[p] -= 1e8;
  }
  const Framing second = framing_of(particles, scene, "pressure");
  both.include(second);
  CHECK(both.box[0]->lower == first.box[0]->lower);
  CHECK(both.box[0]->upper == second.box[0]->upper);
  CHECK(both.box[1]->upper == first.box[1]->upper);
  CHECK(both.values->lower == first.values->lower);
  CHECK(both.values->upper == second.values->upper);
  CHECK_FALSE(framing_of(particles, scene, "body").values);
  // Frames of one framing have one size.
  const Canvas canvas = paint_particles(particles, scene, "pressure", 0, both);
  const Canvas other = paint_particles(particles_in_order<2>(ascending(3)), scene, "pressure", 1, both);
  CHECK(canvas.width() == other.width());
  CHECK(canvas.height() == other.height());
  CHECK_THROWS_AS(framing_of(particles, scene, "colour"), std::invalid_argument);
}

TEST_CASE("a particle's picture has the sides of its share of a cell") {
  Scene scene = small_scene(Space::plane_strain);
  scene.bodies[0].particles_per_cell = {1, 4, 1};
  Particles<2> one = particles_in_order<2>({0});
  for (int k = 0; k < 4; ++k) one.column(Quantity::deformation_gradient, k)[0] = k % 3 == 0;
  one.column(Quantity::initial_volume)[0] = 0.1 * 0.1 / 4;
  const Framing framing = framing_of(one, scene, "body");
  CHECK(framing.box[0]->width() == doctest::Approx(0.1));
  CHECK(framing.box[1]->width() == doctest::Approx(0.025));
}

TEST_CASE("the stress difference in the plane is that of the principal stresses there") {
  CauchyStress stress;
  stress.component = {3, -1, 7, 0, 5, 6};
  CHECK(stress.difference_in_plane() == doctest::Approx(4));
  stress.component = {1, 1, 0, 2, 0, 0};  // 3 and -1
  CHECK(stress.difference_in_plane() == doctest::Approx(4));
  const double angle = 0.3, turned = 2 * angle;  // the first, turned
  stress.component = {1 + 2 * std::cos(turned), 1 - 2 * std::cos(turned), 0, 2 * std::sin(turned), 0, 0};
  CHECK(stress.difference_in_plane() == doctest::Approx(4));
}

TEST_CASE("von Mises' stress is √3 times a pure shear in any plane, and the same along any axes") {
  for (std::size_t k = 3; k < 6; ++k) {
    CauchyStress shear;
    shear.component[k] = -2;
    CHECK(shear.von_mises() == doctest::Approx(2 * std::sqrt(3.0)));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    CauchyStress tension;
    tension.component[k] = 5;
    CHECK(tension.von_mises() == doctest::Approx(5));
  }
  CauchyStress one, other;  // x, y, z and z, x, y
  one.component = {3, -1, 7, 0.5, 5, 6};
  other.component = {7, 3, -1, 6, 0.5, 5};
  CHECK(one.von_mises() == doctest::Approx(other.von_mises()));
}

TEST_CASE("an animation read as a viewer does shows the pictures that went in") {
  const TemporaryFolder folder;
  constexpr int kWidth = 7, kHeight = 5;
  std::vector<std::vector<std::uint8_t>> pictures(4, std::vector<std::uint8_t>(3 * kWidth * kHeight, 250));
  for (std::size_t i = 0; i < pictures[0].size(); ++i) pictures[0][i] = static_cast<std::uint8_t>(37 * i);
  pictures[1] = pictures[0];
  pictures[1][3 * (kWidth * 2 + 3) + 1] ^= 0x55;  // one pixel
  pictures[2] = pictures[1];                      // a still
  AnimatedPng animation(kWidth, kHeight, 8);
  for (const auto& picture : pictures) animation.add(picture);
  animation.write(folder.path() / "a.png");

  const std::vector<Chunk> chunks = chunks_of(read_text(folder.path() / "a.png"));
  CHECK(chunks[0].name == "IHDR");
  CHECK(number(chunks[0].content, 0, 4) == kWidth);
  CHECK(number(chunks[0].content, 4, 4) == kHeight);
  CHECK(chunks[1].name == "acTL");
  CHECK(number(chunks[1].content, 0, 4) == 4);
  CHECK(chunks.back().name == "IEND");
  std::vector<std::uint8_t> pixels(pictures[0].size());
  std::uint32_t sequence = 0;
  std::size_t shown = 0;
  for (std::size_t k = 2; k + 1 < chunks.size(); k += 2) {
    const std::string& control = chunks[k].content;
    CHECK(chunks[k].name == "fcTL");
    CHECK(number(control, 0, 4) == sequence++);
    CHECK(number(control, 20, 2) * 8 == number(control, 22, 2));  // an eighth of a second
    std::string data = chunks[k + 1].content;
    if (shown == 0) {
      CHECK(chunks[k + 1].name == "IDAT");
    } else {
      CHECK(chunks[k + 1].name == "fdAT");
      CHECK(number(data, 0, 4) == sequence++);
      data = data.substr(4);
    }
    apply(control, data, kWidth, pixels);
    CHECK(pixels == pictures[shown++]);
  }
  CHECK(shown == 4);
  CHECK(number(chunks[4].content, 4, 4) == 1);  // of the second frame one pixel
}
