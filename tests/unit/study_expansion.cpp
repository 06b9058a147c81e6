#include <doctest/doctest.h>

#include "tests/sanitized.hpp"
#include "tests/source_folder.hpp"
#include "tests/unit/study_fixture.hpp"

using namespace study_test;

namespace {

const std::string kError = "error: {quantity: block.vy, compare: final, expected: 1}\n";

std::vector<std::string> folders_of(const std::vector<StudyRun>& runs) {
  std::vector<std::string> out;
  for (const StudyRun& run : runs) out.push_back(run.folder);
  return out;
}

}  // namespace

TEST_CASE("the runs of a study are the product of its variants and axes, the last turning fastest") {
  const StudyFolder folder;
  const StudyRuns runs =
      expand_study(folder.study("scene: scene.yaml\n"
                                "variants: [{name: slow}, {name: fast}]\n"
                                "vary:\n"
                                "  method.update: [flip, xpic(2)]\n"
                                "  time.cfl: [0.1, 0.2, 0.4]\n" +
                                kError));
  CHECK(runs.references.empty());
  REQUIRE(runs.variants.size() == 12);
  CHECK(runs.variants[0].name == "slow, flip, cfl=0.1");
  CHECK(runs.variants[1].name == "slow, flip, cfl=0.2");
  CHECK(runs.variants[3].name == "slow, xpic(2), cfl=0.1");
  CHECK(runs.variants[11].name == "fast, xpic(2), cfl=0.4");
  CHECK(runs.variants[3].folder == "slow_xpic2_cfl=0.1");
  CHECK(runs.variants[3].choice == std::vector<std::size_t>{0, 1, 0});
}

TEST_CASE("a run's scene holds the common settings, then the variant's, then those of its axes") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(
      folder.study("scene: scene.yaml\n"
                   "set: {time.cfl: 0.1, bodies.0.velocity: [1 m/s, 0]}\n"
                   "variants:\n"
                   "  - {name: as it is}\n"
                   "  - {name: quick, set: {time.cfl: 0.2, \"bodies.0.velocity\": [3 m/s, -4]}}\n"
                   "vary: {size: {small: {}, half: {set: {time.cfl: 0.5}}}}\n" +
                   kError));
  REQUIRE(names_of(runs.variants) ==
          std::vector<std::string>{"as it is, small", "as it is, half", "quick, small", "quick, half"});
  const double expected[] = {0.1, 0.5, 0.2, 0.5};
  for (std::size_t k = 0; k < 4; ++k) CHECK(runs.variants[k].scene.time.cfl == expected[k]);
  CHECK(runs.variants[0].scene.bodies[0].velocity[0] == 1);
  CHECK(runs.variants[3].scene.bodies[0].velocity[1] == -4);
}

TEST_CASE("`only` leaves out the combinations that it does not name") {
  const StudyFolder folder;
  const StudyRuns runs =
      expand_study(folder.study("scene: scene.yaml\n"
                                "variants: [{name: a, only: {method.update: pic}}, {name: b}]\n"
                                "vary: {method.update: [flip, pic]}\n" +
                                kError));
  CHECK(names_of(runs.variants) == std::vector<std::string>{"a, pic", "b, flip", "b, pic"});
}

TEST_CASE("every run has a folder of its own that any file system takes") {
  const StudyFolder folder;
  const StudyRuns runs =
      expand_study(folder.study("scene: scene.yaml\n"
                                "variants: [{name: \"A b\"}, {name: a/b}, {name: a_b}, {name: \"..\"}, "
                                "{name: \"()\"}, {name: \"../up\"}]\n" +
                                kError));
  CHECK(folders_of(runs.variants) ==
        std::vector<std::string>{"a_b", "a_b_2", "a_b_3", "run", "run_2", ".._up"});
}

TEST_CASE(
    "a value that is no word is named with the end of its key, with all of it where two keys end alike") {
  const StudyFolder folder;
  const StudyRuns runs =
      expand_study(folder.study("scene: scene.yaml\n"
                                "vary:\n"
                                "  output.overlap: [true]\n"
                                "  method.strain: [first]\n"
                                "  bodies.0.velocity: [[1 m/s, 0]]\n"
                                "  grid.cell: [1/2 mm]\n"
                                "  speed: {10 m/s: {let: {v: 10}}}\n" +
                                kError));
  CHECK(names_of(runs.variants) ==
        std::vector<std::string>{"overlap=true, first, velocity=[1 m/s, 0], cell=1/2 mm, 10 m/s"});
  const StudyRuns alike =
      expand_study(folder.study("scene: scene.yaml\n"
                                "vary: {materials.rubber.young: [9 MPa], materials.spare.young: [1 MPa]}\n"
                                "set: {materials.spare: {model: linear_elastic, density: 1 g/cm^3, young: 1 "
                                "MPa, poisson: 0.3}}\n" +
                                kError));
  CHECK(folders_of(alike.variants) ==
        std::vector<std::string>{"materials.rubber.young=9_mpa_materials.spare.young=1_mpa"});
}

TEST_CASE("a reference runs once for each value of its own axes, and every variant finds its own") {
  const StudyFolder folder;
  const StudyRuns runs =
      expand_study(folder.study("scene: scene.yaml\n"
                                "variants: [{name: a}, {name: b}]\n"
                                "vary: {method.update: [flip, pic]}\n"
                                "reference: {set: {contact: none}, per: [method.update]}\n"
                                "error: {quantity: block.vy, compare: max}\n"));
  CHECK(names_of(runs.references) == std::vector<std::string>{"reference, flip", "reference, pic"});
  REQUIRE(runs.variants.size() == 4);
  const std::size_t expected[] = {0, 1, 0, 1};
  for (std::size_t k = 0; k < 4; ++k) CHECK(runs.variants[k].reference == expected[k]);
}

TEST_CASE("constants of a variant reach the expressions of the study") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(
      folder.study("scene: scene.yaml\n"
                   "variants: [{name: a, let: {shift: 2 mm}}, {name: b, let: {shift: 3 * 4}}]\n"
                   "error: {quantity: block.vy - shift, compare: final, expected: 2 * shift}\n"));
  CHECK(runs.variants[0].let.at("shift") == doctest::Approx(0.002).epsilon(1e-15));
  CHECK(runs.variants[1].let.at("shift") == 12);
}

TEST_CASE("a study sets the variables of its scene, and its values may name them") {
  const StudyFolder folder;
  write_text(folder.path() / "variable.yaml",
             "variables: {v: 3 m/s}\ntitle: ${v}\n" + output_test::read_text(folder.path() / "scene.yaml"));
  const StudyRuns runs =
      expand_study(folder.study("scene: variable.yaml\n"
                                "vary: {variables.v: [1 m/s, 2 m/s]}\n"
                                "set: {bodies.0.velocity: [\"${-2*v}\", 0]}\n"
                                "error: {quantity: block.vx, compare: final, expected: 0}\n"));
  REQUIRE(runs.variants.size() == 2);
  CHECK(runs.variants[0].scene.bodies[0].velocity[0] == -2);
  CHECK(runs.variants[1].scene.bodies[0].velocity[0] == -4);
  CHECK(folder.faults("scene: variable.yaml\n"
                      "set: {bodies.0.velocity: [\"${-2*w}\", 0]}\n"
                      "variants: [{name: a}]\n"
                      "error: {quantity: block.vx, compare: final, expected: 0}\n") ==
        std::vector<std::string>{
            "2: set.bodies.0.velocity: the scene says: bodies.0.velocity.0: no variable 'w' "
            "(one of v), got '${-2*w}'"});
}

TEST_CASE("the studies that come with the program can be read and expanded" *
          doctest::skip(mpmfast::test::sanitized())) {
  int count = 0;
  for (const char* folder : {"configs/studies", "configs/starters/study"})
    for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      CAPTURE(entry.path().string());
      ++count;
      try {
        CHECK(!expand_study(read_study(entry.path())).variants.empty());
      } catch (const SceneError& error) {
        FAIL_CHECK(error.what());
      }
    }
  CHECK(count >= 7);
}

TEST_CASE(
    "cell size, particles a cell and time step are axes, also where the scene leaves them to the defaults") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(folder.study(
      "scene: scene.yaml\n"
      "vary: {grid.cell: [1 mm, 0.5 mm], bodies.0.particles_per_cell: [2, 3], time.cfl: [0.2, 0.4]}\n"
      "error: {quantity: block.vy, compare: final, expected: 1}\n"));
  REQUIRE(runs.variants.size() == 8);
  CHECK(runs.variants[0].name == "cell=1 mm, particles_per_cell=2, cfl=0.2");
  const Scene& first = runs.variants[0].scene;
  const Scene& last = runs.variants[7].scene;
  CHECK((first.grid.cell == doctest::Approx(1e-3) && last.grid.cell == doctest::Approx(0.5e-3)));
  CHECK((first.time.cfl == 0.2 && last.time.cfl == 0.4));
  CHECK((first.bodies[0].particles_per_cell[0] == 2 && last.bodies[0].particles_per_cell[0] == 3));
}

TEST_CASE("no folder of a run is called like an option, or leaves the study's folder") {
  const StudyFolder folder;
  const StudyRuns runs = expand_study(folder.study(
      "scene: scene.yaml\n"
      "variants: [{name: --wrap=id}, {name: -1}, {name: ..}, {name: \"../a\\nb\"}, {name: study}]\n"
      "quantities: {v: block.vy}\n"));
  std::vector<std::string> folders;
  for (const StudyRun& run : runs.variants) folders.push_back(run.folder);
  CHECK(folders == std::vector<std::string>{"run--wrap=id", "run-1", "run", ".._a_b", "study_2"});
}
