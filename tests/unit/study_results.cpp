#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "engine/errors.hpp"
#include "engine/output/output.hpp"
#include "tests/unit/study_fixture.hpp"
#include "tools/study/other_program.hpp"
#include "tools/study/report.hpp"
#include "tools/study/run_study.hpp"

using namespace study_test;

namespace {

/// What a run with 16 particles and 10 steps leaves behind; the speed of the block ends at `vy`.
void leave_run(const std::filesystem::path& folder, const StudyRun& run, const std::string& status,
               double wall, double vy, const std::string& commit = program_identity().git) {
  const ProgramIdentity program = program_identity();
  write_text(folder / run.folder / "scene.yaml", run.scene.resolved_yaml);
  write_text(folder / run.folder / "history.csv", fmt::format("time_s,block.vy\n0,0\n1e-5,{}\n", vy));
  write_text(
      folder / run.folder / "run.json",
      fmt::format("{{\"version\": \"{}\", \"git\": \"{}\", \"compiler\": \"{}\", \"flags\": \"{}\", "
                  "\"status\": \"{}\","
                  "\"reason\": \"{}\", \"particles\": 16, \"steps\": 10, \"wall_s\": {}, \"threads\": 2,"
                  "\"particle_steps_per_s\": 800, \"energy_error\": 0.25}}",
                  program.version, commit, program.compiler, program.flags, status,
                  status == "failed" ? "it fell | out" : "", wall));
}

const std::string kStudy =
    "scene: scene.yaml\n"
    "variants: [{name: a}, {name: \"b, |\"}, {name: c}, {name: d}, {name: e}]\n"
    "error: {quantity: block.vy, compare: final, expected: -10}\n"
    "more: {by itself: {relative: \"no\"}}\n";

}  // namespace

TEST_CASE("results are the errors and costs of the runs that have ended; the front is of the finished") {
  const StudyFolder folder;
  const auto out = folder.path() / "out";
  const Study study = folder.study(kStudy);
  const StudyRuns runs = expand_study(study);
  leave_run(out, runs.variants[0], "finished", 2, -11);
  leave_run(out, runs.variants[1], "finished", 1, -15);
  leave_run(out, runs.variants[2], "finished", 3, -8);
  leave_run(out, runs.variants[3], "failed", 0.5, -10);
  leave_run(out, runs.variants[4], "stopped", 0.5, -10);
  const StudyResults results = collect_results(study, runs, out);
  const double errors[] = {0.1, 0.5, 0.2, 0};
  const bool front[] = {true, true, false, false};
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    const StudyResult& result = results.variants[k];
    CHECK(result.errors.at(0) == doctest::Approx(errors[k]));
    CHECK(result.errors.at(1) == doctest::Approx(10 * errors[k]));
    CHECK(result.particle_steps == 160);
    CHECK(result.reached == 1e-5);
    CHECK(result.pareto == front[k]);
  }
  CHECK(results.variants[3].status == "failed");
  CHECK(results.variants[4].status.empty());
  CHECK(results.machine.threads == 2);
  CHECK(study_csv(study, runs, results) ==
        "variant,error,particle_steps,wall_s,particle_steps_per_s,pareto,variants,status,value,reached,"
        "mean_iterations,fallbacks,unconverged,energy_error,reason,by itself\n"
        "a,0.1,160,2,800,1,a,finished,-11,1e-05,0,0,0,0.25,,1\n"
        "\"b, |\",0.5,160,1,800,1,\"b, |\",finished,-15,1e-05,0,0,0,0.25,,5\n"
        "c,0.2,160,3,800,0,c,finished,-8,1e-05,0,0,0,0.25,,2\n"
        "d,0,160,0.5,800,0,d,failed,-10,1e-05,0,0,0,0.25,it fell | out,0\n");
  const std::string table = study_table(study, runs, results);
  CHECK(table.rfind("| variant | by itself (m/s) | error (%) | value (m/s) | reached (µs) | wall time (s) | "
                    "speed (million particle-steps/s) | iterations a regression | doubtful normals (%) | "
                    "energy error (%) | front |\n|---|",
                    0) == 0);
  CHECK(table.find("\n| b, \\| | 5 | 50.00 | -15 | 10 | 1.00 | 0.0008 | 0.00 | 0 | 25 | yes |\n") !=
        std::string::npos);
  CHECK(table.find("| 0 | 0 | -10 | 10, failed |") != std::string::npos);
  CHECK(table.find("\nd failed: it fell \\| out\n") != std::string::npos);
}

TEST_CASE("an earlier run counts only with the same scene, by the same program, with the threads asked for") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(folder.study(kStudy));
  const StudyRun& run = runs.variants[0];
  const auto note = [&](int threads = 0) { return earlier_run(run, folder.path(), threads).note; };
  const auto ended = [&](int threads = 0) { return earlier_run(run, folder.path(), threads).ended; };
  CHECK((!ended() && note() == ""));
  leave_run(folder.path(), run, "finished", 1, 0);
  CHECK((ended() && ended(2) && note() == "finished, 1.00 s"));
  CHECK((!ended(1) && note(1) == "the threads were others"));
  leave_run(folder.path(), run, "failed", 1, 0);
  CHECK((ended() && note() == "failed: it fell | out"));
  leave_run(folder.path(), run, "finished", 1, 0, "0ther");
  CHECK((!ended() && note() == "the program's git was 0ther"));
  leave_run(folder.path(), run, "finished", 1, 0);
  write_text(folder.path() / run.folder / "scene.yaml", run.scene.resolved_yaml + "# another\n");
  CHECK((!ended() && note() == "the scene was another"));
  leave_run(folder.path(), run, "stopped", 1, 0);
  CHECK((!ended() && note() == "it was stopped before"));
  write_text(folder.path() / run.folder / "run.json", "{\"status\": \"fini");
  CHECK((!ended() && note() == ""));
}

TEST_CASE("an earlier run counts only with the history that it wrote, and if no file or program ended it") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(folder.study(kStudy));
  const StudyRun& run = runs.variants[0];
  const auto history = folder.path() / run.folder / "history.csv",
             json = folder.path() / run.folder / "run.json";
  const auto now = [&] { return earlier_run(run, folder.path(), 0); };
  const auto leave = [&](const std::string& more, const std::string& status = "finished") {
    leave_run(folder.path(), run, status, 1, -10);
    std::string summary = output_test::read_text(json);
    write_text(json, summary.replace(summary.rfind('}'), 1, more + "}"));
  };
  const std::string rows = "step,time_s,block.vy\n0,0,0\n10,1e-5,-10\n";
  const std::string hash = fmt::format(", \"history\": {{\"rows\": 2, \"hash\": \"{}\"}}", text_hash(rows));
  leave(hash);
  CHECK((!now().ended && now().note == "its history is not the one that it wrote"));
  write_text(history, rows);
  CHECK(now().ended);
  for (std::size_t at = 0; at < rows.size(); ++at) {  // edited or cut anywhere
    std::string edited = rows;
    edited[at] ^= 1;
    write_text(history, edited);
    CHECK_FALSE(now().ended);
    write_text(history, rows.substr(0, at));
    CHECK_FALSE(now().ended);
  }
  std::filesystem::remove(history);
  CHECK((!now().ended && now().note == "its history is gone"));
  // Of a program that tells no hash: rows, up to the last step.
  leave("");
  write_text(history, rows);
  CHECK(now().ended);
  for (const char* cut :
       {"", "step,time_s,block.vy\n", "step,time_s,block.vy\n0,0,0\n", "step,time_s\n1\n"}) {
    write_text(history, cut);
    CHECK_FALSE(now().ended);
  }
  leave(", \"failed_by\": \"physics\"", "failed");
  CHECK(now().ended);
  leave(", \"failed_by\": \"files\"", "failed");
  CHECK((!now().ended && now().stopped && now().unwritten));
  leave(", \"failed_by\": \"program\"", "failed");
  CHECK((!now().ended && !now().stopped));
  for (const char* summary : {"{\"status\": 5}", "{\"status\": \"finished\", \"version\": {}}", "[]", "7"}) {
    write_text(json, summary);
    CHECK_FALSE(now().ended);
  }
}

TEST_CASE("a study started again runs what has not ended; by force, everything") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\nset: {output.frames: 0}\n"
      "variants: [{name: a}, {name: b}, {name: falls, set: {\"bodies.0.velocity\": [0, -200 m/s], "
      "\"time.end\": 1 ms}}]\n"
      "error: {quantity: block.vy, compare: final, expected: 0}\n");
  const StudyRuns runs = expand_study(study);
  StudyOptions options;
  options.folder = folder.path() / "out";
  std::vector<std::string> notes;
  options.ended = [&](const StudyRun& run, const std::string& note) {
    notes.push_back(run.name + " " + note);
  };
  StudyProgress progress = run_study(runs, options);
  CHECK((progress.ran == 3 && progress.kept == 0 && !progress.stopped));
  CHECK(notes.at(2).find("falls failed: step ") == 0);
  const StudyResults results = collect_results(study, runs, options.folder);
  CHECK(results.variants[2].status == "failed");
  CHECK(results.variants[2].reason.find("left the grid") != std::string::npos);
  leave_run(options.folder, runs.variants[1], "stopped", 1, 0);
  notes.clear();
  progress = run_study(runs, options);
  CHECK((progress.ran == 1 && progress.kept == 2));
  CHECK(notes.at(0).find("a kept: finished, ") == 0);
  CHECK(notes.at(1).find("(again: it was stopped before)") != std::string::npos);
  CHECK(notes.at(2).find("falls kept: failed: step ") == 0);
  options.force = true;
  progress = run_study(runs, options);
  CHECK((progress.ran == 3 && progress.kept == 0));
  const int stop = 2;
  options.stop_signal = &stop;
  progress = run_study(runs, options);
  CHECK((progress.stopped && progress.ran == 0));  // none is begun after a signal
}

TEST_CASE("another program can run a variant; its run counts until the program changes") {
  namespace fs = std::filesystem;
  const StudyFolder folder;
  const auto make_program = [&](const std::string& ending) {
    write_text(folder.path() / "other",
               "#!/bin/sh\nmkdir -p \"$4\"\necho '{\"status\": \"finished\"}' > "
               "\"$4/run.json\"\nprintf '%s\\n' time_s,block.vy 0,0 > \"$4/history.csv\"\n"
               "echo \"$@\" > \"$4/words\"\nexit " +
                   ending + "\n");
    fs::permissions(folder.path() / "other", fs::perms::owner_all);
  };
  const auto text = [](const fs::path& file) {
    std::ifstream stream(file);
    return std::string{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  };
  const std::string study =
      "scene: scene.yaml\nvariants: [{name: a, program: other}]\n"
      "error: {quantity: block.vy, compare: final, expected: 0}\n";
  CHECK_THROWS_WITH_AS(check_programs(folder.study(study)),
                       doctest::Contains("variants.0.program: no program '"), SceneError);
  make_program("0");
  CHECK_NOTHROW(check_programs(folder.study(study)));
  const StudyRuns runs = expand_study(folder.study(study));
  StudyOptions options;
  options.folder = folder.path() / "out";
  options.threads = 1;
  fs::create_directories(options.folder);
  CHECK(run_study(runs, options).ran == 1);
  CHECK(text(options.folder / "a" / "words") ==
        fmt::format("run {0}/a.yaml --out {0}/a --force --progress none --threads 1\n",
                    options.folder.string()));
  CHECK(text(options.folder / "a.yaml").find(runs.variants[0].scene.resolved_yaml) != std::string::npos);
  CHECK(earlier_run(runs.variants[0], options.folder, 0).ended);
  make_program("143");
  CHECK(earlier_run(runs.variants[0], options.folder, 0).note == "the scene or the program was another");
  CHECK(run_study(runs, options).stopped);
  make_program("9");
  CHECK_THROWS_WITH_AS(run_study(runs, options), doctest::Contains("ended with exit status 9"), FileError);
}

TEST_CASE("a variant is measured against the run of its reference") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\n"
      "vary: {method.update: [flip, pic]}\n"
      "reference: {set: {contact: none}, per: [method.update]}\n"
      "error: {quantity: -block.vy, compare: max}\n");
  const StudyRuns runs = expand_study(study);
  const double reference[] = {-4, -5}, variant[] = {-5, -4};
  for (std::size_t k = 0; k < 2; ++k) leave_run(folder.path(), runs.variants[k], "finished", 1, variant[k]);
  CHECK(collect_results(study, runs, folder.path()).variants[0].errors.empty());  // its reference has not run
  for (std::size_t k = 0; k < 2; ++k)
    leave_run(folder.path(), runs.references[k], "finished", 1, reference[k]);
  const StudyResults results = collect_results(study, runs, folder.path());
  CHECK(results.variants[0].errors.at(0) == doctest::Approx(0.25));
  CHECK(results.variants[1].errors.at(0) == doctest::Approx(0.2));
}

TEST_CASE("quantities without an error make a plain table: no front and no chart of cost") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\n"
      "vary: {time.cfl: [0.1, 0.2]}\n"
      "quantities:\n"
      "  speed: -block.vy\n"
      "  largest: {quantity: block.vy, over: max}\n"
      "  smallest: {quantity: block.vy, over: min}\n"
      "  mean: {quantity: block.vy * 2, over: mean}\n");
  const StudyRuns runs = expand_study(study);
  for (const StudyRun& run : runs.variants) leave_run(folder.path(), run, "finished", 1, -3);
  const StudyResults results = collect_results(study, runs, folder.path());
  CHECK(results.variants[0].quantities == std::vector<double>{3, 0, -3, -3});
  CHECK(study_csv(study, runs, results)
            .find(",reason,speed,largest,smallest,mean\ncfl=0.1,,160,1,800,0,0.1,") != std::string::npos);
  const std::string table = study_table(study, runs, results);
  CHECK(table.rfind("| time.cfl | speed (m/s) | largest (m/s) | smallest (m/s) | mean | reached (µs) |", 0) ==
        0);
  CHECK(table.find("| 0.2 | 3 | 0 | -3 | -3 | 10 |") != std::string::npos);
  CHECK(table.find("front") == std::string::npos);
  CHECK(write_report(study, runs, results, folder.path()).empty());
  CHECK_FALSE(std::filesystem::exists(folder.path() / "study.gp"));
}

TEST_CASE("quantities stand beside the error where there is one") {
  const StudyFolder folder;
  const Study study = folder.study(kStudy + "quantities: {speed: block.vy / 2}\n");
  const StudyRuns runs = expand_study(study);
  leave_run(folder.path(), runs.variants[0], "finished", 2, -11);
  const StudyResults results = collect_results(study, runs, folder.path());
  CHECK(study_csv(study, runs, results).find(",by itself,speed\na,0.1,") != std::string::npos);
  CHECK(study_csv(study, runs, results).find(",1,-5.5\n") != std::string::npos);
  CHECK(study_table(study, runs, results).find("| a | 1 | 10.00 | -11 | -5.5 |") != std::string::npos);
}

TEST_CASE("a reference may be an expression of the run's own columns or a table beside the study") {
  const StudyFolder folder;
  const std::string head =
      "scene: scene.yaml\nvariants: [{name: a}]\n"
      "error: {quantity: block.vy, compare: max, relative: maximum}\n";
  write_text(folder.path() / "theory.csv", "t_us,v\n0,0\n20,-16\n");
  for (const char* reference : {"{expression: -8e5 * time_s}", "{table: theory.csv, x: t_us * 1e-6, y: v}"}) {
    CAPTURE(reference);
    const Study study = folder.study(head + "reference: " + reference + "\n");
    const StudyRuns runs = expand_study(study);
    leave_run(folder.path(), runs.variants[0], "finished", 1, -10);
    const double scale = study.reference.kind == Reference::Kind::table ? 16 : 8;
    CHECK(collect_results(study, runs, folder.path()).variants[0].errors.at(0) == doctest::Approx(2 / scale));
  }
}

TEST_CASE("a chart of cost joins the cells of a method; points of the front are filled, others open") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\n"
      "vary: {method.update: [flip, pic], grid.cell: [1 mm, 0.5 mm]}\n"
      "error: {quantity: block.vy, compare: final, expected: -10, relative: \"no\"}\n");
  const StudyRuns runs = expand_study(study);
  const double wall[] = {1, 2, 3, 4}, vy[] = {-15, -11, -18, -17};
  for (std::size_t k = 0; k < 4; ++k)
    leave_run(folder.path(), runs.variants[k], k < 3 ? "finished" : "failed", wall[k], vy[k]);
  write_report(study, runs, collect_results(study, runs, folder.path()), folder.path());
  const std::string script = output_test::read_text(folder.path() / "study.gp");
  CHECK(script.find("$method0 << EOD\n1 5\n2 1\nEOD\n") != std::string::npos);
  CHECK(script.find("$method1 << EOD\n3 8\nEOD\n") != std::string::npos);  // the failed one is not joined
  const auto drawn = [&](const std::string& block, const std::string& style) {
    const std::size_t at = script.find("$" + block + " with");
    return script.compare(at + block.size() + 2, style.size(), style) == 0;
  };
  CHECK(script.find("$points0 << EOD\n1 5\nEOD\n") != std::string::npos);
  CHECK(drawn("points0", "with points pt 7"));  // on the front
  CHECK(script.find("$points2 << EOD\n3 8\nEOD\n") != std::string::npos);
  CHECK(drawn("points2", "with points pt 6"));  // beaten
  CHECK(drawn("points3", "with points pt 2"));  // failed
}

TEST_CASE("with panels each case has its own error, its own front and panel, and a row of an overview") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\n"
      "panels: case\n"
      "variants: [{name: a}, {name: b}]\n"
      "vary: {case: {slow: {}, fast: {error: {expected: -100}}, bare: {only: {variants: a}}}}\n"
      "error: {quantity: block.vy, compare: final, expected: -10}\n");
  const StudyRuns runs = expand_study(study);
  REQUIRE(names_of(runs.variants) ==
          std::vector<std::string>{"a, slow", "a, fast", "a, bare", "b, slow", "b, fast"});
  const double wall[] = {1, 20, 1, 2, 10}, vy[] = {-11, -110, -10, -12, -105};
  for (std::size_t k = 0; k < 5; ++k)
    leave_run(folder.path(), runs.variants[k], k == 3 ? "failed" : "finished", wall[k], vy[k]);
  const StudyResults results = collect_results(study, runs, folder.path());
  const double errors[] = {0.1, 0.1, 0, 0.2, 0.05};
  const bool front[] = {true, false, true, false, true};
  for (std::size_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    CHECK(results.variants[k].errors.at(0) == doctest::Approx(errors[k]));
    CHECK(results.variants[k].pareto == front[k]);
  }
  CHECK(study_table(study, runs, results)
            .rfind("| case | a | b |\n|---|---|---|\n"
                   "| slow | **10 %**, 1 s | failed |\n"
                   "| fast | 10 %, 20 s | **5 %**, 10 s |\n"
                   "| bare | **0 %**, 1 s | – |\n\n"
                   "| variant | case | error (%) | reached",  // no column of values that are of other things
                   0) == 0);
  write_report(study, runs, results, folder.path());
  const std::string script = output_test::read_text(folder.path() / "study.gp");
  for (const char* title : {"set title \"slow\"", "set title \"fast\"", "set title \"bare\""})
    CHECK(script.find(title) != std::string::npos);
  CHECK(script.find("$front_1 << EOD\n10 5\nEOD\n") != std::string::npos);
  CHECK(script.find("title \"a\"") != std::string::npos);
  CHECK(script.find("title \"slow\"", script.find("unset logscale")) == std::string::npos);  // has its panel
}

TEST_CASE("a chart of curves shows its window and names a run by what differs") {
  const StudyFolder folder;
  const Study study = folder.study(
      "scene: scene.yaml\n"
      "variants: [{name: a}]\n"
      "vary: {grid.cell: [1 mm, 0.5 mm]}\n"
      "error: {quantity: block.vy, compare: final, expected: 1}\n"
      "curves: [{name: speed, y: 2 * block.vy, window: [1e-6, 1], only: {grid.cell: 0.5 mm}}]\n");
  const StudyRuns runs = expand_study(study);
  for (const StudyRun& run : runs.variants) leave_run(folder.path(), run, "finished", 1, 3);
  write_report(study, runs, collect_results(study, runs, folder.path()), folder.path());
  std::ifstream file(folder.path() / "speed.gp");
  const std::string script{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  CHECK(script.find("$curve0 << EOD\n1e-05 6\nEOD\n") != std::string::npos);  // the row at 0 s is outside
  CHECK(script.find("title \"a\"") != std::string::npos);
  CHECK(script.find("set xlabel \"time (s)\"\nset ylabel \"2 * block.vy\"") != std::string::npos);
  CHECK(script.find("$curve1") == std::string::npos);
}
