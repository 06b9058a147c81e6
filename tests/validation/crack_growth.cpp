// Cracks that waves meet, that grow, and part bodies.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A short double cantilever beam that is pulled open slowly.
std::string short_beam(const std::string& growth) {
  return R"(
space: plane_strain
grid: {size: [22 mm, 12.5 mm], cell: 0.5 mm}
time: {end: 0.35 ms, cfl: 0.5}
materials: {polymer: {model: linear_elastic, density: 1.2 g/cm^3, young: 3 GPa, poisson: 0.3}}
bodies: [{name: beam, box: {from: [0.5 mm, 3.25 mm], to: [20.5 mm, 9.25 mm]}, material: polymer}]
cracks: [{name: slit, body: beam, line: [[0 mm, 6.25 mm], [8 mm, 6.25 mm]], growth: )" +
         growth + R"(}]
boundaries:
  up: {box: {from: [0.95 mm, 6.7 mm], to: [1.05 mm, 12.5 mm]}, direction: +y, speed: [[0 ms, 0 m/s], [0.1 ms, 70 mm/s], [1 ms, 70 mm/s]]}
  down: {box: {from: [0.95 mm, 0 mm], to: [1.05 mm, 5.8 mm]}, direction: -y, speed: [[0 ms, 0 m/s], [0.1 ms, 70 mm/s], [1 ms, 70 mm/s]]}
output: {frames: 0, history: 100}
)";
}

TEST_CASE("a crack that grows takes its toughness, no more, and keeps to its line") {
  for (const char* growth : {"{toughness: 1 J/m^2}", "{toughness: 1 J/m^2, rule: energy, advance: 1}"}) {
    CAPTURE(std::string(growth));
    const Outcome out = run(scene_from(short_beam(growth)));
    REQUIRE(out.failure.empty());
    const auto last = [&](const char* name) { return out.history.at(name).back(); };
    const double grown = last("slit.end.x_m") - 8e-3, work = last("boundary_work_J");
    MESSAGE("grown ", grown, " took ", last("interface_J"), " J ", last("slit.end.J_J_per_m2"), " work ",
            work, " left ", last("kinetic_J") + last("stored_J") + last("interface_J") - work);
    CHECK(grown > 2e-3);
    CHECK(last("slit.length_m") == doctest::Approx(8e-3 + grown).epsilon(2e-3).scale(0));
    CHECK(last("interface_J") == doctest::Approx(1.0 * grown).epsilon(0.1).scale(0));
    CHECK(last("kinetic_J") + last("stored_J") + last("interface_J") ==
          doctest::Approx(work).epsilon(5e-3).scale(0));
    CHECK(std::abs(last("slit.end.y_m") - 6.25e-3) < 0.05e-3);
  }
}

TEST_CASE("a crack that grows into another goes no further, and the balance closes") {
  std::string text = short_beam("{toughness: 1 J/m^2, rule: energy}");
  text.replace(text.find("cracks: [") + 9, 0,
               "{name: bar, body: beam, line: [[11 mm, 4.75 mm], [11 mm, 7.75 mm]], law: frictionless}, ");
  text.replace(text.find("0.35 ms"), 7, "0.45 ms");
  const Outcome out = run(scene_from(text));
  REQUIRE(out.failure.empty());
  const auto& length = out.history.at("slit.length_m");
  const auto last = [&](const char* name) { return out.history.at(name).back(); };
  MESSAGE("length ", length.back(), " took ", last("interface_J"), " left ",
          last("kinetic_J") + last("stored_J") + last("interface_J") - last("boundary_work_J"), " of ",
          last("boundary_work_J"));
  CHECK(length.back() == doctest::Approx(11e-3).epsilon(1e-3).scale(0));
  CHECK(last("interface_J") == doctest::Approx(3e-3).epsilon(0.1).scale(0));
  CHECK(last("kinetic_J") + last("stored_J") + last("interface_J") ==
        doctest::Approx(last("boundary_work_J")).epsilon(0.01).scale(0));
}

/// Two halves of one body fly apart until no node sees both, come back from walls and meet.
TEST_CASE("what a crack has parted meets again and does not enter itself") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [60 mm, 20 mm], cell: 1 mm}
time: {end: 1 ms, cfl: 0.4}
materials: {soft: {model: neo_hookean, density: 1.2 g/cm^3, young: 50 MPa, poisson: 0.3}}
bodies: [{name: block, box: {from: [20.3 mm, 4.2 mm], to: [40.3 mm, 15.2 mm]}, material: soft}]
cracks: [{body: block, line: [[30.3 mm, 0 mm], [30.3 mm, 20 mm]], law: frictionless}]
boundaries: {left: wall, right: wall}
)");
  Step<2> step(scene);
  auto& particles = step.state().particles;
  const auto is_left = [&](std::size_t p) {
    return particles.column(Quantity::reference_position, 0)[p] < 30.3e-3;
  };
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.column(Quantity::velocity, 0)[p] = is_left(p) ? -10 : 10;
  const double start = kinetic_energy(particles);
  double widest = -1, least = 1, apart = 0, astray = 0;
  std::uint64_t peak = 0;
  for (; step.state().time < 5.2e-3; step.advance(step.stable_dt())) {
    double left = 0, right = 1;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double x = particles.column(Quantity::position, 0)[p];
      (is_left(p) ? left : right) = is_left(p) ? std::max(left, x) : std::min(right, x);
    }
    widest = std::max(widest, right - left);
    const auto& line = step.cracks().lines()[0];
    const std::size_t middle = line.points.size() / 2;
    astray = std::max(
        astray, std::abs(line.sides[1][middle][0] - line.sides[0][middle][0] + 0.5e-3 - (right - left)));
    if (step.state().time > 2.4e-3) least = std::min(least, right - left);
    apart = right - left;
    peak = std::max<std::uint64_t>(peak, step.contact_list().pairs.size());
  }
  const double left = kinetic_energy(particles) + step.stored_energy();
  MESSAGE("widest ", widest, " least ", least, " at last ", apart, " energy ", left / start, " astray ",
          astray);
  CHECK(widest > 10e-3);    // twenty cells would do
  CHECK(astray < 1e-3);     // each side of the line is with its half
  CHECK(least > 0.3e-3);    // half a cell lies between particles that touch, which the blow presses
  CHECK(apart > 2 * 1e-3);  // they parted again
  CHECK(left == doctest::Approx(start).epsilon(5e-3).scale(0));
  CHECK(std::abs(momentum(particles)[0]) < 1e-4 * start / 10);  // walls turn the halves one after the other
}

/// Freund: K_I of half a plane's crack that a wave of stress σ meets, 2σ √(c t (1 − 2ν)/π)/(1 − ν).
TEST_CASE("slow: a wave opens a crack as Freund says") {
  const Outcome out = run(scene_file("crack_wave.yaml", {{"output.frames", "0"}}));
  REQUIRE(out.failure.empty());
  const double c = std::sqrt(5e9 * 0.7 / (1.3 * 0.4) / 2600);
  const auto &time = out.history.at("time_s"), &found = out.history.at("slit.end.KI_Pa_sqrt_m");
  double worst = 0, sum = 0;
  int rows = 0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double way = c * time[k] - 59.8e-3;
    if (way < 15e-3) continue;
    const double error = found[k] / (2 * 2600 * c * std::sqrt(way * 0.4 / std::numbers::pi) / 0.7) - 1;
    worst = std::max(worst, std::abs(error));
    sum += std::abs(error);
    ++rows;
  }
  MESSAGE("worst ", worst, " mean ", sum / rows);
  REQUIRE(rows > 50);
  CHECK(worst < 0.05);
  CHECK(sum / rows < 0.01);
}

/// The mean over the second half of a run of an intensity over that of a uniform stress, what the grips bear.
double over_uniform(const Outcome& out, const std::string& column, double width, double half) {
  const auto &found = out.history.at(column), &up = out.history.at("up.force_y_N"),
             &down = out.history.at("down.force_y_N");
  double sum = 0;
  const std::size_t rows = found.size(), begin = rows / 2;
  for (std::size_t k = begin; k < rows; ++k)
    sum +=
        found[k] / (0.5 * (std::abs(up[k]) + std::abs(down[k])) / width * std::sqrt(std::numbers::pi * half));
  return sum / static_cast<double>(rows - begin);
}

TEST_CASE("slow: stress intensities of an edge crack and of a slanted one are those of handbooks") {
  const Outcome edge = run(scene_file("edge_crack.yaml", {{"output.frames", "0"}}));
  REQUIRE(edge.failure.empty());
  const double r = 0.25;  // Tada, of two edge cracks
  const double wanted =
      (1.122 - 0.561 * r - 0.205 * r * r + 0.471 * r * r * r - 0.19 * r * r * r * r) / std::sqrt(1 - r);
  const double notch = over_uniform(edge, "notch.start.KI_Pa_sqrt_m", 80e-3, 20e-3) / wanted;
  const Outcome slanted = run(scene_file("slanted_crack.yaml", {{"output.frames", "0"}}));
  REQUIRE(slanted.failure.empty());
  const double one = over_uniform(slanted, "slit.end.KI_Pa_sqrt_m", 0.2, 10e-3),
               two = over_uniform(slanted, "slit.end.KII_Pa_sqrt_m", 0.2, 10e-3);
  MESSAGE("edge ", notch, " slanted ", one, " ", two);
  CHECK(notch == doctest::Approx(1).epsilon(0.01).scale(0));
  CHECK(one == doctest::Approx(0.5).epsilon(0.03).scale(0));
  CHECK(two == doctest::Approx(0.5).epsilon(0.03).scale(0));
}

TEST_CASE("slow: a slanted crack kinks to where the hoop stress is largest, and parts the plate") {
  const Scene scene = scene_file("kinked_crack.yaml", {{"output.frames", "0"}});
  Step<2> step(scene);
  const auto& line = step.cracks().lines()[0];
  const std::size_t start = line.points.size();
  while (line.points.size() < start + 6) step.advance(step.stable_dt());
  const auto angle = [&](std::size_t a, std::size_t b) {
    const Vec<2> way = line.points[b] - line.points[a];
    return std::atan2(way[1], way[0]) * 180 / std::numbers::pi;
  };
  const double first = angle(0, 1), last = angle(line.points.size() - 2, line.points.size() - 1);
  MESSAGE("kinks ", first - 45, " ", last - 45);
  CHECK(std::abs(first - 45 + 53.13) < 2);
  CHECK(std::abs(last - 45 + 53.13) < 2);
  while (step.state().time < scene.time.end) step.advance(step.stable_dt());
  CHECK(!line.ends[0].grows);
  CHECK(!line.ends[1].grows);
  for (const Vec<2>& x : line.points) CHECK(std::abs(x[1] - 55e-3) < 9e-3);
}

TEST_CASE("slow: a beam grows its crack steadily at its toughness, and breaks where it is hit") {
  const Outcome beam =
      run(scene_file("dcb.yaml", {{"grid.cell", "0.25 mm"},
                                  {"output.frames", "0"},
                                  {"cracks.0.growth", "{toughness: 5 J/m^2, rule: energy}"}}));
  REQUIRE(beam.failure.empty());
  const auto& h = beam.history;
  const double grown = h.at("slit.end.x_m").back() - 13e-3, work = h.at("boundary_work_J").back();
  double sum = 0;
  int rows = 0;
  for (std::size_t k = 0; k < h.at("time_s").size(); ++k)
    if (h.at("slit.end.x_m")[k] > 14e-3) sum += h.at("slit.end.J_J_per_m2")[k], ++rows;
  MESSAGE("grown ", grown, " took ", h.at("interface_J").back(), " J ", sum / rows);
  CHECK(sum / rows == doctest::Approx(5).epsilon(0.05).scale(0));
  CHECK(h.at("interface_J").back() == doctest::Approx(5 * grown).epsilon(0.05).scale(0));
  CHECK(h.at("kinetic_J").back() + h.at("stored_J").back() + h.at("interface_J").back() ==
        doctest::Approx(work).epsilon(5e-3).scale(0));
  const Outcome broken = run(scene_file("broken_beam.yaml", {{"output.frames", "0"}}));
  REQUIRE(broken.failure.empty());
  CHECK(std::abs(broken.summary.energy_error) < 5e-3);
  const auto& length = broken.history.at("notch.length_m");
  CHECK(*std::max_element(length.begin(), length.end()) > 25e-3);
}

}  // namespace
}  // namespace mpmfast
