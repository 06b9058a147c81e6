// What the reader says of contact at the surface.

#include <doctest/doctest.h>

#include <string>

#include "engine/plan/plan.hpp"
#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

std::string with_contact(const std::string& keys) {
  return plain_scene() + "  - {name: lid, box: {from: [1 mm, 3 mm], to: [4 mm, 5 mm]}, material: steel}\n" +
         "contact: {family: surface, " + keys + "}\n";
}

}  // namespace

TEST_CASE("contact at the surface takes dry laws, and its plan says so") {
  for (const char* law : {"law: frictionless", "law: coulomb, friction: 0.3", "law: stick",
                          "law: frictionless, pairs: [{between: [block, lid], law: ignore}]"}) {
    CAPTURE(law);
    const Scene scene = parse(with_contact(law));
    CHECK(scene.contact.family == ContactFamily::surface);
    const Plan plan = make_plan(scene);
    CHECK(plan.surface);
    CHECK(plan.contact);
    CHECK(plan.one_set);
    CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
  }
  CHECK_FALSE(make_plan(parse(plain_scene())).surface);
}

TEST_CASE("what contact at the surface does not know is refused at its key, with what to say instead") {
  for (const char* law : {"law: perfect", "law: adhesion, normal_strength: 1 MPa, shear_strength: 1 MPa",
                          "law: frictionless, pairs: [{between: [block, lid], law: perfect}]"}) {
    CAPTURE(law);
    const std::string said = fault(with_contact(law));
    CHECK(holds(said, "scene.yaml:9:"));
    CHECK(holds(said, "contact.family: contact at the surface knows the laws coulomb, frictionless, stick"));
    CHECK(holds(said, "family: nodes"));
  }
  for (const char* keys : {"persistent: false", "corrections: 1", "detection: velocity"}) {
    CAPTURE(keys);
    CHECK(holds(fault(with_contact(keys)), "decides once a step what touches"));
  }
  for (const char* keys : {"refit: 0.3", "separation: position_offset", "fields: lump"}) {
    CAPTURE(keys);
    CHECK(holds(fault(with_contact(keys)), "finds its points from the particles of each pair in every step"));
  }
  CHECK(holds(fault(with_contact("law: frictionless") + "method: {strain: first}\n"),
              "decides once a step what touches"));
}
