#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/output_fixture.hpp"
#include "tools/report/frame_fields.hpp"
#include "tools/report/frame_survey.hpp"
#include "tools/report/frames.hpp"

using namespace output_test;

namespace {

constexpr std::size_t kParticles = 400;

/// Eight frames of particles that have random values.
void write_frames(const std::filesystem::path& folder, const Scene& scene) {
  ParticleSeries<2> series(folder, scene);
  for (int frame = 0; frame < 8; ++frame) {
    Particles<2> particles = particles_in_order<2>(shuffled(kParticles));
    for (std::size_t p = 0; p < kParticles; ++p) particles.column(Quantity::position, 0)[p] += 0.1 * frame;
    series.append(particles, 1e-3 * frame);
  }
}

struct PackedRun {
  nlohmann::ordered_json json;
  Chunks chunks;
  std::vector<std::string> notices;
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const std::string& chunk : chunks.all()) sum += chunk.size();
    return sum;
  }
  bool says(const std::string& text) const {
    for (const std::string& notice : notices)
      if (notice.find(text) != std::string::npos) return true;
    return false;
  }
  bool has(const std::string& field) const {
    for (const auto& described : json["fields"])
      if (described["name"] == field) return true;
    return false;
  }
};

PackedRun pack(const std::filesystem::path& folder, const Scene& scene, FrameLimits limits) {
  PackedRun run;
  run.json = pack_frames(folder, scene, 2, limits, run.chunks, run.notices);
  return run;
}

}  // namespace

TEST_CASE("a page holds all frames and fields of a run that fits") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  write_frames(folder.path(), scene);
  const PackedRun run = pack(folder.path(), scene, {10'000'000});
  CHECK(run.notices.empty());
  CHECK(run.json["count"] == kParticles);
  CHECK(run.json["times"].size() == 8);
  CHECK(run.json["times"][7] == 7e-3);
  CHECK(run.json["gradient"].size() == 4);
  CHECK(run.json["places"].size() == 2);
  CHECK(run.json["fields"][0]["name"] == "pressure");
  for (const char* field : {"von_mises", "speed", "velocity_x", "velocity_y", "stress_xx", "stress_zz",
                            "stress_xy", "volume_ratio"})
    CHECK_MESSAGE(run.has(field), field);
  CHECK_FALSE(run.has("velocity_z"));
  CHECK_FALSE(run.json.contains("ids"));
}

TEST_CASE("a page has the cracks of each frame, without points that change nothing that is seen") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  const Particles<2> particles = particles_in_order<2>(shuffled(kParticles));
  ParticleSeries<2> series(folder.path(), scene);
  const double x = particles.column(Quantity::position, 0)[0], y = particles.column(Quantity::position, 1)[0];
  const Vec<2> from(x, y), corner(x + 0.3, y + 1e-9), to(x + 0.3, y + 0.4);
  series.append(particles, 0,
                {{from, from + 0.5 * (corner - from), corner, corner + 0.2 * (to - corner), to}});
  series.append(particles, 1);
  const PackedRun run = pack(folder.path(), scene, {10'000'000});
  REQUIRE(run.json["lines"].size() == 2);
  CHECK(run.json["lines"][1].empty());
  const auto& line = run.json["lines"][0][0];
  REQUIRE(line.size() == 6);  // from, corner, to
  const auto place = [&](std::size_t point, std::size_t axis) {
    const auto& column = run.json["places"][axis];
    return column["lower"].get<double>() +
           column["spacing"].get<double>() * line[2 * point + axis].get<double>();
  };
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double half_step = 0.5 * run.json["places"][axis]["spacing"].get<double>();
    CHECK(std::abs(place(0, axis) - from[static_cast<int>(axis)]) <= 1.001 * half_step);
    CHECK(std::abs(place(1, axis) - corner[static_cast<int>(axis)]) <= 1.001 * half_step);
    CHECK(std::abs(place(2, axis) - to[static_cast<int>(axis)]) <= 1.001 * half_step);
  }
}

TEST_CASE("a particle that was thrown out of the grid takes no space on a page, and has no place") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles = particles_in_order<2>(ascending(kParticles));
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles, 0);
  particles.column(Quantity::position, 0)[3] = 1e9;
  series.append(particles, 1);
  const PackedRun run = pack(folder.path(), scene, {10'000'000});
  CHECK(run.json["places"][0]["spacing"].get<double>() < 1e-4);
  CHECK(run.json["largest"] == doctest::Approx(largest_half_diagonal(scene)));
  CHECK(run.json["follows_shape"] == false);
  const VtuReader file(folder.path() / "particles/000001.vtu");
  const std::vector<double> points = shown_points(file, Viewed(scene));
  const auto id = file.read<std::uint32_t>("id");
  for (std::size_t i = 0; i < id.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) CHECK(std::isnan(points[3 * i + d]) == (id[i] == 3));
  // Without a scene nobody knows the grid.
  Chunks chunks;
  std::vector<std::string> notices;
  const auto json = pack_frames(folder.path(), std::nullopt, 2, {10'000'000}, chunks, notices);
  CHECK(json["places"][0]["spacing"].get<double>() > 1);
  CHECK_FALSE(json.contains("largest"));
}

TEST_CASE("rigid bodies have a speed on a page, and no stress") {
  const TemporaryFolder folder;
  write_frames(folder.path(), small_scene(Space::plane_strain));
  const FrameFile file(folder.path() / "particles/000000.vtu");
  for (const FrameField& field : frame_fields(file.reader(), 2, "pressure", {2})) {
    CAPTURE(field.name);
    const std::vector<double> values = field.values(file);
    for (std::size_t i = 0; i < 9; ++i)
      CHECK(std::isnan(values[i]) == (i % 3 == 2 && field.array != "velocity"));
  }
}

TEST_CASE("a page that would be too large leaves out fields, then shapes, then frames, and says so") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  write_frames(folder.path(), scene);
  const std::size_t all = pack(folder.path(), scene, {10'000'000}).bytes();
  const PackedRun most = pack(folder.path(), scene, {all * 3 / 4});
  CHECK(most.bytes() <= all * 3 / 4);
  CHECK(most.json["times"].size() == 8);
  CHECK(most.has("pressure"));
  CHECK(most.says("Left out to keep this page small: "));
  CHECK(most.says("The particle files hold them."));
  const PackedRun some = pack(folder.path(), scene, {all * 2 / 5});
  CHECK(some.bytes() <= all * 2 / 5);
  CHECK(some.json["times"].size() < 8);
  CHECK(some.json["times"].back() == 7e-3);  // the last one always
  CHECK(some.says("of 8 frames are shown"));
  CHECK_FALSE(some.json.contains("gradient"));
  CHECK(some.says("drawn as squares"));
}

TEST_CASE("a page of more particles than it may hold shows every so many") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  write_frames(folder.path(), scene);
  const PackedRun run = pack(folder.path(), scene, {10'000'000, 500});
  CHECK(run.json["count"] == kParticles / 2);
  CHECK(run.json.contains("ids"));
  CHECK(run.says("One of 2 particles is shown"));
}

TEST_CASE("a frame that was cut is left out by its name; without any there is no view") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  write_frames(folder.path(), scene);
  std::filesystem::resize_file(folder.path() / "particles/000003.vtu", 1000);
  const PackedRun run = pack(folder.path(), scene, {10'000'000});
  CHECK(run.json["times"].size() == 7);
  CHECK(run.says("000003.vtu"));
  const PackedRun thinned = pack(folder.path(), scene, {10'000'000, 1600});  // the frames 0, 3, 6 and 7
  CHECK(thinned.json["times"].size() == 3);
  CHECK(thinned.says("3 of 8 frames are shown"));
  const TemporaryFolder empty;
  const PackedRun none = pack(empty.path(), scene, {10'000'000});
  CHECK(none.json.is_null());
  CHECK(none.says("There are no particle files"));
}
