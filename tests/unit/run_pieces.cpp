/// What a run remembers beside its state, piece by piece: marks in time, the balance of energy, where it
/// comes from, its log.

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "engine/contact/geometry/normal_fit.hpp"
#include "engine/errors.hpp"
#include "engine/output/checkpoint_file.hpp"
#include "engine/run/contact_memory.hpp"
#include "engine/run/run_counters.hpp"
#include "engine/run/run_log.hpp"
#include "tests/support.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// An archive in memory: what is written comes back as it was.
class Kept final : public Archive {
 public:
  bool reading() const override { return reading_; }
  void rewind() { reading_ = true; }

 private:
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    const bool wide = kind == NumberKind::real || kind == NumberKind::whole64;
    const std::size_t size = wide ? 8 : kind == NumberKind::whole8 ? 1 : kind == NumberKind::whole16 ? 2 : 4;
    std::string& bytes = bytes_[name];
    if (!reading_) {
      bytes.assign(static_cast<const char*>(values), n * size);
      count_[name] = n;
    } else if (n > 0) {
      REQUIRE(bytes.size() == n * size);
      std::memcpy(values, bytes.data(), bytes.size());
    }
  }
  std::size_t length(const std::string& name) override { return count_.at(name); }

  std::map<std::string, std::string> bytes_;
  std::map<std::string, std::size_t> count_;
  bool reading_ = false;
};

std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("marks lie evenly in time, each is passed once, and none is due of no marks") {
  for (const int count : {1, 3, 7, 20}) {
    CAPTURE(count);
    Marks marks(2.0, count);
    int passed = 0;
    for (int k = 0; k <= 1000; ++k) {
      const double time = 2.0 * k / 1000;
      int reached = 0;  // marks up to here, counted one by one
      for (int m = 1; m <= count; ++m) reached += time >= 2.0 * m / count * (1 - 1e-12);
      CHECK(marks.due(time) == (reached > passed));
      if (!marks.due(time)) continue;
      marks.pass(time);
      passed = reached;
      CHECK_FALSE(marks.due(time));
    }
    CHECK(passed == count);
  }
  Marks none(2.0, 0);
  CHECK_FALSE(none.due(0));
  CHECK_FALSE(none.due(5));
  // A mark is due a hair before its time, and not earlier.
  const Marks one(2.0, 2);
  CHECK(one.due(1 - 0.5e-12));
  CHECK_FALSE(one.due(1 - 2e-12));
}

TEST_CASE("marks go on from an archive where they were, and from one that says nonsense from the first") {
  Marks marks(1.0, 10);
  marks.pass(0.35);
  Kept kept;
  marks.visit(kept, "next");
  kept.rewind();
  Marks again(1.0, 10);
  again.visit(kept, "next");
  CHECK_FALSE(again.due(0.39));
  CHECK(again.due(0.4));
  for (const int wrong : {-5, 0}) {
    Kept forged;
    int next = wrong;
    forged.number("next", next);
    forged.rewind();
    Marks first(1.0, 10);
    first.visit(forged, "next");
    CHECK_FALSE(first.due(0.09));
    CHECK(first.due(0.1));
  }
}

TEST_CASE("the balance of energy drifts by what its terms do, over the most that there was") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int trial = 0; trial < 20; ++trial) {
    EnergyBalance balance;
    CHECK(balance.error() == 0);
    double first = 0, most = 0;
    for (int k = 0; k < 5; ++k) {
      HistoryRow row;
      row.kinetic = std::abs(any(random));
      row.stored = std::abs(any(random));
      row.dissipated = std::abs(any(random));
      row.friction = any(random);
      row.interface = any(random);
      row.boundary_work = 3 * any(random);
      row.body_force_work = 3 * any(random);
      if (trial % 2 == 1) row.outflow.emplace().energy = any(random);
      if (trial % 3 == 1) row.heat.emplace().worked = any(random);
      double sum = row.kinetic + row.stored + row.dissipated;
      most = std::max({most, sum, std::abs(row.boundary_work), std::abs(row.body_force_work)});
      sum += row.friction + row.interface - row.boundary_work - row.body_force_work;
      if (row.outflow) sum += row.outflow->energy;
      if (row.heat) sum -= row.heat->worked;
      if (k == 0) first = sum;
      balance.add(row);
      CHECK(balance.error() == doctest::Approx((sum - first) / most).epsilon(1e-9));
    }
    Kept kept;
    balance.visit(kept);
    kept.rewind();
    EnergyBalance again;
    again.visit(kept);
    CHECK(again.error() == balance.error());
    HistoryRow row;
    row.kinetic = 0.5;
    balance.add(row);
    again.add(row);
    CHECK(again.error() == balance.error());
  }
}

TEST_CASE("where a run comes from is kept as it was: texts one by one, also empty ones and none") {
  for (const std::vector<std::string>& texts : {std::vector<std::string>{},
                                                {""},
                                                {"a"},
                                                {"a", "b"},
                                                {"", ""},
                                                {"one", "", "three words here", "\n"}}) {
    RunOrigin origin;
    origin.scene_hash = "hash";
    origin.seeding = "seeds";
    origin.program = "program 1";
    origin.scene_name = "scene.yaml";
    origin.command = "run scene.yaml";
    origin.overrides = texts;
    origin.warnings = {"before", "after"};
    origin.end = 0.25;
    origin.max_steps = 17;
    Kept kept;
    origin.visit(kept);
    kept.rewind();
    RunOrigin again;
    again.overrides = {"old"};
    again.visit(kept);
    CHECK(again.scene_hash == "hash");
    CHECK(again.seeding == "seeds");
    CHECK(again.program == "program 1");
    CHECK(again.scene_name == "scene.yaml");
    CHECK(again.command == "run scene.yaml");
    CHECK(again.overrides == texts);
    CHECK(again.warnings == std::vector<std::string>{"before", "after"});
    CHECK(again.end == 0.25);
    CHECK(again.max_steps == 17);
  }
  RunOrigin endless;
  endless.end = std::numeric_limits<double>::infinity();
  Kept kept;
  endless.visit(kept);
  kept.rewind();
  CHECK_THROWS_WITH_AS(RunOrigin().visit(kept), "the checkpoint's run has no end", FileError);
}

TEST_CASE("counters that no run can have are refused by their names") {
  const Scene scene = scene_file("uniaxial.yaml");
  const auto said = [&](const auto& change) -> std::string {
    RunCounters<2> counters(scene);
    change(counters);
    try {
      counters.check(2);
    } catch (const FileError& error) {
      return error.what();
    }
    return "good";
  };
  const auto fault = [](const std::string& name) {
    return "the checkpoint is none of its scene: " + name + " does not fit it";
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(said([](auto&) {}) == "good");
  CHECK(said([](auto& c) { c.spacing.body = 1; }) == "good");
  CHECK(said([](auto& c) { c.spacing.body = 2; }) == fault("run/spacing_body"));
  for (const double seconds : {0.0, 9.99e9}) {
    CHECK(said([&](auto& c) { c.wall = seconds; }) == "good");
    CHECK(said([&](auto& c) { c.stepping = seconds; }) == "good");
  }
  for (const double seconds : {-1e-9, 1e10, none}) {
    CHECK(said([&](auto& c) { c.wall = seconds; }) == fault("run/wall_seconds"));
    CHECK(said([&](auto& c) { c.stepping = seconds; }) == fault("run/wall_seconds"));
  }
  CHECK(said([](auto& c) { c.first_dt = 0; }) == "good");
  CHECK(said([](auto& c) { c.first_dt = 1e-9; }) == "good");
  CHECK(said([](auto& c) { c.first_dt = -1e-9; }) == fault("run/first_dt"));
  CHECK(said([&](auto& c) { c.first_dt = none; }) == fault("run/first_dt"));
  CHECK(said([](auto& c) { c.frame_times = {0, 1}; }) == "good");
  CHECK(said([&](auto& c) { c.frame_times = {0, none}; }) == fault("run/frame_times"));
}

TEST_CASE("the log of a run says what runs, each row, each warning when it comes, and how the run went") {
  const Folder folder;
  std::filesystem::create_directories(folder / "run");
  std::ofstream(folder / "run/run.log") << "of another run\n";
  RunSummary figures;
  figures.command = "mpmfast run scene.yaml";
  figures.scene_name = "scene.yaml";
  figures.particles = 120;
  figures.fields = 2;
  figures.threads = 1;
  figures.scene_warnings = {"scene.yaml:1:1: warning: first", "second"};
  {
    RunLog log(folder / "run", figures);
    figures.steps = 10;
    figures.time = 1.5e-6;
    figures.wall = 2;
    figures.particle_steps_per_second = 1.25e7;
    figures.energy_error = 0.012345;
    log.row(figures, 1.5e-7);
    figures.steps = 20;
    figures.third_cracks = 3;
    log.row(figures, 1.25e-7);
    figures.steps = 30;
    figures.third_cracks = 4;
    log.row(figures, 1e-7);
    figures.status = "stopped";
    figures.reason = "signal";
    figures.checksum = "abc";
    figures.seconds = {{"sort", 0.5}, {"none", 0}, {"project", 1}};
    log.close(figures);
  }
  const std::string cracks =
      " times a particle saw a node behind a third crack, which does not part it: nodes tell two cracks "
      "apart; "
      "smaller cells keep them further apart\n";
  CHECK(text_in(folder / "run/run.log") ==
        program_text() +
            "\nmpmfast run scene.yaml\nscene.yaml: 120 particles in 2 velocity fields, 2-D, 1 thread\n"
            "scene.yaml:1:1: warning: first\nsecond\n"
            "      step     time (s)       dt (s)   wall (s)  particle-steps/s  energy error\n"
            "        10      1.5e-06      1.5e-07       2.00          1.25e+07       1.234 %\n"
            "        20      1.5e-06     1.25e-07       2.00          1.25e+07       1.234 %\n"
            "warning: 3" +
            cracks +
            "        30      1.5e-06        1e-07       2.00          1.25e+07       1.234 %\n"
            "stopped: signal at step 30, 1.5e-06 s, after 2.00 s\n"
            "  sort                   0.500 s   25.0 %\n"
            "  project                1.000 s   50.0 %\n"
            "warning in 2 of 3 rows, last: 4" +
            cracks + "checksum abc\n");
  figures.resumes = 1;
  figures.threads = 3;
  figures.reason = "";
  figures.status = "finished";
  figures.wall = 0;
  figures.seconds = {{"sort", 0.5}};
  const std::string before = text_in(folder / "run/run.log");
  { RunLog(folder / "run", figures).close(figures); }
  CHECK(text_in(folder / "run/run.log") == before + "goes on from step 30 at 1.5e-06 s (" + program_text() +
                                               ", 3 threads)\nfinished at step 30, 1.5e-06 s, after 0.00 s\n"
                                               "  sort                   0.500 s    0.0 %\nchecksum abc\n");
}

TEST_CASE("planes that outlast a step take two fits a node more") {
  Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [24 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
contact: {normal: max_margin}
bodies:
  - {name: a, box: {from: [4 mm, 4 mm], to: [8 mm, 8 mm]}, material: soft}
  - {name: b, box: {from: [8 mm, 4 mm], to: [12 mm, 8 mm]}, material: soft}
)");
  Step<2> step(scene);
  advance(step, 1);
  const ContactNeed without = contact_need(step, scene);
  scene.contact.refit = 0.1;
  const ContactNeed with = contact_need(step, scene);
  CHECK(with.nodes == without.nodes);
  constexpr double kGrowth = 1.25;  // lists grow by doubling
  CHECK(with.bytes - without.bytes ==
        doctest::Approx(kGrowth * 2 * sizeof(KeptFit<2>) * with.nodes).epsilon(1e-9));
}

TEST_CASE(
    "a limit that a resume is told is on the disk while it runs, and speeds count particles and steps") {
  const Folder folder;
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [6 mm, 6 mm], cell: 1 mm}
time: {end: 1 s}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: a, box: {from: [2 mm, 2 mm], to: [4 mm, 4 mm]}, material: soft}]
output: {frames: 0, history: 1, picture: none, checkpoint: {every: none}}
)");
  RunOptions options;
  options.folder = folder / "run";
  options.max_steps = 4;
  const RunSummary first = run_scene(scene, options);
  CHECK(first.particle_steps_per_second * first.wall >= 4 * 16);
  constexpr std::uint64_t kMany = 1000000000;
  std::uint64_t kept = 0;
  options.max_steps = kMany;
  options.stop = [&] {  // between two steps
    CheckpointReader file(folder / "run" / "checkpoint.h5");
    RunOrigin origin;
    origin.visit(file);
    kept = origin.max_steps;
    return true;
  };
  REQUIRE(resume_run(options));
  CHECK(kept == kMany);
}
