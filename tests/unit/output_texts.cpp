// Whole texts that a run leaves, over all that decides them, against recorded ones.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recorded.hpp"
#include "tests/unit/output_fixture.hpp"
#include "tests/unit/scene_helpers.hpp"

using namespace output_test;

namespace {

/// What a summary gives reason to doubt, under what was told to it.
void add_warnings(std::string& out, const std::string& what, const RunSummary& summary) {
  out += "== " + what + "\n";
  for (const RunWarning& warning : run_warnings(summary))
    out += fmt::format("{}: {}\n", warning.about, warning.text);
}

TEST_CASE("warnings begin where what is usual ends, and say how much there is of it") {
  using Contact = RunSummary::Contact;
  struct Share {
    const char* name;
    std::uint64_t Contact::*part;
    std::uint64_t Contact::*whole;
    double usual;
  };
  std::string out;
  for (const auto& [name, part, whole, usual] :
       {Share{"unconverged", &Contact::unconverged, &Contact::regressions, kMostUnconverged},
        Share{"doubtful", &Contact::doubtful, &Contact::touching, kMostDoubtful},
        Share{"pair fallbacks", &Contact::pair_fallbacks, &Contact::pair_nodes, kMostPairFallbacks},
        Share{"screened", &Contact::screened, &Contact::meetings, kMostScreened}}) {
    for (const std::uint64_t all : {std::uint64_t{999}, std::uint64_t{1000}, std::uint64_t{1'000'000}}) {
      const auto most = static_cast<std::uint64_t>(usual * static_cast<double>(all) + 0.5);
      for (const std::uint64_t some : {std::uint64_t{0}, most, most + 1, 3 * most, all}) {
        RunSummary summary;
        summary.contact.*part = some;
        summary.contact.*whole = all;
        add_warnings(out, fmt::format("{}: {} of {}", name, some, all), summary);
      }
    }
  }
  for (const bool by_volume : {false, true}) {
    RunSummary summary;
    summary.contact.meetings = summary.contact.screened = 5000;
    summary.settings.volume_screen = by_volume;
    add_warnings(out, fmt::format("screened by {}", by_volume ? "volume" : "mass"), summary);
  }
  for (const std::uint64_t times : {0, 1, 2, 1234567}) {
    RunSummary summary;
    summary.third_cracks = times;
    CHECK(run_warnings(summary).size() == (times > 0 ? 1u : 0u));
    if (times == 1) continue;
    add_warnings(out, fmt::format("third cracks: {}", times), summary);
  }
  for (const std::uint64_t held : {0, 1, 2, 1234567}) {
    RunSummary summary;
    summary.splits = {77, held};
    CHECK(run_warnings(summary).size() == (held > 0 ? 1u : 0u));
    if (held == 1) continue;
    add_warnings(out, fmt::format("held edges: {}", held), summary);
  }
  test::check_recorded_text("warnings_shares.txt", out);
}

TEST_CASE("warnings of drift and of bodies that part name the ways out that are left") {
  std::string out;
  for (const double error :
       {-12.34, -1.0, -0.995, -0.994, -0.101, -0.1, -0.0, 0.0, 0.1, 0.1001, 0.25, 0.996, 7.5}) {
    RunSummary summary;
    summary.energy_error = error;
    add_warnings(out, fmt::format("drift {}", error), summary);
  }
  for (int bits = 0; bits < 8; ++bits)
    for (const double error : {-0.5, 0.5}) {
      RunSummary summary;
      summary.energy_error = error;
      summary.settings.averaged_strain = (bits & 1) != 0;
      summary.settings.grid_end = (bits & 2) != 0;
      summary.settings.filtered = (bits & 4) != 0;
      summary.settings.cfl = 0.1 + 0.05 * bits;
      add_warnings(
          out,
          fmt::format("drift {} with averaged strain {}, grid_end {}, filter {}", error,
                      summary.settings.averaged_strain, summary.settings.grid_end, summary.settings.filtered),
          summary);
    }
  for (int bits = 0; bits < 4; ++bits)
    for (const double most : {1.0, 2.5})
      for (const double spacing : {0.5, 1.0999 * most, 1.1001 * most, 12.3456}) {
        RunSummary summary;
        summary.spacing = spacing;
        summary.most_spacing = most;
        summary.spacing_body = "bar";
        summary.settings.follows_shape = (bits & 1) != 0;
        summary.settings.splits = (bits & 2) != 0;
        add_warnings(out,
                     fmt::format("{} cells apart of {}, follows shape {}, splits {}", spacing, most,
                                 summary.settings.follows_shape, summary.settings.splits),
                     summary);
      }
  test::check_recorded_text("warnings_remedies.txt", out);
}

TEST_CASE("all warnings together come in their order, of a run that failed the causes first") {
  std::string out;
  for (const char* status : {"finished", "stopped", "failed"})
    for (const bool follows : {false, true})
      for (const char* flowing : {"", "sand"}) {
        RunSummary summary;
        summary.status = status;
        summary.scene_warnings = {"first of the scene", "second of the scene"};
        summary.contact.regressions = summary.contact.unconverged = 2000;
        summary.contact.touching = summary.contact.doubtful = 2000;
        summary.contact.pair_nodes = summary.contact.pair_fallbacks = 2000;
        summary.contact.meetings = summary.contact.screened = 2000;
        summary.third_cracks = 3;
        summary.spacing = 2;
        summary.spacing_body = "bar";
        summary.splits = {1, 2};
        summary.energy_error = 0.3;
        summary.settings.follows_shape = follows;
        summary.settings.flowing_body = flowing;
        out += fmt::format("== {}, follows shape {}, flows '{}'\n", status, follows, flowing);
        for (const std::string& warning : all_warnings(summary)) out += warning + "\n";
      }
  test::check_recorded_text("warnings_all.txt", out);
}

/// Every number another one.
RunSummary full_summary() {
  RunSummary s;
  s.scene_name = "a scene";
  s.status = "failed";
  s.reason = "J = 0.03";
  s.failed_by = "physics";
  s.history = {101, 102, "abc"};
  s.dimension = 3;
  s.threads = 4;
  s.particles = 103, s.fields = 104, s.nodes_active_peak = 105, s.steps = 106;
  s.time = 0.107, s.dt_min = 0.108, s.dt_max = 0.109, s.wall = 0.11, s.particle_steps_per_second = 111.5;
  s.peak_memory_bytes = 112;
  s.seconds = {{"project", 113.5}, {"contact", 114.5}};
  s.contact.nodes_peak = 115, s.contact.regressions = 116, s.contact.fallbacks = 117,
  s.contact.unconverged = 118;
  s.contact.mean_iterations = 119.5;
  s.contact.touching = 120, s.contact.doubtful = 121, s.contact.pair_nodes = 122,
  s.contact.pair_fallbacks = 123;
  s.contact.meetings = 124, s.contact.screened = 125, s.contact.points_peak = 126;
  s.energy_error = 0.05;
  s.overlap = Overlap{0.127, 0.128, 129, {}};
  s.outflow = Outflow{130, 0.131, 0.132, {}};
  s.splits = {133, 134};
  s.checksum = "0123";
  s.command = "mpmfast run";
  s.overrides = {"a=1", "b=2"};
  s.scene_warnings = {"one of the scene"};
  s.resumes = 135;
  s.resolved_yaml = "a";
  return s;
}

TEST_CASE("run.json holds each figure of a run under its name") {
  const TemporaryFolder folder;
  std::string out;
  for (const bool full : {false, true}) {
    write_run_json(folder.path(), full ? full_summary() : RunSummary{});
    auto json = nlohmann::ordered_json::parse(read_text(folder.path() / "run.json"));
    for (const char* of_machine : {"version", "git", "compiler", "flags", "cpu"}) {
      CHECK(json[of_machine].is_string());
      json[of_machine] = "as it is";
    }
    out += json.dump(2) + "\n";
  }
  test::check_recorded_text("run_json.txt", out);
}

/// A scene that has all that histories may tell.
Scene full_scene(bool solid) {
  std::string text = solid ? test::solid_scene() : test::plain_scene();
  if (!solid)
    text +=
        "cracks:\n"
        "  - {name: long, body: block, line: [[1.5 mm, 2 mm], [3.5 mm, 2 mm]], law: frictionless,\n"
        "     growth: {toughness: 10 J/m^2}}\n"
        "  - {name: edge, body: block, line: [[0.5 mm, 1.5 mm], [2 mm, 1.5 mm]], law: frictionless}\n";
  Scene scene = test::parse(text);
  scene.materials.push_back({"tool", Rigid{}});
  BodySpec tool = scene.bodies[0], anvil = tool;
  tool.name = "tool";
  anvil.name = "anvil";
  tool.material = anvil.material = 1;
  scene.bodies.push_back(tool);
  scene.bodies.insert(scene.bodies.begin(), anvil);
  for (CrackSpec& crack : scene.cracks) ++crack.body;
  scene.grid.origin = {1e-3, 0, 0};
  scene.boundaries = {{"floor", WallSpec{1, false, 1e-3, {{0}, {0.5}}, false}},
                      {"ram", WallSpec{1, true, 9e-3, {{0}, {-3}}, false}},
                      {"side", WallSpec{0, true, 9e-3, {{0}, {2}}, false}},
                      {"grip", VelocityBoxSpec{}}};
  scene.contact.pairs = {{false, {1, 2}, {}}, {true, {0, 1}, {}}};
  scene.contact.law.acts = Cohesive{};
  scene.contact.family = ContactFamily::penalty;
  scene.output.overlap = !solid;
  scene.grid.outflow = OutflowKind::outflow;
  scene.heat.active = true;
  scene.heat.conditions.resize(2);
  scene.heat.conditions[0].name = "hot";
  scene.heat.conditions[1].name = "cold";
  return scene;
}

/// Every number another one. @param rows  of each list
HistoryRow full_row(std::size_t rows) {
  HistoryRow row;
  double next = 100;
  const auto number = [&] { return next += 1; };
  const auto fill = [&](auto& numbers) {
    for (double& x : numbers) x = number();
  };
  row.step = 7;
  row.time = 1e-3;
  for (double* x : {&row.dt, &row.kinetic, &row.stored, &row.friction, &row.boundary_work,
                    &row.body_force_work, &row.dissipated, &row.interface, &row.joints})
    *x = number();
  fill(row.momentum);
  fill(row.mean_stress);
  row.bodies.resize(rows);
  for (auto& body : row.bodies) {
    fill(body.mean_stress);
    body.mass = number();
    fill(body.position);
    fill(body.velocity);
    body.temperature = number();
  }
  for (auto* vectors : {&row.boundary_force, &row.rigid_force, &row.rigid_moment, &row.pair_force}) {
    vectors->resize(rows);
    for (Vec3& x : *vectors) fill(x);
  }
  for (auto* numbers : {&row.pair_friction, &row.pair_area, &row.crack_lengths}) {
    numbers->resize(rows);
    fill(*numbers);
  }
  row.tips.resize(rows);
  for (auto& tip : row.tips) fill(tip);
  row.overlap = Overlap{number(), number(), 1, {}};
  row.outflow = Outflow{1, number(), number(), {number(), number(), number()}};
  HistoryRow::Heat heat;
  for (double* x : {&heat.content, &heat.in, &heat.friction, &heat.worked}) *x = number();
  heat.conditions.resize(rows);
  fill(heat.conditions);
  row.heat = heat;
  return row;
}

TEST_CASE("a history names each of its numbers, in the plane and in space") {
  for (const bool solid : {false, true}) {
    const Scene scene = full_scene(solid);
    std::string out;
    for (const std::size_t rows : {0, 1, 2, 5}) {
      const HistoryRow row = rows == 0 ? HistoryRow{} : full_row(rows);
      const std::vector<std::string> names = history_columns(scene);
      const std::vector<double> numbers = history_numbers(row, scene);
      REQUIRE(names.size() == numbers.size());
      out += fmt::format("== {} of each\n", rows);
      for (std::size_t k = 0; k < names.size(); ++k) out += fmt::format("{} {}\n", names[k], numbers[k]);
    }
    test::check_recorded_text(solid ? "history_solid.txt" : "history_plane.txt", out);
  }
}

TEST_CASE("bonds and joints have columns where surfaces may touch by them, in contact or in cracks") {
  const auto has = [](const Scene& scene, const std::string& name) {
    const std::vector<std::string> names = history_columns(scene);
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const bool active : {false, true})
    for (const bool cohesive : {false, true})
      for (const bool cracked : {false, true}) {
        Scene scene = full_scene(false);
        scene.contact.active = active;
        scene.contact.pairs.clear();
        scene.contact.law.acts = cohesive ? AnyLaw(Cohesive{}) : AnyLaw(Frictionless{});
        if (!cracked) scene.cracks.clear();
        for (CrackSpec& crack : scene.cracks) crack.law.acts = scene.contact.law.acts;
        CHECK(has(scene, "interface_J") == (cohesive && (active || cracked)));
        CHECK(has(scene, "interface_stored_J") == (cohesive && (active || cracked)));
      }
}

TEST_CASE("history.csv has the names in its first line and nine digits of each number of a row") {
  const TemporaryFolder folder;
  Scene scene = full_scene(false);
  scene.bodies[1].name = "a, \"b\"";
  HistoryRow row = full_row(3);
  row.kinetic = -1.23456789012e-7;
  row.stored = 1 / 3.0;
  row.friction = 1e300;
  {
    HistoryFile file(folder.path(), scene);
    file.append(row);
    row.step = 1234567890123;
    file.append(row);
    CHECK(file.mark().rows == 2);
    CHECK(file.mark().last_step == 1234567890123);
    CHECK(file.mark().hash == text_hash(read_text(folder.path() / "history.csv")));
  }
  test::check_recorded_text("history.csv", read_text(folder.path() / "history.csv"));
}

}  // namespace
