// A run that stops and goes on leaves the files of one that never stopped.

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

#include <omp.h>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support.hpp"
#include "tests/text.hpp"

namespace mpmfast {
namespace {

using namespace test;
namespace fs = std::filesystem;

const char* const kDisks = R"(
space: plane_strain
grid: {size: [12 mm, 8 mm], cell: 0.5 mm}
time: {end: 40 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [3.8 mm, 4 mm], radius: 2 mm}, material: m, velocity: [60 m/s, 5 m/s]}
  - {name: b, disk: {centre: [8 mm, 4.4 mm], radius: 2 mm}, material: m, velocity: [-60 m/s, 0 m/s]}
boundaries: {bottom: wall, left: wall}
contact: {law: coulomb, friction: 0.3, pairs: [{between: [a, b], friction: 0.1}]}
output: {frames: 5, history: 11, overlap: true}
)";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

RunOptions into(const fs::path& folder) {
  RunOptions options;
  options.folder = folder;
  return options;
}

/// run.json without what depends on the clock, the threads and the stops.
nlohmann::json figures(const fs::path& folder) {
  auto json = nlohmann::json::parse(text_of(folder / "run.json"));
  for (const char* key :
       {"wall_s", "particle_steps_per_s", "peak_memory_bytes", "seconds", "threads", "resumes"})
    json.erase(key);
  return json;
}

void check_same_files(const fs::path& a, const fs::path& b) {
  CHECK(figures(a) == figures(b));
  for (const char* name : {"history.csv", "particles.pvd", "scene.yaml", "picture_last_body.png"})
    CHECK_MESSAGE(text_of(a / name) == text_of(b / name), name);
  const auto frames = [](const fs::path& folder) {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(folder / "particles"))
      out[entry.path().filename().string()] = text_of(entry.path());
    return out;
  };
  CHECK(frames(a) == frames(b));
}

template <class F>
std::string complaint(F f) {
  try {
    f();
  } catch (const FileError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("a run that stops after some steps, on any threads, and goes on is the one that never stopped") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  const RunSummary whole = run_scene(scene, into(folder / "whole"));
  REQUIRE(whole.steps > 40);
  for (const std::uint64_t stop : {whole.steps / 2, whole.steps - 1}) {
    const fs::path part = folder / ("part" + std::to_string(stop));
    RunOptions options = into(part);
    options.max_steps = stop;
    options.threads = 1;
    CHECK(run_scene(scene, options).reason == "steps");
    RunOptions next = into(part);
    next.max_steps = stop + 1;
    next.threads = 3;
    if (stop + 1 < whole.steps) CHECK(resume_run(next)->steps == stop + 1);
    const auto resumed = resume_run(into(part));
    REQUIRE(resumed);
    CHECK(resumed->status == "finished");
    CHECK(resumed->reason == "");
    CHECK(resumed->checksum == whole.checksum);
    CHECK(resumed->resumes == (stop + 1 < whole.steps ? 2 : 1));
    check_same_files(part, folder / "whole");
  }
}

/// What a scene seeds, in 2-D or 3-D.
std::string seeding_of(const Scene& scene) {
  if (scene.dimension() == 3) return seeding_hash(Step<3>(scene).state().particles);
  return seeding_hash(Step<2>(scene).state().particles);
}

TEST_CASE("the resolved scene seeds the same particles to the bit, for every scene of configs") {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(test::source_folder() / "configs")) {
    if (entry.path().extension() != ".yaml") continue;
    CAPTURE(entry.path().filename().string());
    const Scene scene = read_scene(entry.path());
    const Scene resolved = parse_scene(scene.resolved_yaml, "/elsewhere/scene.yaml");
    CHECK(resolved.resolved_yaml == scene.resolved_yaml);
    CHECK(seeding_of(resolved) == seeding_of(scene));
    ++scenes;
  }
  CHECK(scenes > 10);
}

TEST_CASE("an image that changed since the run began is noticed") {
  const Folder folder;
  const auto draw = [&](unsigned char corner) {
    std::vector<unsigned char> grey(16, 10);
    grey[10] = 20;
    grey[5] = corner;
    stbi_write_png((folder / "grains.png").c_str(), 4, 4, 1, grey.data(), 4);
  };
  draw(10);
  std::ofstream(folder / "scene.yaml") << R"(
space: plane_strain
grid: {size: [4 mm, 4 mm], cell: 0.5 mm}
time: {end: 2 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{bitmap: grains.png, extent: [4 mm, 4 mm], material: m}]
)";
  RunOptions options = into(folder / "run");
  options.max_steps = 1;
  run_scene(read_scene(folder / "scene.yaml"), options);
  draw(20);
  CHECK(holds(complaint([&] { resume_run(into(folder / "run")); }), "did an image change?"));
  draw(10);
  CHECK(resume_run(into(folder / "run"))->status == "finished");
}

TEST_CASE("what was written after the checkpoint is cut off") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  RunOptions early = into(folder / "early");
  early.max_steps = 17;
  run_scene(scene, early);
  run_scene(scene, into(folder / "whole"));
  // As a kill leaves it: far ahead of its last checkpoint, with a torn row and half of a frame.
  fs::copy(folder / "whole", folder / "killed", fs::copy_options::recursive);
  fs::copy(folder / "early" / "checkpoint.h5", folder / "killed" / "checkpoint.h5",
           fs::copy_options::overwrite_existing);
  fs::remove(folder / "killed" / "run.json");
  std::ofstream(folder / "killed" / "history.csv", std::ios::app) << "99,0.1";
  std::ofstream(folder / "killed" / "particles" / "000006.vtu.tmp") << "x";
  RunOptions options = into(folder / "killed");
  options.until = scene.time.end;  // not the limit of the early one
  CHECK(resume_run(options)->resumes == 1);
  check_same_files(folder / "killed", folder / "whole");
}

TEST_CASE("a signal stops the run after the step, with a checkpoint, also before the first step") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  run_scene(scene, into(folder / "whole"));
  volatile int signal = SIGTERM;
  RunOptions options = into(folder / "stopped");
  options.stop_signal = &signal;
  const RunSummary stopped = run_scene(scene, options);
  CHECK(stopped.status == "stopped");
  CHECK(stopped.steps == 0);
  REQUIRE(resume_run(into(folder / "stopped")));
  check_same_files(folder / "stopped", folder / "whole");
}

TEST_CASE("a program that runs a scene stops it between two steps, with a checkpoint") {
  const Folder folder;
  RunOptions options = into(folder / "stopped");
  int asked = 0;
  options.stop = [&] { return ++asked == 2; };
  const RunSummary stopped = run_scene(
      scene_from(kDisks,
                 {{"time.end", "1 s"}, {"bodies.0.velocity", "[0, 0]"}, {"bodies.1.velocity", "[0, 0]"}}),
      options);
  CHECK(asked == 2);
  CHECK(stopped.status == "stopped");
  CHECK(stopped.reason == "request");
  CHECK(stopped.steps > 0);
  CHECK(stopped.wall > 0);
  options.stop = {};
  options.until = stopped.time * 1.01;
  REQUIRE(resume_run(options));
}

TEST_CASE("a run has the threads that it is given, and the caller as many as before") {
  const Folder folder;
  const int before = omp_get_max_threads();
  RunOptions options = into(folder / "run");
  options.threads = before + 2;
  run_scene(scene_from(kDisks), options);
  CHECK(omp_get_max_threads() == before);
  options.until = 50e-6;
  resume_run(options);
  CHECK(omp_get_max_threads() == before);
}

TEST_CASE("a run that has come to its end is left alone, and goes further where a later one is asked for") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  const RunSummary whole = run_scene(scene, into(folder / "run"));
  const std::string before = text_of(folder / "run" / "run.json");
  CHECK_FALSE(resume_run(into(folder / "run")));
  RunOptions options = into(folder / "run");
  options.until = 0.5 * scene.time.end;
  CHECK_FALSE(resume_run(options));
  CHECK(text_of(folder / "run" / "run.json") == before);
  options.until = 1.25 * scene.time.end;
  const auto further = resume_run(options);
  REQUIRE(further);
  CHECK(further->time == doctest::Approx(options.until));
  CHECK(further->steps > whole.steps);
  const History history = read_history(folder / "run" / "history.csv");
  CHECK(history.at("time_s").size() == 12 + 3);  // marks at 12/11 and 13/11 of the end, and the last row
  CHECK_FALSE(resume_run(into(folder / "run")));
  fs::remove(folder / "run" / "run.json");  // a kill between the last checkpoint and the summary
  CHECK(resume_run(into(folder / "run"))->checksum == further->checksum);
}

TEST_CASE("an end that was asked for holds until it is reached, then the scene's end does") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  RunOptions options = into(folder / "run");
  options.until = 20e-6;
  options.max_steps = 5;
  run_scene(scene, options);
  CHECK(resume_run(into(folder / "run"))->time == doctest::Approx(20e-6));
  CHECK(resume_run(into(folder / "run"))->time == doctest::Approx(40e-6));
  CHECK_FALSE(resume_run(into(folder / "run")));
}

TEST_CASE(
    "a run that was killed at its limit ends there, and a later end that was asked for lifts all limits") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  const fs::path run = folder / "run";
  RunOptions options = into(run);
  options.until = 20e-6;
  run_scene(scene, options);
  fs::remove(run / "run.json");  // a kill between the last checkpoint and the summary
  CHECK(resume_run(into(run))->time == doctest::Approx(20e-6));
  options.until = 30e-6;  // asked for of a run that goes on, and killed there
  resume_run(options);
  fs::remove(run / "run.json");
  CHECK(resume_run(into(run))->time == doctest::Approx(30e-6));
  CHECK(resume_run(into(run))->time == doctest::Approx(40e-6));

  RunOptions stepped = into(folder / "stepped");
  stepped.max_steps = 5;
  run_scene(scene, stepped);
  fs::remove(folder / "stepped" / "run.json");
  CHECK(resume_run(into(folder / "stepped"))->steps == 5);
  fs::remove(folder / "stepped" / "run.json");
  RunOptions later = into(folder / "stepped");
  later.until = 30e-6;
  CHECK(resume_run(later)->time == doctest::Approx(30e-6));
}

TEST_CASE("what a resume was told is kept at once") {
  const Folder folder;
  const Scene scene = scene_from(kDisks);
  RunOptions options = into(folder / "run");
  options.until = 20e-6;
  run_scene(scene, options);
  options.until = 30e-6;
  volatile int signal = SIGTERM;  // before the first step
  options.stop_signal = &signal;
  CHECK(resume_run(options)->status == "stopped");
  CHECK(resume_run(into(folder / "run"))->time == doctest::Approx(30e-6));
}

TEST_CASE("checkpoints come every so many steps, every so often, or never") {
  const Folder folder;
  const auto run_with = [&](const std::string& name, const std::string& checkpoint) {
    const Scene scene = scene_from(
        kDisks,
        {{"output.checkpoint", checkpoint}, {"bodies.0.velocity", "[-900 m/s, 0]"}, {"boundaries", "{}"}});
    CHECK_THROWS_AS(run_scene(scene, into(folder / name)), RunFailure);  // leaves the grid
    return fs::exists(folder / name / "checkpoint.h5");
  };
  CHECK_FALSE(run_with("default", "{every: 10 min}"));
  CHECK(run_with("steps", "{steps: 3}"));
  CHECK(run_with("time", "{every: 1 ns}"));
  CHECK_FALSE(run_with("none", "none"));
  // The last good checkpoint of a failed run goes on, to the same end.
  const std::string history = text_of(folder / "steps" / "history.csv");
  CHECK_THROWS_AS(resume_run(into(folder / "steps")), RunFailure);
  CHECK(text_of(folder / "steps" / "history.csv") == history);
  CHECK(nlohmann::json::parse(text_of(folder / "steps" / "run.json"))["status"] == "failed");

  run_scene(scene_from(kDisks, {{"output.checkpoint", "none"}}), into(folder / "never"));
  CHECK_FALSE(fs::exists(folder / "never" / "checkpoint.h5"));
  CHECK(holds(complaint([&] { resume_run(into(folder / "never")); }), "holds no checkpoint"));
  CHECK(holds(complaint([&] { resume_run(into(folder / "nowhere")); }), "there is no such folder"));
}

TEST_CASE("a run that another build of the program began goes on, with a warning") {
  const Folder folder;
  RunOptions options = into(folder / "run");
  options.max_steps = 3;
  run_scene(scene_from(kDisks), options);
  const fs::path path = folder / "run" / "checkpoint.h5";
  std::string bytes = text_of(path);
  const std::string program = program_text(), seal = "xxh3_128 ";
  bytes[bytes.find(program) + program.size() - 1] = '?';
  const std::string hash = text_hash(bytes.substr(512));
  bytes.replace(bytes.find(seal) + seal.size(), hash.size(), hash);
  std::ofstream(path, std::ios::binary) << bytes;
  std::vector<std::string> warnings;
  RunOptions next = into(folder / "run");
  next.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  next.max_steps = 4;
  CHECK(resume_run(next)->steps == 4);
  REQUIRE(warnings.size() == 1);
  CHECK(holds(warnings[0], "begun by another program, mpmfast "));
}

TEST_CASE("a checkpoint beside another scene, another history or none is refused, and nothing is changed") {
  const Folder folder;
  RunOptions options = into(folder / "run");
  options.max_steps = 12;
  run_scene(scene_from(kDisks), options);
  const auto refused = [&](const char* name, const std::string& content) {
    const std::string before = text_of(folder / "run" / name);
    std::ofstream(folder / "run" / name, std::ios::binary) << content;
    const std::string why = complaint([&] { resume_run(into(folder / "run")); });
    CHECK(fs::exists(folder / "run" / "run.json"));
    CHECK(text_of(folder / "run" / name) == content);
    std::ofstream(folder / "run" / name, std::ios::binary) << before;
    return why;
  };
  std::string scene = text_of(folder / "run" / "scene.yaml"),
              history = text_of(folder / "run" / "history.csv");
  CHECK(holds(refused("scene.yaml", scene.replace(scene.find("friction: 0.3"), 13, "friction: 0.4")),
              "scene.yaml was altered"));
  CHECK(holds(refused("history.csv", history.substr(0, history.size() / 2)), "history.csv is not that of"));
  CHECK(holds(refused("history.csv", "step" + history), "history.csv is not that of"));
  std::string edited = text_of(folder / "run" / "history.csv");
  const std::size_t row = edited.find('\n', edited.find('\n') + 1) + 1;
  edited[edited.find(',', row) + 1] ^=
      1;  // a digit of the second row; the last one came after the checkpoint
  CHECK(holds(refused("history.csv", edited), "history.csv is not that of"));
  // The same steps of the same bodies, which another run made.
  RunOptions other = into(folder / "other");
  other.max_steps = 12;
  run_scene(scene_from(kDisks, {{"bodies.0.velocity", "[61 m/s, 5 m/s]"}}), other);
  CHECK(
      holds(refused("history.csv", text_of(folder / "other" / "history.csv")), "history.csv is not that of"));
  CHECK(holds(refused("checkpoint.h5", "x"), "is none of mpmfast"));
  CHECK_THROWS_AS(
      [&] {
        fs::copy(folder / "run", folder / "mixed", fs::copy_options::recursive);
        fs::copy(folder / "other" / "history.csv", folder / "mixed" / "history.csv",
                 fs::copy_options::overwrite_existing);
        resume_run(into(folder / "mixed"));
      }(),
      CannotResume);
  CHECK(resume_run(into(folder / "run"))->status == "finished");
}

}  // namespace
}  // namespace mpmfast
