#include <doctest/doctest.h>

#include "tests/unit/study_fixture.hpp"
#include "tools/study/study_units.hpp"

using namespace study_test;

namespace {

StudyRuns runs_with(const StudyFolder& folder, const std::string& set) {
  return expand_study(folder.study("scene: scene.yaml\nvariants: [{name: a}, {name: b, set: {" + set +
                                   "}}]\nquantities: {speed: block.vy}\n"));
}

ErrorSpec spec_of(const StudyFolder& folder, const std::string& error) {
  return *folder.study("scene: scene.yaml\nvariants: [{name: a}]\nerror: {" + error + "}\n").error;
}

}  // namespace

TEST_CASE("a study's units are those of a metre where all of its scenes are, and none where some are") {
  const StudyFolder folder;
  const StudyRuns planes = runs_with(folder, "time.cfl: 0.3"), mixed = runs_with(folder, "thickness: 2 mm");
  const auto kinetic = std::get<Expression>(Expression::parse("kinetic_J"));
  CHECK(shown_unit(planes, "N") == "N/m");
  CHECK(shown_unit(mixed, "N").empty());
  CHECK(shown_unit(mixed, "Pa") == "Pa");
  CHECK(axis_label(planes, kinetic) == "kinetic (J/m)");
  CHECK(axis_label(mixed, kinetic) == "kinetic");
  CHECK(axis_label(planes, std::get<Expression>(Expression::parse("2 * time_s"))) == "2 * time_s");
}

TEST_CASE("what is compared has the unit of its quantity, a crossing that of its place") {
  const StudyFolder folder;
  const StudyRuns runs = runs_with(folder, "time.cfl: 0.3");
  const auto unit = [&](const std::string& error) { return measured_unit(runs, spec_of(folder, error)); };
  CHECK(unit("quantity: kinetic_J, compare: final, expected: 1") == "J/m");
  CHECK(unit("quantity: kinetic_J, compare: crossing, above: 1, expected: 1") == "s");
  CHECK(unit("quantity: kinetic_J, x: block.y_m, compare: crossing, above: 1, expected: 1") == "m");
  CHECK(unit("quantity: 2 * kinetic_J, compare: final, expected: 1").empty());
}
