#include <doctest/doctest.h>

#include "tests/unit/study_fixture.hpp"

using namespace study_test;

namespace {

using Lines = std::vector<std::string>;

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

}  // namespace

TEST_CASE("several mistakes in a study are all told, each where it stands") {
  const StudyFolder folder;
  const Lines found = folder.faults(
      "scene: nowhere.yaml\n"
      "variants:\n"
      "  - {name: a, sets: {time.cfl: 0.2}}\n"
      "  - {name: a}\n"
      "vary: {method.update: []}\n"
      "error:\n"
      "  quantity: block.vy +\n"
      "  compare: finale\n"
      "  expected: 1\n"
      "eror: 3\n");
  REQUIRE(found.size() == 7);
  CHECK(begins(found[0], "1: scene: no such scene"));
  CHECK(begins(found[1], "3: variants.0.sets: unknown key"));
  CHECK(found[1].find("Did you mean 'set'?") != std::string::npos);
  CHECK(begins(found[2], "4: variants.1: 'a' is given twice"));
  CHECK(begins(found[3], "5: vary.method.update: not a list of values"));
  CHECK(begins(found[4], "7: error.quantity: not an expression: a number or a name was expected at the end"));
  CHECK(begins(found[5], "8: error.compare: "));
  CHECK(found[5].find("Did you mean 'final'?") != std::string::npos);
  CHECK(begins(found[6], "10: eror: unknown key"));
}

TEST_CASE("what the scene refuses is told where the study sets it, once for all runs") {
  const StudyFolder folder;
  const Lines found = folder.faults(
      "scene: scene.yaml\n"
      "set: {time.clf: 0.2}\n"
      "variants: [{name: a}, {name: b}]\n"
      "vary:\n"
      "  method.update: [flip, flop]\n"
      "error: {quantity: block.vy, compare: final, expected: 1}\n");
  REQUIRE(found.size() == 2);
  CHECK(begins(found[0], "2: set.time.clf: the scene says: time.clf: unknown key"));
  CHECK(found[0].find("Did you mean 'cfl'?") != std::string::npos);
  CHECK(begins(found[1], "5: vary.method.update.1: the scene says: method.update: "));
}

TEST_CASE("an expression over a column that no run writes is told before anything runs") {
  const StudyFolder folder;
  const Lines found = folder.faults(
      "scene: scene.yaml\n"
      "variants: [{name: a}, {name: b}]\n"
      "error:\n"
      "  quantity: blok.vy\n"
      "  compare: final\n"
      "  expected: speed\n"
      "curves:\n"
      "  - {name: fall, y: block.y_mm}\n");
  REQUIRE(found.size() == 3);
  CHECK(found[0] == "4: error.quantity: no column of the history 'blok.vy'. Did you mean 'block.vy'?");
  CHECK(begins(found[1], "6: error.expected: no constant (let) 'speed'"));
  CHECK(begins(found[2], "8: curves.0.y: no column of the history 'block.y_mm'"));
}

TEST_CASE("a name that wants backquotes is told once an expression, with them, however many runs there are") {
  const StudyFolder folder;
  const std::string head =
      "scene: scene.yaml\n"
      "set: {bodies.0.name: the-block}\n"
      "variants: [{name: a}, {name: b}]\n"
      "error:\n"
      "  compare: final\n"
      "  expected: 1\n"
      "  quantity: ";
  CHECK(folder.faults(head + "2 * the-block.vy + kinetic_j + the-block.vx\n") ==
        Lines{"7: error.quantity: no column of the history 'the'. Between backquotes it is known: "
              "`the-block.vx`, `the-block.vy`",
              "7: error.quantity: no column of the history 'kinetic_j'. Did you mean 'kinetic_J'?"});
  CHECK(folder.faults(head + "'`the-blokc.vy`'\n") ==
        Lines{"7: error.quantity: no column of the history 'the-blokc.vy'. Did you mean `the-block.vy`?"});
  CHECK(folder.faults(head + "'`the-block.vy` * 2'\n").empty());
}

TEST_CASE("a constant that the reference does not have is told before anything runs") {
  const StudyFolder folder;
  const std::string text =
      "scene: scene.yaml\n"
      "vary: {method.update: [flip, pic], speed: {one: {let: {v: 1}}, two: {let: {v: 2}}}}\n"
      "reference: {set: {contact: none}, per: [method.update]}\n"
      "error: {quantity: block.vy / v, compare: max}\n";
  CHECK(folder.faults(text) ==
        Lines{"4: error.quantity: the reference has no constant 'v': its axis is not in per"});
  std::string good = text;
  good.replace(good.find("per: [method.update]"), 20, "per: [speed]");
  CHECK(folder.faults(good).empty());
}

TEST_CASE("pictures without a name are told, however many there are; a name is taken once") {
  const StudyFolder folder;
  const std::string head =
      "scene: scene.yaml\n"
      "variants: [{name: a}]\n"
      "error: {quantity: block.vy, compare: final, expected: 1}\n"
      "curves:\n";
  const Lines nameless = folder.faults(head + "  - {y: block.vx}\n  - {y: block.vy}\n");
  REQUIRE(nameless.size() == 2);
  CHECK(begins(nameless[0], "5: curves.0"));
  CHECK(begins(nameless[1], "6: curves.1"));
  const Lines twice = folder.faults(head +
                                    "  - {name: v, y: block.vx}\n  - {name: v, y: block.vy}\n"
                                    "  - {name: study, y: block.vy}\n"
                                    "  - {name: study_particle_steps, y: block.vy}\n"
                                    "  - {name: error, y: block.vy}\n");
  REQUIRE(twice.size() == 3);
  CHECK(begins(twice[0], "6: curves.1.name: is taken by another file of the study"));
  CHECK(begins(twice[1], "7: curves.2.name: is taken by another file of the study"));
  CHECK(begins(twice[2], "8: curves.3.name: is taken by another file of the study"));
}

TEST_CASE("an error needs something to compare with") {
  const StudyFolder folder;
  const auto found = [&](const std::string& error) {
    const Lines all = folder.faults("scene: scene.yaml\nvariants: [{name: a}]\nerror: " + error + "\n");
    REQUIRE(all.size() == 1);
    return all[0];
  };
  CHECK(begins(found("{quantity: block.vy, compare: max}"), "3: error: the study's reference is missing"));
  CHECK(begins(found("{quantity: block.vy, compare: final}"), "3: error: expected or the study's reference"));
  CHECK(begins(found("{quantity: block.vy, compare: crossing, expected: 1}"),
               "3: error: a crossing needs above or below"));
  CHECK(begins(found("{quantity: block.vy, compare: crossing, expected: 1, above: 1, below: 2}"),
               "3: error.below: above is given too"));
  CHECK(begins(found("{compare: final, expected: 1}"), "3: error"));
}

TEST_CASE(
    "a study says what it lacks: something to measure, an error for its cost, a column of its quantities") {
  const StudyFolder folder;
  const std::string head = "scene: scene.yaml\nvariants: [{name: a}]\n";
  const Lines nothing = folder.faults(head);
  REQUIRE(nothing.size() == 1);
  CHECK(nothing[0].find("error: missing (a map {quantity, compare, …}; or holds, or quantities)") !=
        std::string::npos);
  CHECK(folder.faults(head + "quantities: {v: block.vy}\ncost: wall_s\n") ==
        Lines{"4: cost: error is missing, which is drawn against the cost"});
  CHECK(folder.faults(head + "quantities: {v: blok.vy}\n") ==
        Lines{"3: quantities.v: no column of the history 'blok.vy'. Did you mean 'block.vy'?"});
  const Lines over = folder.faults(head + "quantities: {v: {quantity: block.vy, over: maxx}}\n");
  REQUIRE(over.size() == 1);
  CHECK(over[0].find("Did you mean 'max'?") != std::string::npos);
}

TEST_CASE("an axis or a value that `only`, `per` or `panels` does not know is told with the known ones") {
  const StudyFolder folder;
  const Lines found = folder.faults(
      "scene: scene.yaml\n"
      "variants: [{name: a, only: {method.update: pick}}]\n"
      "vary: {method.update: [flip, pic]}\n"
      "reference: {set: {contact: none}, per: [method.updat]}\n"
      "error: {quantity: block.vy}\n"
      "curves: [{name: v, y: block.vy, panels: plane}]\n");
  REQUIRE(found.size() == 3);
  CHECK(begins(found[0],
               "2: variants.0.only.method.update: no such value of method.update (one of flip, pic)"));
  CHECK(found[0].find("Did you mean 'pic'?") != std::string::npos);
  CHECK(begins(found[1], "4: reference.per.0: "));
  CHECK(begins(found[2], "6: curves.0.panels: "));
}

TEST_CASE("an error of a case needs one that it differs from, on the same scale") {
  const StudyFolder folder;
  const std::string head = "scene: scene.yaml\nvariants: [{name: a}]\n";
  CHECK(folder.faults(head + "vary: {case: {b: {error: {expected: 1}}}}\nquantities: {v: block.vy}\n") ==
        Lines{"3: vary.case.b.error: the study's own error is missing, from which this one differs"});
  const std::string error = "error: {quantity: block.vy, compare: final, expected: 1}\n";
  CHECK(folder.faults(head + "vary: {case: {b: {error: {relative: \"no\"}}}}\n" + error) ==
        Lines{"3: vary.case.b.error: errors in percent and absolute ones have no common scale"});
  CHECK(folder.faults(head + "vary: {case: {b: {error: {quantity: blok.vy}}}}\n" + error) ==
        Lines{"3: vary.case.b.error.quantity: no column of the history 'blok.vy'. Did you mean 'block.vy'?"});
  // What a case's error asks, its reference must know too.
  write_text(folder.path() / "theory.csv", "time_s,block.vy\n0,0\n20,-16\n");
  CHECK(folder.faults(head + "vary: {case: {b: {error: {quantity: block.vx}}}}\n"
                             "reference: {table: theory.csv}\nerror: {quantity: block.vy}\n") ==
        Lines{"3: vary.case.b.error.quantity: no column of the table 'block.vx'. Did you mean 'block.vy'?"});
  const Lines panels = folder.faults(head + "panels: cases\nvary: {case: {b: {}}}\n" + error);
  REQUIRE(panels.size() == 1);
  CHECK(begins(panels[0], "3: panels: "));
}
