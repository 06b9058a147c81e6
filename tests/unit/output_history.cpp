#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "engine/errors.hpp"
#include "tests/unit/output_fixture.hpp"
#include "tests/unit/scene_helpers.hpp"

using namespace output_test;

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool same_bits(const HistoryRow& a, const HistoryRow& b) {
  const auto equal = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof(x)) == 0; };
  bool same =
      equal(a.kinetic, b.kinetic) && equal(a.momentum, b.momentum) && equal(a.mean_stress, b.mean_stress);
  for (std::size_t k = 0; k < a.bodies.size(); ++k) same = same && equal(a.bodies[k], b.bodies[k]);
  return same;
}

}  // namespace

TEST_CASE(
    "no two columns of a history have one name, whatever bodies, walls, pairs and materials are called") {
  const std::string head =
      "space: plane_strain\ngrid: {size: [30 mm, 20 mm], cell: 1 mm, leaving: wall}\ntime: {end: 1 ms}\n"
      "materials:\n  a: {model: linear_elastic, density: 1 g/cm^3, young: 1 GPa, poisson: 0.3}\n"
      "  b: {model: linear_elastic, density: 1 g/cm^3, young: 1 GPa, poisson: 0.3}\n  all: {model: rigid}\n"
      "bodies:\n  - {name: a, box: {from: [1 mm, 1 mm], to: [4 mm, 4 mm]}, material: a}\n"
      "  - {name: b, box: {from: [6 mm, 1 mm], to: [9 mm, 4 mm]}, material: b}\n"
      "  - {name: c, box: {from: [11 mm, 1 mm], to: [14 mm, 4 mm]}, material: all}\n"
      "contact:\n  pairs:\n    - {between: [a, b], friction: 0.1}\n";
  const Scene scene = test::parse(head + "    - {materials: [b, a], friction: 0.2}\n");
  std::vector<std::string> names = history_columns(scene);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  CHECK(test::fault(head + "    - {materials: [a, b], friction: 0.2}\n").find("both called 'a+b'") !=
        std::string::npos);
}

TEST_CASE("history columns come in the order that the output contract states") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.contact.pairs.push_back({false, {2, 0}, {}});
  HistoryFile file(folder.path(), scene);
  HistoryRow row;
  row.step = 7;
  row.time = 1e-6;
  row.momentum = {1, 2, 0};
  row.bodies.resize(3);
  row.bodies[0].mass = 0.125;
  row.boundary_force = {{10, 20, 0}};
  row.rigid_force = {{}, {}, {30, 40, 0}};
  row.rigid_moment = {{}, {}, {0, 0, 50}};
  row.pair_force = {{60, 70, 0}};
  row.pair_friction = {80};
  row.body_force_work = 5;
  row.mean_stress = {6, 7, 8, 9, 0, 0};
  row.dissipated = 11;
  file.append(row);

  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 2);
  const std::string body =
      ",@.mean_stress_xx_Pa,@.mean_stress_yy_Pa,@.mean_stress_zz_Pa,@.mean_stress_xy_Pa,@.mass_kg,@.x_m,@.y_"
      "m,@.vx,@.vy";
  std::string expected =
      "step,time_s,dt_s,kinetic_J,stored_J,friction_J,boundary_work_J,momentum_x,momentum_y,momentum_z";
  for (const std::string name : {"left", "right", "punch"})
    for (const char c : body) expected += c == '@' ? name : std::string(1, c);
  expected += ",floor.force_x_N,floor.force_y_N,punch.force_x_N,punch.force_y_N,body_force_work_J";
  expected += ",all.mean_stress_xx_Pa,all.mean_stress_yy_Pa,all.mean_stress_zz_Pa,all.mean_stress_xy_Pa";
  expected += ",punch.moment_z_Nm,punch+left.force_x_N,punch+left.force_y_N,punch+left.friction_J";
  expected += ",dissipated_J";
  CHECK(lines[0] == expected);

  const auto names = split(lines[0]), cells = split(lines[1]);
  REQUIRE(names.size() == cells.size());
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return cells[i];
    return std::string("missing");
  };
  CHECK(value("step") == "7");
  CHECK(value("time_s") == "1e-06");
  CHECK(value("momentum_z") == "0");
  CHECK(value("left.mass_kg") == "0.125");
  CHECK(value("floor.force_y_N") == "20");
  CHECK(value("punch.force_x_N") == "30");
  CHECK(value("body_force_work_J") == "5");
  CHECK(value("punch.moment_z_Nm") == "50");
  CHECK(value("punch+left.force_y_N") == "70");
  CHECK(value("punch+left.friction_J") == "80");
  CHECK(value("all.mean_stress_xy_Pa") == "9");
  CHECK(value("dissipated_J") == "11");
}

TEST_CASE("history has six stresses and three force components in 3-D") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::three_dimensional);
  HistoryFile file(folder.path(), scene);
  file.append({});
  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].find("left.mean_stress_xy_Pa,left.mean_stress_yz_Pa,left.mean_stress_xz_Pa,left.mass_kg") !=
        std::string::npos);
  CHECK(lines[0].find("left.z_m,left.vx,left.vy,left.vz") != std::string::npos);
  CHECK(split(lines[0]).size() == 10 + 3 * 13 + 3 + 3 + 1 + 6 + 3 + 1);
  CHECK(split(lines[1]).size() == split(lines[0]).size());
}

TEST_CASE("the overlap ends a row of the history where the scene asks for it") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.output.overlap = true;
  HistoryFile file(folder.path(), scene);
  HistoryRow row;
  row.dissipated = 3;
  row.overlap = Overlap{0.25, 0.5, 7};
  file.append(row);
  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].ends_with(",dissipated_J,overlap_m2,inside_m2"));
  CHECK(lines[1].ends_with(",3,0.25,0.5"));
}

TEST_CASE("what left the grid ends a row of the history where the scene lets it leave") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.grid.outflow = OutflowKind::outflow;
  HistoryFile file(folder.path(), scene);
  HistoryRow row;
  row.dissipated = 3;
  row.outflow = Outflow{7, 0.25, 0.5, {1, 2, 0}};
  file.append(row);
  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].ends_with(",dissipated_J,outflow_kg,outflow_J,outflow_momentum_x,outflow_momentum_y"));
  CHECK(lines[1].ends_with(",3,0.25,0.5,1,2"));
}

TEST_CASE("what bonds lost and hold ends a row of the history where surfaces have some") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.contact.law.acts = Cohesive{};
  HistoryFile file(folder.path(), scene);
  HistoryRow row;
  row.dissipated = 3, row.interface = 7, row.joints = 9;
  file.append(row);
  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].ends_with(",dissipated_J,interface_J,interface_stored_J"));
  CHECK(lines[1].ends_with(",3,7,9"));
}

TEST_CASE("a piston's strain is what it moved towards the wall that it faces, by their first distance") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.grid.origin = {0, -1, 0};
  scene.grid.size = {4, 5, 0};
  scene.boundaries = {{"left", WallSpec{0, false, 0, {{0}, {0}}, false}},
                      {"right", WallSpec{0, true, 4, {{0, 2}, {0, -1}}, false}},
                      {"bottom", WallSpec{1, false, -1, {{0}, {0.5}}, false}},
                      {"top", WallSpec{1, true, 3, {{0}, {-1}}, false}}};
  const std::vector<std::string> names = history_columns(scene);
  HistoryRow row;
  row.time = 2;
  const std::vector<double> numbers = history_numbers(row, scene);
  REQUIRE(names.size() == numbers.size());
  const auto at = [&](const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    REQUIRE(found != names.end());
    return numbers[static_cast<std::size_t>(found - names.begin())];
  };
  CHECK(at("right.strain") == doctest::Approx(-0.25));  // a ramp from rest to -1 m/s in 2 s: 1 m of 4
  CHECK(at("top.strain") == doctest::Approx(-0.75));    // 2 m, and the bottom comes up by 1 m: 3 m of 4
  CHECK(at("bottom.strain") == doctest::Approx(-0.75));
  CHECK(std::find(names.begin(), names.end(), "left.strain") == names.end());
  scene.boundaries = {{"right", WallSpec{0, true, 4, {{0}, {1}}, false}}};
  CHECK(history_numbers(row, scene).back() == doctest::Approx(0.5));  // pulled away from the grid's own face
}

TEST_CASE("a body's name with a comma or a quote stays one cell of history.csv") {
  const TemporaryFolder folder;
  Scene scene = small_scene(Space::plane_strain);
  scene.bodies[0].name = "a \"hard\", old\nnut";
  HistoryFile file(folder.path(), scene);
  const auto lines = lines_of(read_text(folder.path() / "history.csv"));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].find(",\"a \"\"hard\"\", old nut.mass_kg\",") != std::string::npos);
}

TEST_CASE("a history that cannot be written is a file error that names the file") {
  const Scene scene = small_scene(Space::plane_strain);
  CHECK_THROWS_WITH_AS(HistoryFile("/nonexistent-folder", scene),
                       doctest::Contains("/nonexistent-folder/history.csv"), FileError);
}

TEST_CASE_TEMPLATE("sums over particles do not depend on their order", D, std::integral_constant<int, 2>,
                   std::integral_constant<int, 3>) {
  constexpr int Dim = D::value;
  const Scene scene = small_scene(Dim == 2 ? Space::plane_strain : Space::three_dimensional);
  HistoryRow one, other;
  fill_particle_sums(particles_in_order<Dim>(ascending(999)), scene, one);
  fill_particle_sums(particles_in_order<Dim>(shuffled(999)), scene, other);
  CHECK(same_bits(one, other));
}

TEST_CASE("sums over two particles are what the hand gives") {
  const Scene scene = small_scene(Space::plane_strain);
  Particles<2> particles;
  particles.allocate(3, {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                         Quantity::kirchhoff_stress, Quantity::mass, Quantity::initial_volume});
  for (std::uint32_t p = 0; p < 3; ++p) {
    particles.id()[p] = 10 * p + 4;  // ids with gaps
    particles.body()[p] = p < 2 ? 0 : 2;
    particles.column(Quantity::mass)[p] = p + 1.0;
    particles.column(Quantity::initial_volume)[p] = 1;
    particles.column(Quantity::position, 0)[p] = p;
    particles.column(Quantity::velocity, 1)[p] = 2;
    particles.column(Quantity::deformation_gradient, 0)[p] = p == 0 ? 3 : 1;
    particles.column(Quantity::deformation_gradient, 3)[p] = 1;
    particles.column(Quantity::kirchhoff_stress, 1)[p] = p == 0 ? -10 : -30;
  }
  HistoryRow row;
  fill_particle_sums(particles, scene, row);
  CHECK(row.kinetic == doctest::Approx(0.5 * 3 * 4));  // the rigid third particle has no share
  CHECK(row.momentum[1] == doctest::Approx(6));
  CHECK(row.bodies[0].mass == doctest::Approx(3));
  CHECK(row.bodies[0].position[0] == doctest::Approx(2.0 / 3));
  CHECK(row.bodies[0].velocity[1] == doctest::Approx(2));
  CHECK(row.bodies[0].mean_stress[1] == doctest::Approx(-40.0 / 4));  // (−10 − 30) over J V₀ = 3 + 1
  CHECK(row.mean_stress[1] == doctest::Approx(-10));
  CHECK(row.bodies[1].mass == 0);
  CHECK(row.bodies[1].position[0] == 0);
  CHECK(row.bodies[2].velocity[1] == doctest::Approx(2));
  CHECK(row.bodies[2].mean_stress[1] == 0);
}
