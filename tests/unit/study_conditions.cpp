// What must hold in a run, and the maps of where it does.

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "engine/errors.hpp"
#include "tests/unit/study_fixture.hpp"
#include "tools/study/conditions.hpp"
#include "tools/study/report.hpp"
#include "tools/study/run_study.hpp"
#include "tools/study/stability_map.hpp"

using namespace study_test;

namespace {

const std::string kAxes =
    "variants: [{name: flip}, {name: pic, set: {method.update: pic}}]\n"
    "vary:\n"
    "  case: {still: {scene: scene.yaml}, quick: {scene: scene.yaml, set: {\"bodies.0.velocity\": [1 m/s, "
    "0]}, let: {v: 1}}}\n"
    "  time.cfl: [0.2, 0.4]\n";

/// A study with one condition, as written.
Condition condition(const std::string& text) {
  const StudyFolder folder;
  return folder.study(kAxes + "holds: [{name: c, quantity: q, " + text + "}]\n").conditions.at(0);
}

Judgement judged(const std::string& text, std::vector<double> q) {
  std::vector<double> time, other;
  for (std::size_t k = 0; k < q.size(); ++k) {
    time.push_back(static_cast<double>(k));
    other.push_back(k == 0 ? -4 : 2);
  }
  return judge(condition(text), {{"time_s", "q", "p"}, {time, std::move(q), other}}, {{"b", 3}});
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a condition is judged by the worst row; its share says how near the bound is") {
  CHECK(judged("at_most: 2", {0, 1, -5}).holds);
  CHECK(judged("at_most: 2", {0, 1, -5}).value == 1);
  CHECK(judged("at_most: 2", {0, 1, -5}).share == 0.5);
  CHECK_FALSE(judged("at_most: 2", {0, 3, 1}).holds);
  CHECK(judged("at_most: 2", {0, 3, 1}).share == 1.5);
  CHECK(judged("at_least: -2", {0, -1, 5}).share == 0.5);
  CHECK(judged("at_least: 2", {4, 8}).share == 0.5);
  CHECK(judged("at_least: 2", {4, 1}).share == 2);
  CHECK_FALSE(judged("at_least: 2", {4, -1}).holds);
  CHECK(std::isinf(judged("at_least: 2", {4, -1}).share));
  CHECK(judged("at_most: 0", {0, 0}).holds);
  CHECK_FALSE(judged("at_most: 0", {0, 1e-300}).holds);
  CHECK_FALSE(judged("at_least: -1, at_most: b", {0, 3.5}).holds);
  CHECK(judged("at_least: -1, at_most: b", {0, 3}).holds);
}

TEST_CASE("a condition may be on the change, over a scale, in a window, at the end") {
  CHECK(judged("change: true, at_most: 2", {10, 11}).value == 1);
  CHECK(judged("change: true, over: p, at_most: 2", {10, 11}).value == 0.25);
  CHECK(judged("change: true, over: 0 * p, at_most: 2", {10, 10}).value == 0);
  CHECK_FALSE(judged("over: 0 * p, at_most: 2", {10, 10}).holds);
  CHECK(judged("at_end: true, at_most: 2", {10, 1}).holds);
  CHECK(judged("window: [1, 1], at_most: 2", {10, 1, 10}).holds);
  CHECK_FALSE(judged("window: [7, 8], at_most: 2", {1, 1}).holds);
  CHECK_FALSE(judged("at_most: 2", {0, std::nan(""), 0}).holds);
  CHECK_FALSE(judged("at_most: 2", {}).holds);
}

TEST_CASE("conditions and maps: what is wrong is told") {
  const StudyFolder folder;
  const auto only = [&](const std::string& text) {
    const auto faults = folder.faults(kAxes + text);
    REQUIRE(faults.size() == 1);
    return faults.front();
  };
  CHECK(has(only("holds: [{name: c, quantity: block.vy}]\n"), "at_least or at_most was expected"));
  CHECK(has(only("holds: [{quantity: block.vy, at_most: 1}]\n"), "holds.0.name: missing"));
  CHECK(has(only("holds: [{name: c, quantity: block.vyy, at_most: 1}]\n"), "no column of the history"));
  CHECK(has(only("holds: [{name: c, quantity: block.vy, at_most: block.vy}]\n"), "no constant"));
  // v is known where `only` takes the condition.
  CHECK(has(only("holds: [{name: c, quantity: block.vy, at_most: v}]\n"), "no constant (let) 'v'"));
  CHECK(folder.faults(kAxes + "holds: [{name: c, quantity: block.vy, at_most: v, only: {case: quick}}]\n")
            .empty());
  CHECK(has(only("holds: [{name: c, quantity: block.vy, at_most: 1}]\nmap: {panels: case, columns: case}\n"),
            "is the axis of panels"));
  CHECK(has(only("holds: [{name: c, quantity: block.vy, at_most: 1}]\nmap: {panels: case, columns: time.cfl, "
                 "judged: 9}\n"),
            "no such value"));
  CHECK(has(only("more: {x: {relative: \"no\"}}\nholds: [{name: c, quantity: block.vy, at_most: 1}]\n"),
            "error is missing"));
  CHECK(
      has(folder.faults("variants: [{name: a}]\nholds: [{name: c, quantity: block.vy, at_most: 1}]\n").at(0),
          "scene: missing"));
}

TEST_CASE("a study of scenes side by side: what holds where, in the table, the page and the maps") {
  const StudyFolder folder;
  const auto out = folder.path() / "out";
  const Study study = folder.study(kAxes +
                                   "set: {output.checkpoint: none, output.picture: none}\n"
                                   "holds:\n"
                                   "  - {name: moves, quantity: abs(block.vx), at_most: 0.5}\n"
                                   "  - {name: falls, quantity: block.vy, at_least: 0, only: {case: still}}\n"
                                   "map: {panels: case, columns: time.cfl, judged: 0.4}\n");
  const StudyRuns runs = expand_study(study);
  REQUIRE(runs.variants.size() == 8);
  StudyOptions options;
  options.folder = out;
  options.jobs = 3;
  prepare_study_folder(study, out);
  CHECK(run_study(runs, options).ran == 8);
  CHECK(run_study(runs, options).kept == 8);
  const StudyResults results = collect_results(study, runs, out);
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const bool still = runs.variants[k].choice[1] == 0;
    CHECK(holds(results.variants[k]) == still);
    CHECK(results.variants[k].judged[1].has_value() == still);
    CHECK(results.variants[k].errors.at(0) == doctest::Approx(still ? 0.0 : 2.0));
  }
  write_report(study, runs, results, out);
  const std::string page = text_of(out / "study.md");
  CHECK(has(page, "| still | 0.4 | 2 | 2 |"));
  CHECK(has(page, "| quick | none | 0 | 2 |"));
  CHECK(has(page, "| pic | 0.2 | moves 1 |"));
  CHECK(has(text_of(out / "map_quick.gp"), "\"moves\""));
  CHECK(has(text_of(out / "study.csv"), ",holds,moves,falls\n"));
}

TEST_CASE("a folder holds a study when it is absent, empty or a study's, also one that only begins") {
  const StudyFolder folder;
  const auto out = folder.path() / "out";
  const auto put = [&out](const char* name) { std::ofstream(out / name) << "x\n"; };
  CHECK(may_hold_study(out));
  std::filesystem::create_directory(out);
  CHECK(may_hold_study(out));
  put("study.yaml.tmp");  // what another study that begins has there for a moment
  CHECK(may_hold_study(out));
  put("notes.txt");
  CHECK_FALSE(may_hold_study(out));
  put("study.yaml");
  CHECK(may_hold_study(out));
  CHECK_FALSE(may_hold_study(out / "notes.txt"));
}

TEST_CASE("a variant that was stopped goes on from its checkpoint") {
  const StudyFolder folder;
  const auto out = folder.path() / "out";
  const Study study = folder.study(
      "scene: scene.yaml\nvariants: [{name: a}]\n"
      "holds: [{name: c, quantity: block.vy, at_most: 1}]\n");
  const StudyRuns runs = expand_study(study);
  const StudyRun& run = runs.variants.front();
  RunOptions once;
  once.folder = out / "whole";
  const RunSummary whole = run_scene(run.scene, once);
  // A signal that is there from the start stops before the first step, with a checkpoint.
  volatile int signal = 15;
  prepare_study_folder(study, out);
  StudyOptions options;
  options.folder = out;
  options.stop_signal = &signal;
  RunOptions stopped;
  stopped.folder = out / run.folder;
  stopped.stop_signal = &signal;
  CHECK(run_scene(run.scene, stopped).status == "stopped");
  CHECK(earlier_run(run, out, 0).stopped);
  CHECK(run_study(runs, options).ran == 0);
  signal = 0;
  std::string note;
  options.ended = [&](const StudyRun&, const std::string& how) { note = how; };
  CHECK(run_study(runs, options).ran == 1);
  CHECK(has(note, "finished"));
  const std::string json = text_of(out / run.folder / "run.json");
  CHECK(has(json, whole.checksum));
  CHECK(has(json, "\"resumes\": 1"));
}
