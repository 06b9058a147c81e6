// The passes that check tells are those that Step::advance goes through.

#include <algorithm>

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
  for (const char* part :
       {"first contact correction", "second contact correction", "body force",
        "momentum update with the boundaries' reactions", "boundaries' velocities imposed"})
    CHECK(has(walls, part));
}

TEST_CASE("what contact projects to the nodes beside masses is one pass, which names all of it") {
  const auto gradients = passes_of({{"contact", "{normal: average_gradient, separation: displacement}"}});
  CHECK(std::find(gradients.begin(), gradients.end(), "project volume gradients, mean displacements") !=
        gradients.end());
}

}  // namespace
}  // namespace mpmfast
