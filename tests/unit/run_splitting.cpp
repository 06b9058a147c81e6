// Runs whose particles are split: their files, and how they go on after a stop.

#include <nlohmann/json.hpp>

#include <fstream>

#include "engine/output/paint.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/read_frame.hpp"
#include "tests/support.hpp"
#include "tools/report/frame_constants.hpp"

namespace mpmfast {
namespace {

using namespace test;

const char* const kDrawn = R"(
space: plane_strain
grid: {size: [24 mm, 8 mm], cell: 1 mm}
time: {end: 0.6 ms}
materials:
  rubber: {model: logarithmic_neo_hookean, density: 1000 kg/m^3, young: 1 MPa, poisson: 0.3}
  grip: {model: rigid}
bodies:
  - {name: strip, box: {from: [9 mm, 2 mm], to: [15 mm, 6 mm]}, material: rubber, particles_per_cell: [1, 3]}
  - {name: l, box: {from: [7 mm, 1 mm], to: [9 mm, 7 mm]}, material: grip, velocity: [-12 m/s, 0]}
  - {name: r, box: {from: [15 mm, 1 mm], to: [17 mm, 7 mm]}, material: grip, velocity: [12 m/s, 0]}
contact: {law: perfect}
method: {basis: lcpdi, split: {edge: 1.25}}
output: {frames: 6, history: 20, picture: stress_xx}
)";

TEST_CASE("frames of a run whose particles are split hold those of their moment, with their domains") {
  const Scene scene = scene_from(kDrawn);
  const Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  const RunSummary summary = run_scene(scene, options);
  REQUIRE(summary.splits);
  REQUIRE(summary.splits->splits > 0);
  std::size_t before = 0;
  double mass = 0;
  for (int frame = 0; frame <= 6; ++frame) {
    const auto path = options.folder / "particles" / ("00000" + std::to_string(frame) + ".vtu");
    const VtuReader file(path);
    const Particles<2> particles = read_frame<2>(file, path, scene);
    CHECK(particles.size() >= before);
    before = particles.size();
    CHECK(order_by_id(particles).size() == particles.size());
    double volume = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      CHECK((p == 0 || particles.id()[p] > particles.id()[p - 1]));
      volume += particles.column(Quantity::initial_volume)[p];
      // The volume of a domain is its share of the body's: so pictures of files know its sides.
      const bool strip = particles.body()[p] == 0;
      const double whole = strip ? 1e-6 / 3 : 0.25e-6;
      CHECK(
          particles.column(Quantity::initial_volume)[p] ==
          doctest::Approx(whole * particles.domain_share(p, 0) * particles.domain_share(p, 1)).epsilon(1e-6));
    }
    if (frame == 0) mass = volume;
    CHECK(volume == doctest::Approx(mass).epsilon(1e-6));
  }
  CHECK(before == summary.particles);
  std::ifstream in(options.folder / "run.json");
  const auto json = nlohmann::json::parse(in);
  CHECK(json["splits"]["count"] == summary.splits->splits);
  CHECK(json["splits"]["held"] == 0);
}

/// The strip of kDrawn when some of its particles were split, in a file and as the run has it.
struct Written {
  Written() : scene(scene_from(kDrawn)), step(scene) {
    while (step.state().time < scene.time.end) advance(step, 1);
    step.find_stresses();
    std::filesystem::create_directories(folder / "run");
    ParticleSeries<2> series(folder / "run", scene);
    series.append(step.state().particles, step.state().time);
  }
  std::filesystem::path file() const { return folder / "run/particles/000000.vtu"; }
  Folder folder;
  Scene scene;
  Step<2> step;
};

TEST_CASE("pictures of files draw the domains of split particles as the run draws them") {
  const Written run;
  REQUIRE(run.step.splits().splits > 0);
  const VtuReader file(run.file());
  const auto pixels_of = [&](const Particles<2>& particles) {
    return paint_particles(particles, run.scene, "body", 0, Framing{}, PictureFormat::png, {}).pixels();
  };
  const auto live = pixels_of(run.step.state().particles),
             read = pixels_of(read_frame<2>(file, run.file(), run.scene));
  REQUIRE(live.size() == read.size());
  int painted = 0, other = 0;
  for (std::size_t k = 0; k < live.size(); ++k) {
    painted += live[k] < 250;
    other += std::abs(int{live[k]} - int{read[k]}) > 30;  // more than what rounding does at an edge
  }
  CHECK(painted > 10000);
  CHECK(other < painted / 500);
}

TEST_CASE("a page draws split particles by F times their shares, on the sides that were seeded") {
  const Written run;
  const FrameFile file(run.file());
  const auto& particles = run.step.state().particles;
  const std::vector<std::uint32_t> order = order_by_id(particles);
  const auto fields = gradient_fields();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::vector<double> values = fields[k].values(file);
    for (std::size_t i = 0; i < order.size(); ++i)
      REQUIRE(values[i] == doctest::Approx(particles.deformation_gradient(order[i])(k / 2, k % 2) *
                                           particles.domain_share(order[i], k % 2)));
  }
  PointOrder point_order;
  for (std::size_t i = 0; i < order.size(); ++i)
    point_order.in_file.push_back(i), point_order.in_page.push_back(i);
  FrameConstants constants(order.size());
  note_constants(file, point_order, run.scene, 2, constants);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool strip = particles.body()[order[i]] == 0;
    REQUIRE(constants.side_x[i] == doctest::Approx(strip ? 1e-3 : 0.5e-3).epsilon(1e-5));
    REQUIRE(constants.side_y[i] == doctest::Approx(strip ? 1e-3 / 3 : 0.5e-3).epsilon(1e-5));
  }
}

TEST_CASE("a run that is stopped before, amid and after splits goes on to the bit") {
  const Scene scene = scene_from(kDrawn);
  const Folder folder;
  RunOptions options;
  options.folder = folder / "whole";
  const RunSummary whole = run_scene(scene, options);
  std::uint64_t stopped_amid = 0;
  for (std::uint64_t stop :
       {whole.steps / 8, whole.steps / 2, whole.steps / 2 + 1, 3 * whole.steps / 4, whole.steps - 2}) {
    if (sanitized() && stop != whole.steps / 2) continue;
    CAPTURE(stop);
    RunOptions first;
    first.folder = folder / "stopped";
    first.force = true;
    first.max_steps = stop;
    const RunSummary half = run_scene(scene, first);
    stopped_amid += half.splits->splits > 0 && half.splits->splits < whole.splits->splits;
    RunOptions next;
    next.folder = first.folder;
    next.threads = 3;
    const auto resumed = resume_run(next);
    REQUIRE(resumed);
    CHECK(resumed->checksum == whole.checksum);
    CHECK(resumed->splits->splits == whole.splits->splits);
    CHECK(read_history(folder / "stopped/history.csv") == read_history(folder / "whole/history.csv"));
  }
  CHECK(stopped_amid > 0);
}

TEST_CASE("`check` states what splits may come to take") {
  const Scene scene = scene_from(kDrawn), plain = scene_from(kDrawn, {{"method.split", "none"}});
  const std::string text = describe_plan(scene, true);
  CHECK(text.find("should each particle be split once") != std::string::npos);
  CHECK(text.find("domain_share") != std::string::npos);
  CHECK(text.find("split particles whose domains") != std::string::npos);
  const std::string without = describe_plan(plain, true);
  CHECK(without.find("split") == std::string::npos);
}

TEST_CASE("a thread that is drawn out beyond all halvings is told of") {
  RunSummary summary;
  summary.splits = {300, 12};
  const auto warnings = run_warnings(summary);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings.front().about == "splits");
  CHECK(warnings.front().text.find("12 edges") != std::string::npos);
  summary.splits->held = 0;
  CHECK(run_warnings(summary).empty());
}

}  // namespace
}  // namespace mpmfast
