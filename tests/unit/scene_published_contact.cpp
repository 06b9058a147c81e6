// Presets of published contact methods: `contact: {as: N20}`.

#include <doctest/doctest.h>

#include <string>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

Scene with_contact(const std::string& keys) {
  return parse(plain_scene() + "contact: {friction: 0.2, " + keys + "}\n");
}

/// All keys that a published method decides, spelt out.
std::string spelt(const std::string& normal, const std::string& separation) {
  return "normal: " + normal + ", separation: " + separation +
         ", position_offset: 0.8, piecewise_particles: 2, detection: both, penalty: 1e-7, offset_penalty: 0, "
         "tolerance: 1e-5, max_iterations: 15, warm_start: false, refit: 0, rigid_bias: 0, "
         "advance_separation: false, persistent: false, hysteresis: 0, corrections: 2, "
         "first_correction_share: 0, fields: lump";
}

struct Preset {
  const char *name, *normal, *separation;
};
constexpr Preset kPresets[] = {{"N20", "logistic_regression", "ellipsoid"},
                               {"DF", "average_gradient", "position_power"},
                               {"CP", "average_gradient", "position_offset"}};

}  // namespace

TEST_CASE("a published contact method is the same scene as its keys spelt out") {
  for (const Preset& preset : kPresets) {
    CAPTURE(preset.name);
    const Scene named = with_contact(std::string("as: ") + preset.name);
    CHECK(named.resolved_yaml == with_contact(spelt(preset.normal, preset.separation)).resolved_yaml);
    CHECK(named.method.strain == StrainKind::average);
    CHECK_FALSE(holds(named.resolved_yaml, " as:"));
    CHECK(parse(named.resolved_yaml).resolved_yaml == named.resolved_yaml);
    CHECK(named.resolved_yaml != with_contact("law: coulomb").resolved_yaml);
  }
}

TEST_CASE("keys beside a published contact method override it and leave its other keys") {
  const ContactSpec n20 = with_contact("as: N20, separation: displacement, persistent: true").contact;
  CHECK(n20.normal == NormalKind::logistic_regression);
  CHECK(n20.separation == SeparationKind::displacement);
  CHECK(n20.persistent);
  CHECK_FALSE(n20.warm_start);
  CHECK(n20.fields == ManyFields::lump);
  CHECK(n20.law.friction == 0.2);
  // The defaults of another normal do not come back with it.
  const ContactSpec cp = with_contact("as: CP, normal: smoothed_max_margin").contact;
  CHECK(cp.normal == NormalKind::smoothed_max_margin);
  CHECK(cp.separation == SeparationKind::position_offset);
  CHECK_FALSE(cp.persistent);
  const ContactSpec fitted = with_contact("as: N20, normal: average_gradient").contact;
  CHECK(fitted.separation == SeparationKind::ellipsoid);
  CHECK(with_contact("normal: max_gradient, as: DF").resolved_yaml ==
        with_contact("as: DF, normal: max_gradient").resolved_yaml);
}

TEST_CASE("a published contact method can be set from outside the scene") {
  const auto set = [](const std::vector<Override>& overrides) {
    return parse_scene(plain_scene() + "contact: {friction: 0.2}\n", "scene.yaml", overrides).resolved_yaml;
  };
  CHECK(set({{"contact.as", "DF"}}) == with_contact("as: DF").resolved_yaml);
}

TEST_CASE("a word that is no published contact method is refused at its place") {
  CHECK(fault(plain_scene() + "contact: {as: n20}\n") ==
        "scene.yaml:8:15: contact.as: not known here (one of N20, DF, CP), got 'n20'. Did you mean 'N20'?");
  CHECK(holds(fault(plain_scene() + "contact: {as: [CP]}\n"), "scene.yaml:8:15: contact.as: not known here"));
  CHECK(holds(fault(plain_scene() + "contact: {As: CP}\n"), "contact.As: unknown key"));
  CHECK(holds(fault(plain_scene() + "contact: {As: CP}\n"), "Did you mean 'as'?"));
}
