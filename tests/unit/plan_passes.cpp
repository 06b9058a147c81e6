// The tasks of a step: what check lists, what steps come to, and the table of the manual.

#include <algorithm>
#include <fstream>
#include <sstream>

#include "engine/plan/step_table.hpp"
#include "tests/source_folder.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

std::vector<std::string> passes_of(const std::vector<Override>& overrides) {
  return make_plan(scene_file("oblique_impact.yaml", overrides)).passes;
}
bool has(const std::vector<std::string>& passes, const std::string& part) {
  return std::any_of(passes.begin(), passes.end(),
                     [&](const std::string& pass) { return pass.find(part) != std::string::npos; });
}

TEST_CASE("passes follow the strain: first, last or on both sides") {
  const auto first = passes_of({{"method", "{update: flip, strain: first}"}});
  CHECK(has(first, "strain, stress and internal force"));
  CHECK(first.back() == "particle update");
  const auto last = passes_of({{"method", "{update: flip, strain: last}"}});
  CHECK(has(last, "project mass, momentum and internal force"));
  CHECK_FALSE(has(last, "velocities for"));
  CHECK(last.back() == "particle update, strain and stress");
  const auto both = passes_of({{"method", "{update: flip, strain: average}"}});
  CHECK(has(both, "strain, stress and internal force"));
  CHECK(both.back() == "particle update, strain and stress");
  const auto given_back = passes_of({{"method", "{update: flip, strain: average+}"}});
  CHECK(has(given_back, "re-extrapolate new momenta"));
  CHECK(has(given_back, "velocities that move the particles"));
  CHECK_FALSE(has(passes_of({{"method.position", "grid"}}), "velocities that move the particles"));
  CHECK_FALSE(has(both, "re-extrapolate"));
  const auto apic = passes_of({{"method", "{update: apic, strain: last, basis: bspline2}"}});
  CHECK(std::find(apic.begin(), apic.end(), "internal force") != apic.end());
}

TEST_CASE("XPIC and FMPM of order m take m - 1 passes, and only XPIC carries what contact changes") {
  CHECK(has(passes_of({{"method", "{update: xpic(3)}"}}), "XPIC: 2 passes over v* and dv*"));
  CHECK(has(passes_of({{"method", "{update: xpic(3)}"}, {"contact", "none"}}), "XPIC: 2 passes over v*"));
  CHECK(has(passes_of({{"method", "{update: fmpm(2)}"}}), "FMPM: 1 pass over v*"));
  CHECK_FALSE(has(passes_of({{"method", "{update: pic}"}}), "PIC: "));
}

TEST_CASE("contact, boundaries and gravity are passes where there are some") {
  const auto none = passes_of({{"contact", "none"}, {"boundaries", "{}"}});
  for (const char* part : {"contact", "boundaries", "body force", "rigid"}) CHECK_FALSE(has(none, part));
  const auto walls = passes_of({{"boundaries", "{bottom: wall}"}, {"gravity", "[0, -9.81 m/s^2]"}});
  for (const char* part : {"first contact correction", "second contact correction", "body force",
                           "the boundaries' reactions", "boundaries' velocities imposed"})
    CHECK(has(walls, part));
  const auto pressed = passes_of({{"loads", "{pressure: [{body: left, value: 1 kPa}]}"}});
  CHECK(has(pressed, "pressure on surfaces"));
  CHECK_FALSE(has(pressed, "body force"));
}

TEST_CASE("what contact projects to the nodes beside masses is one pass, which names all of it") {
  const auto gradients = passes_of({{"contact", "{normal: average_gradient, separation: displacement}"}});
  CHECK(std::find(gradients.begin(), gradients.end(), "project volume gradients, mean displacements") !=
        gradients.end());
}

/// Steps until every task that is not due now and then has its turn: two.
template <int Dim>
void check_follows_table(const Scene& scene) {
  Step<Dim> step(scene);
  for (int n = 0; n < 2; ++n) {
    advance(step, 1);
    const auto tasks = step.clock().tasks();
    for (std::size_t k = 1; k < tasks.size(); ++k) {
      CAPTURE(row_of(tasks[k - 1]).name);
      CAPTURE(row_of(tasks[k]).name);
      CHECK(tasks[k - 1] < tasks[k]);
    }
    for (const TaskRow& row : step_table()) {
      CAPTURE(row.name);
      const bool needed = !row.said || !row.said(scene, step.plan()).empty();
      const bool entered = std::find(tasks.begin(), tasks.end(), row.task) != tasks.end();
      if (!row.due) CHECK(entered == needed);
      if (row.due) CHECK((needed || !entered));
    }
  }
}
void check_follows_table(const Scene& scene) {
  scene.dimension() == 3 ? check_follows_table<3>(scene) : check_follows_table<2>(scene);
}

TEST_CASE("a row of the table stands at its task") {
  for (std::size_t k = 0; k < step_table().size(); ++k) CHECK(step_table()[k].task == static_cast<Task>(k));
}

TEST_CASE("a step comes to the tasks of the table that its plan needs, in its order") {
  for (const std::vector<Override>& overrides : std::vector<std::vector<Override>>{
           {},
           {{"method", "{update: flip, strain: first}"}},
           {{"method", "{update: flip, strain: last}"}},
           {{"method", "{update: xpic(3), strain: average+, own_filter: true}"}},
           {{"method", "{update: fmpm(2)}"}},
           {{"method", "{update: apic, strain: last, basis: bspline2}"}},
           {{"method", "{basis: lcpdi, split: {edge: 1.5}}"}},
           {{"contact", "none"}, {"boundaries", "{}"}},
           {{"contact.refit", "0.1"}},
           {{"contact.corrections", "1"}},
           {{"boundaries", "{bottom: wall}"}, {"gravity", "[0, -9.81 m/s^2]"}},
           {{"loads", "{pressure: [{body: left, value: 1 kPa}]}"}}}) {
    CAPTURE(overrides.empty() ? std::string("as it is") : overrides[0].first + ": " + overrides[0].second);
    check_follows_table(scene_file("oblique_impact.yaml", overrides));
  }
  for (const char* name : {"rolling_disk.yaml", "crack_wave.yaml", "heat_contact.yaml", "sphere_axis.yaml",
                           "bars_impact.yaml", "cubes.yaml"}) {
    CAPTURE(name);
    check_follows_table(scene_file(name, {}));
  }
  check_follows_table(scene_file(
      "oblique_impact.yaml",
      {{"contact.family", "penalty"}, {"method", "{basis: bspline2, extension: {occupation: 0.6}}"}}));
}

TEST_CASE("the manual shows the table") {
  std::ifstream file(source_folder() / "tools/manual/theory.md");
  std::stringstream text;
  text << file.rdbuf();
  CHECK_MESSAGE(text.str().find(step_table_page()) != std::string::npos, "it would be:\n", step_table_page());
}

}  // namespace
}  // namespace mpmfast
