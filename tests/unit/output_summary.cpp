#include <doctest/doctest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/errors.hpp"
#include "tests/support.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

TEST_CASE_TEMPLATE("the checksum does not depend on the order of the particles, but on every bit of them", D,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
  constexpr int Dim = D::value;
  Particles<Dim> particles = particles_in_order<Dim>(ascending(500));
  const std::string before = checksum(particles);
  CHECK(before.size() == 32);
  CHECK(before.find_first_not_of("0123456789abcdef") == std::string::npos);
  CHECK(checksum(particles_in_order<Dim>(shuffled(500))) == before);
  for (const Quantity q :
       {Quantity::position, Quantity::velocity, Quantity::deformation_gradient, Quantity::kirchhoff_stress}) {
    double& value = particles.column(q, Particles<Dim>::components(q) - 1)[123];
    const double kept = value;
    value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1u);
    CHECK(checksum(particles) != before);
    value = kept;
  }
  particles.body()[7] = 9;
  CHECK(checksum(particles) != before);
}

TEST_CASE("run.json has the keys of the output contract") {
  const TemporaryFolder folder;
  RunSummary summary;
  summary.scene_name = "gap";
  summary.status = "failed";
  summary.reason = "J = 0.03 \xff";  // not UTF-8: a message may quote a file name
  summary.steps = 12;
  summary.dt_max = std::numeric_limits<double>::infinity();
  summary.seconds = {{"project", 1.5}, {"contact", 2.5}};
  summary.contact.regressions = 99;
  summary.overrides = {"time.cfl=0.3"};
  summary.resolved_yaml = "a";
  write_run_json(folder.path(), summary);
  const auto json = nlohmann::json::parse(read_text(folder.path() / "run.json"));
  for (const char* key : {"version",
                          "git",
                          "compiler",
                          "flags",
                          "cpu",
                          "threads",
                          "scene",
                          "status",
                          "reason",
                          "dimension",
                          "particles",
                          "fields",
                          "nodes_active_peak",
                          "steps",
                          "time_s",
                          "dt_min_s",
                          "dt_max_s",
                          "wall_s",
                          "particle_steps_per_s",
                          "peak_memory_bytes",
                          "seconds",
                          "contact",
                          "energy_error",
                          "checksum",
                          "command",
                          "overrides"})
    CHECK_MESSAGE(json.contains(key), key);
  for (const char* key : {"points_peak", "nodes_peak", "regressions", "mean_iterations", "fallbacks",
                          "unconverged", "touching", "doubtful", "meetings", "screened"})
    CHECK_MESSAGE(json["contact"].contains(key), key);
  CHECK(json["status"] == "failed");
  CHECK(json["steps"] == 12);
  CHECK(json["seconds"]["contact"] == 2.5);
  CHECK(json["contact"]["regressions"] == 99);
  CHECK(json["overrides"][0] == "time.cfl=0.3");
  CHECK(json["scene_hash"] == "d24ec4f1a98c6e5b");  // XXH64 of "a", seed 0
  CHECK_FALSE(std::filesystem::exists(folder.path() / "run.json.tmp"));
}

TEST_CASE("run.json states an overlap that was measured, and no other") {
  const TemporaryFolder folder;
  RunSummary summary;
  const auto written = [&] {
    write_run_json(folder.path(), summary);
    return nlohmann::json::parse(read_text(folder.path() / "run.json"));
  };
  CHECK_FALSE(written().contains("overlap_m2"));
  summary.overlap = Overlap{0.25, 0.5, 3};
  CHECK(written()["overlap_m2"] == 0.25);
  CHECK(written()["inside_m2"] == 0.5);
  CHECK(written()["particles_inside"] == 3);
}

TEST_CASE("run.json states what left the grid where a scene lets it, and else nothing") {
  const TemporaryFolder folder;
  RunSummary summary;
  const auto written = [&] {
    write_run_json(folder.path(), summary);
    return nlohmann::json::parse(read_text(folder.path() / "run.json"));
  };
  CHECK_FALSE(written().contains("outflow"));
  summary.outflow = Outflow{3, 0.25, 0.5, {}};
  CHECK(written()["outflow"] == nlohmann::json{{"particles", 3}, {"kg", 0.25}, {"J", 0.5}});
}

TEST_CASE("the peak of memory is that of a living process") {
  CHECK(peak_memory_bytes() > std::uint64_t{1} << 20);
  CHECK(peak_memory_bytes() < std::uint64_t{1} << 42);
}

TEST_CASE("the peak of memory is that of the run, not of what the process did before") {
  const std::size_t much = std::size_t{1} << (test::sanitized() ? 29 : 28);  // the program has less
  {
    // No page is the machine's before it is written to, and a compiler may leave out what nobody reads.
    std::vector<char> filled(much, 'a');
    const volatile char* last = &filled.back();
    REQUIRE(*last == 'a');
  }
  CHECK(peak_memory_bytes() > much);
  reset_peak_memory();
  if (!std::ofstream("/proc/self/clear_refs")) return;  // a system that forgets nothing
  CHECK(peak_memory_bytes() < much);
}

TEST_CASE("the peak of memory is that of this program and not of the one that started it") {
  constexpr const char* kAnswer = "MPMFAST_TEST_ANSWER";
  if (const char* file = std::getenv(kAnswer)) {  // started below
    reset_peak_memory();
    std::ofstream(file) << peak_memory_bytes();
    return;
  }
  if (read_text("/proc/self/status").find("VmHWM:") == std::string::npos) return;  // nobody knows it
  const std::size_t much = std::size_t{1} << (test::sanitized() ? 29 : 26);        // the program has less
  const std::vector<char> filled(much, 'a');
  const volatile char* last = &filled.back();
  REQUIRE(*last == 'a');
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "answer").string();
  std::string name = "unit_tests", only = "-tc=the peak of memory is that of this program and not*",
              silent = "-o=/dev/null";
  char* const words[] = {name.data(), only.data(), silent.data(), nullptr};
  setenv(kAnswer, file.c_str(), 1);
  pid_t child = 0;
  const int reason = posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, words, environ);
  unsetenv(kAnswer);
  REQUIRE(reason == 0);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  std::uint64_t peak = 0;
  std::ifstream(file) >> peak;
  CHECK(peak > std::uint64_t{1} << 20);
  CHECK(peak < much);
}

TEST_CASE(
    "an existing output folder is refused without force, and with it loses an earlier run and nothing else") {
  const TemporaryFolder temporary;
  const auto folder = temporary.path() / "runs/new";
  const Scene scene = small_scene(Space::plane_strain);
  prepare_folder(folder, scene, false);
  CHECK(read_text(folder / "scene.yaml") == scene.resolved_yaml);
  CHECK_THROWS_AS(prepare_folder(folder, scene, false), FileError);

  std::filesystem::create_directory(folder / "particles");
  const std::vector<const char*> ours{"history.csv",
                                      "run.json",
                                      "particles.pvd",
                                      "particles/000012.vtu",
                                      "particles/000013.vtu.tmp",
                                      "picture_first_body.png",
                                      "picture_last_stress_yz.png",
                                      "plot_body.png",
                                      "plot_stress_xx_000012.png",
                                      "plot_energy.svg",
                                      "plot_stress_strain.png",
                                      "plot_columns.pdf",
                                      "report.html"};
  const std::vector<const char*> theirs{"notes.txt",          "mine.png",
                                        "particles/mine.vtu", "plot_thesis.gp",
                                        "plot_energy.gp",     "plot_mine.png",
                                        "plot_energy_2.svg",  "plot_body_12.png",
                                        "picture_body.png",   "picture_last_mine.png",
                                        "picture_mine.png"};
  for (const char* name : ours) std::ofstream(folder / name) << "x";
  for (const char* name : theirs) std::ofstream(folder / name) << "x";
  prepare_folder(folder, scene, true);
  CHECK(std::filesystem::exists(folder / "scene.yaml"));
  for (const char* name : ours) CHECK_MESSAGE(!std::filesystem::exists(folder / name), name);
  for (const char* name : theirs) CHECK_MESSAGE(std::filesystem::exists(folder / name), name);

  const auto file = temporary.path() / "file";
  std::ofstream(file) << "x";
  CHECK_THROWS_AS(prepare_folder(file, scene, true), FileError);
  CHECK_THROWS_AS(prepare_folder(file / "below", scene, true), FileError);
}

TEST_CASE("a run warns of what its figures give reason to doubt, and of nothing else") {
  RunSummary good;
  good.contact.regressions = 10000;
  good.contact.unconverged = 100;
  good.contact.fallbacks = 9000;
  good.contact.touching = 4000;
  good.contact.doubtful = 80;
  good.contact.pair_nodes = 1000;
  good.contact.pair_fallbacks = 50;
  good.contact.meetings = 5000;
  good.contact.screened = 1000;
  good.energy_error = -0.1;
  good.spacing = 1;
  CHECK(run_warnings(good).empty());
  CHECK(run_warnings(RunSummary{}).empty());
  RunSummary doubtful = good;
  doubtful.contact.unconverged = 110;
  doubtful.contact.doubtful = 400;
  doubtful.contact.pair_fallbacks = 60;
  doubtful.contact.screened = 1500;
  doubtful.energy_error = -0.25;
  doubtful.spacing = 1.7;
  doubtful.spacing_body = "bar";
  const auto warnings = run_warnings(doubtful);
  REQUIRE(warnings.size() == 6);
  const char* const said[] = {"1.1 % of the contact normals did not converge",
                              "10 % of the normals of surfaces that touch or overlap fell back",
                              "on 6 % of the nodes",
                              "30 % of the nodes where bodies meet",
                              "particles of body 'bar' came 1.7 cells apart",
                              "the energy balance drifted by -25 %"};
  for (std::size_t k = 0; k < 6; ++k) CHECK(warnings[k].text.find(said[k]) == 0);
  RunSummary few = doubtful;  // too few meetings for a share to mean anything
  few.contact = {};
  few.contact.regressions = few.contact.unconverged = few.contact.touching = few.contact.doubtful =
      kEnoughToJudge - 1;
  CHECK(run_warnings(few).size() == 2);
  const TemporaryFolder folder;
  write_run_json(folder.path(), doubtful);
  CHECK(nlohmann::json::parse(read_text(folder.path() / "run.json"))["warnings"].size() == 6);
}

TEST_CASE("a remedy is nothing that the scene has already") {
  const auto text = [](const RunSummary& summary) {
    const auto warnings = run_warnings(summary);
    REQUIRE(warnings.size() == 1);
    return warnings[0].text;
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  RunSummary grows;
  grows.energy_error = 0.5;
  grows.settings.cfl = 0.3;
  CHECK_FALSE(has(text(grows), "grid_end"));  // the default
  CHECK(has(text(grows), "a time.cfl below 0.3"));
  CHECK(has(text(grows), "xpic(5)"));
  grows.settings.grid_end = false;
  CHECK(has(text(grows), "method.position: grid_end"));
  grows.settings.filtered = true;  // apic cannot take it
  CHECK_FALSE(has(text(grows), "grid_end"));
  CHECK_FALSE(has(text(grows), "xpic"));
  RunSummary shrinks;
  shrinks.energy_error = -0.5;
  CHECK_FALSE(has(text(shrinks), "update"));
  CHECK_FALSE(has(text(shrinks), "average+"));
  shrinks.settings.filtered = true;
  CHECK(has(text(shrinks), "method.update: flip"));
  shrinks.settings.averaged_strain = true;
  CHECK(has(text(shrinks), "method.strain: average+"));
  RunSummary screened;
  screened.contact.meetings = screened.contact.screened = 100000;
  CHECK_FALSE(has(text(screened), "volume_screen"));
  screened.settings.volume_screen = true;
  CHECK_FALSE(has(text(screened), "mass_screen"));
  RunSummary parts;
  parts.spacing = 3;
  CHECK(has(text(parts), "basis: lcpdi, split: {edge: 1.5}"));
  parts.settings.follows_shape = true;
  CHECK_FALSE(has(text(parts), "lcpdi"));
  CHECK(has(text(parts), "method: {split: {edge: 1.5}}"));
  parts.settings.splits = true;
  CHECK_FALSE(has(text(parts), "split"));
  CHECK(has(text(parts), "smaller cells"));
}

TEST_CASE("a run that failed names causes before what follows from them") {
  RunSummary summary;
  summary.scene_warnings = {"warning of the scene"};
  summary.contact.regressions = summary.contact.unconverged = 100000;
  summary.spacing = 3;
  summary.energy_error = 0.5;
  const auto order = [&](std::vector<std::string> parts) {
    const std::vector<std::string> all = all_warnings(summary);
    REQUIRE(all.size() == parts.size());
    for (std::size_t k = 0; k < parts.size(); ++k)
      CHECK_MESSAGE(all[k].find(parts[k]) != std::string::npos, all[k]);
  };
  order({"of the scene", "did not converge", "a body parts there", "energy balance"});
  summary.status = "failed";
  order({"a body parts there", "of the scene", "did not converge", "energy balance"});
  summary.settings.flowing_body = "sand";
  order({"a body parts there", "of the scene", "did not converge", "energy balance"});
  summary.settings.follows_shape = true;
  order({"body 'sand' flows", "a body parts there", "of the scene", "did not converge", "energy balance"});
  const TemporaryFolder folder;
  write_run_json(folder.path(), summary);
  CHECK(nlohmann::json::parse(read_text(folder.path() / "run.json"))["warnings"] == all_warnings(summary));
}

TEST_CASE("grains and fluids leave each other by their law, solids and rigid bodies do not") {
  Scene scene = small_scene(Space::plane_strain);
  const auto flows_as = [&](const MaterialModel& model) {
    scene.materials[0].model = model;
    return flows(scene, scene.bodies[0]);
  };
  CHECK_FALSE(flows_as(NeoHookean{1000, 1e6, 1e5}));
  CHECK_FALSE(flows_as(LinearElastic{1000, 1e6, 0.3}));
  CHECK_FALSE(flows_as(Rigid{}));
  CHECK(flows_as(DruckerPrager{}));
  MieGruneisen water;
  CHECK(flows_as(water));
  water.shear = 1e9;
  CHECK_FALSE(flows_as(water));
}

TEST_CASE("what a warning calls usual is where it begins") {
  using Contact = RunSummary::Contact;
  struct Share {
    std::uint64_t Contact::*part;
    std::uint64_t Contact::*whole;
  };
  constexpr std::uint64_t kWhole = 100000;
  for (const auto [part, whole] :
       {Share{&Contact::unconverged, &Contact::regressions}, Share{&Contact::doubtful, &Contact::touching},
        Share{&Contact::pair_fallbacks, &Contact::pair_nodes},
        Share{&Contact::screened, &Contact::meetings}}) {
    RunSummary summary;
    summary.contact.*whole = summary.contact.*part = kWhole;
    const auto all = run_warnings(summary);
    REQUIRE(all.size() == 1);
    const std::string mark = "(usual: below ";
    const std::size_t at = all[0].text.find(mark);
    REQUIRE(at != std::string::npos);
    const double usual = std::stod(all[0].text.substr(at + mark.size())) / 100;
    REQUIRE(usual < 1);
    summary.contact.*part = static_cast<std::uint64_t>(0.99 * usual * kWhole);
    CHECK(run_warnings(summary).empty());
    summary.contact.*part = static_cast<std::uint64_t>(1.01 * usual * kWhole);
    CHECK(run_warnings(summary).size() == 1);
  }
}

TEST_CASE("a warning of energy has the sign and two digits of the drift, or those before the point") {
  const std::vector<std::pair<double, std::string>> known{
      {0.8, "drifted by +80 %"},    {-0.8, "drifted by -80 %"},    {0.12, "drifted by +12 %"},
      {1.5, "drifted by +150 %"},   {-1.5, "drifted by -150 %"},   {0.994, "drifted by +99 %"},
      {-0.994, "drifted by -99 %"}, {12.34, "drifted by +1234 %"}, {-12.34, "drifted by -1234 %"}};
  for (const auto& [error, said] : known) {
    RunSummary summary;
    summary.energy_error = error;
    const auto warnings = run_warnings(summary);
    REQUIRE(warnings.size() == 1);
    CHECK_MESSAGE(warnings[0].text.find(said) != std::string::npos, warnings[0].text);
  }
}

TEST_CASE("the peak of memory is known where no file of the system's can be opened") {
  rlimit files{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &files) == 0);
  rlimit none = files;
  none.rlim_cur = 0;
  REQUIRE(setrlimit(RLIMIT_NOFILE, &none) == 0);
  const bool closed = !std::ifstream("/proc/self/status");
  const std::uint64_t peak = peak_memory_bytes();
  REQUIRE(setrlimit(RLIMIT_NOFILE, &files) == 0);
  WARN(closed);
  CHECK(peak > std::uint64_t{1} << 20);
  CHECK(peak < std::uint64_t{1} << 42);
}
