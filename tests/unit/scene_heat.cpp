/// What a scene says of heat, and what it is told.

#include <doctest/doctest.h>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

std::string warm_scene() {
  return replaced(plain_scene(), "poisson: 0.3", "poisson: 0.3, heat_capacity: 500 J/kg/K");
}

}  // namespace

TEST_CASE("a scene that wants heat and says no more of it gets the defaults") {
  CHECK_FALSE(parse(warm_scene()).heat.active);
  CHECK_FALSE(parse(warm_scene() + "heat: none\n").heat.active);
  const HeatSpec heat = parse(warm_scene() + "heat: {}\n").heat;
  CHECK(heat.active);
  CHECK(heat.temperature == 293);
  CHECK(heat.filter_order == 2);
  CHECK(heat.filter_every == 1);
  CHECK(heat.conditions.empty());
  const HeatSpec plain = parse(warm_scene() + "heat: {filter: {}}\n").heat;
  CHECK(plain.filter_order == 2);
  CHECK(plain.filter_every == 1);
  CHECK(parse(warm_scene() + "heat: {filter: none}\n").heat.filter_order == 0);
}

TEST_CASE("a face whose heat is wrong by itself is told of that alone") {
  const std::string turned = replaced(warm_scene(), "plane_strain", "axisymmetric");
  const auto left = [&](const std::string& what) {
    return fault(turned + "heat: {boundaries: {left: {" + what + "}}}\n");
  };
  CHECK(left("temperature: 300 K") ==
        "scene.yaml:8:27: heat.boundaries.left: the axis of the scene is no face");
  CHECK(left("temperature: -5 K") ==
        "scene.yaml:8:41: heat.boundaries.left.temperature: not positive, got '-5 K'");
  CHECK(holds(left("flux: 300 K"), "heat.boundaries.left.flux: 'K' is a temperature"));
  CHECK(holds(left("ambient: 300 K"), "needs either temperature, flux, or ambient and coefficient"));
}

TEST_CASE("a picture of what no body has is refused by its name, one of what a body has is taken") {
  const auto picture = [](const std::string& scene, const std::string& what) {
    return faults(scene + "output: {picture: " + what + "}\n");
  };
  using Faults = std::vector<std::string>;
  CHECK(picture(warm_scene(), "temperature") ==
        Faults{"scene.yaml:8:19: output.picture: no body of this scene has a temperature"});
  CHECK(picture(warm_scene(), "plastic_strain") ==
        Faults{"scene.yaml:8:19: output.picture: no body of this scene has a plastic strain"});
  CHECK(picture(warm_scene() + "heat: {}\n", "temperature").empty());
  CHECK(picture(warm_scene() + "heat: {}\n", "plastic_strain").size() == 1);
  const std::string yields = replaced(replaced(plain_scene(), "linear_elastic", "j2_plasticity"),
                                      "poisson: 0.3", "poisson: 0.3, yield: 1 GPa");
  CHECK(picture(yields, "plastic_strain").empty());
  CHECK(picture(yields, "temperature").size() == 1);
}
