#include <doctest/doctest.h>

#include <cmath>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

TEST_CASE("a scene that states its physics alone gets the defaults") {
  const Scene scene = parse(plain_scene());
  CHECK(scene.title == "scene");
  CHECK(scene.dimension() == 2);
  CHECK(scene.thickness == 1);
  CHECK(scene.time.cfl == 0.5);
  CHECK(std::isinf(scene.time.max_step));
  CHECK(scene.time.collapse == 1e-3);
  CHECK(scene.grid.outflow == OutflowKind::stop);
  CHECK(scene.method.basis == BasisKind::ugimp);
  CHECK(scene.method.update == UpdateKind::flip);
  CHECK(scene.method.position == PositionKind::grid_end);
  CHECK(scene.contact.active);
  CHECK(scene.contact.normal == NormalKind::smoothed_max_margin);
  CHECK(scene.contact.separation == SeparationKind::ellipsoid);
  CHECK(scene.contact.penalty == 1e-7);
  CHECK(scene.bodies[0].field == "block");
  CHECK(scene.bodies[0].particles_per_cell == std::array<int, 3>{2, 2, 1});
  CHECK(scene.boundaries.empty());
}

TEST_CASE("every update moves particles with the grid unless the scene says otherwise") {
  const auto method = [](const std::string& keys) {
    return parse(plain_scene() + "method: {" + keys + "}\n").method;
  };
  CHECK(method("update: pic").position == PositionKind::grid_end);
  CHECK(method("update: xpic(5)").xpic_order == 5);
  CHECK(method("update: xpic(5)").position == PositionKind::grid_end);
  CHECK(method("update: xpic(20), position: particle").position == PositionKind::particle);
  CHECK(method("update: fmpm(4)").update == UpdateKind::fmpm);
  CHECK(method("update: fmpm(4)").xpic_order == 4);
  CHECK(holds(fault(plain_scene() + "method: {update: fmpm(1)}\n"), "fmpm(1) is pic"));
  CHECK(method("basis: bspline3, update: apic").position == PositionKind::particle);
  CHECK(method("basis: bspline2, update: apic, position: particle").update == UpdateKind::apic);
  for (const char* wrong :
       {"xpic", "xpic(1)", "xpic(21)", "xpic(05)", "xpic()", "xpic(5", "xpic(-2)", "xpic(5) "}) {
    CHECK_MESSAGE(holds(fault(plain_scene() + "method: {update: '" + wrong + "'}\n"), "method.update: "),
                  wrong);
  }
  CHECK(holds(fault(plain_scene() + "method: {position: particle}\n"), "flip moves particles with the grid"));
  for (const char* basis : {"linear", "ugimp", "lcpdi", "qcpdi"})
    CHECK(holds(fault(plain_scene() + "method: {update: apic, basis: " + basis + "}\n"),
                "method.update: apic needs basis: bspline2 or bspline3"));
  CHECK(holds(fault(plain_scene() + "method: {update: apic, basis: bspline2, position: grid}\n"),
              "method.position: apic moves particles with their velocity"));
  CHECK(holds(fault(plain_scene() + "method: {update: apic(2), basis: bspline2}\n"), "method.update: "));
}

TEST_CASE("a step collapses at a share of the first that lies below one, and particles leave in three ways") {
  const auto with = [](const std::string& from, const std::string& to) {
    return replaced(plain_scene(), from, to);
  };
  const auto collapse = [&](const std::string& share) {
    return with("1 us}", "1 us, collapse: " + share + "}");
  };
  CHECK(parse(collapse("0.25")).time.collapse == 0.25);
  CHECK(parse(collapse("0")).time.collapse == 0);
  for (const char* wrong : {"1", "-0.1", "1 us"})
    CHECK_MESSAGE(holds(fault(collapse(wrong)), "time.collapse: "), wrong);
  const auto leaving = [&](const std::string& word) {
    return with("cell: 1 mm}", "cell: 1 mm, leaving: " + word + "}");
  };
  CHECK(parse(leaving("outflow")).grid.outflow == OutflowKind::outflow);
  CHECK(parse(leaving("outflow")).boundaries.empty());
  CHECK(parse(leaving("wall")).boundaries.size() == 4);
  CHECK(parse(replaced(solid_scene(), "cell: 1 mm}", "cell: 1 mm, leaving: wall}")).boundaries.size() == 6);
  CHECK(holds(fault(leaving("walls")), "Did you mean 'wall'"));
}

TEST_CASE("the deformation advances by one term, by two, or by the exponential") {
  const auto terms = [](const std::string& word) {
    return parse(plain_scene() + "method: {deformation_terms: " + word + "}\n").method.deformation_terms;
  };
  CHECK(parse(plain_scene()).method.deformation_terms == 2);
  CHECK(terms("1") == 1);
  CHECK(terms("2") == 2);
  CHECK(terms("exponential") == MethodSpec::kAllTerms);
  for (const char* wrong : {"0", "3", "exponentail", "[1]"})
    CHECK_MESSAGE(holds(fault(plain_scene() + "method: {deformation_terms: " + wrong + "}\n"),
                        "method.deformation_terms: "),
                  wrong);
}

TEST_CASE("the defaults of contact follow the normal") {
  const auto contact = [](const std::string& keys) {
    return parse(plain_scene() + "contact: " + keys + "\n").contact;
  };
  CHECK_FALSE(contact("none").active);
  CHECK(contact("{normal: smoothed_logistic_regression}").penalty == 1e-7);
  CHECK(contact("{normal: smoothed_logistic_regression}").persistent);
  CHECK(contact("{normal: smoothed_logistic_regression}").fields == ManyFields::simultaneous);
  CHECK(contact("{normal: smoothed_logistic_regression}").warm_start);
  CHECK(contact("{law: stick}").warm_start);
  CHECK(contact("{normal: max_margin}").persistent);
  for (const char* published : {"logistic_regression", "logistic_irls", "average_gradient"}) {
    const ContactSpec spec = contact(std::string("{normal: ") + published + "}");
    CHECK_FALSE(spec.warm_start);
    CHECK_FALSE(spec.persistent);
    CHECK_FALSE(spec.advance_separation);
    CHECK(spec.fields == ManyFields::lump);
  }
  CHECK(contact("{normal: smoothed_logistic_regression}").advance_separation);
  CHECK(contact("{normal: smoothed_logistic_regression, penalty: 0.5}").penalty == 0.5);
  CHECK(contact("{normal: average_gradient}").separation == SeparationKind::position_offset);
  CHECK(contact("{normal: average_gradient, separation: ellipsoid}").separation == SeparationKind::ellipsoid);
  CHECK(contact("{normal: specified, specified_normal: [0, 4]}").specified_normal == Vec3{0, 1, 0});
  CHECK(holds(fault(plain_scene() + "contact: {normal: specified}\n"), "contact.specified_normal: missing"));
  CHECK(holds(fault(plain_scene() + "contact: {friction: -0.1}\n"), "must be zero or more"));
  for (const char* normal : {"max_gradient", "max_volume", "own_gradient"})
    CHECK(contact(std::string("{normal: ") + normal + "}").separation == SeparationKind::position_offset);
  CHECK(contact("{separation: position_piecewise, piecewise_particles: 1}").piecewise_particles == 1);
  CHECK(contact("{detection: velocity}").detection == DetectionKind::velocity);
  CHECK(contact("{tolerance: 1e-7, max_iterations: 40, offset_penalty: 5e-4}").max_iterations == 40);
  CHECK(holds(fault(plain_scene() + "contact: {piecewise_particles: 3}\n"), "contact.piecewise_particles"));
  CHECK(holds(fault(plain_scene() + "contact: {tolerance: 0}\n"), "contact.tolerance"));
  CHECK(holds(fault(plain_scene() + "contact: {detection: either}\n"), "contact.detection"));
}

TEST_CASE("elastic constants convert: E = 9KG/(3K + G), and both pairs at once are an error") {
  const std::string neo = replaced(plain_scene(), "linear_elastic", "neo_hookean");
  const auto model = std::get<NeoHookean>(parse(neo).materials[0].model);
  CHECK(9 * model.bulk * model.shear / (3 * model.bulk + model.shear) ==
        doctest::Approx(210e9).epsilon(1e-12));
  CHECK(model.bulk == doctest::Approx(175e9).epsilon(1e-12));
  CHECK(holds(fault(replaced(neo, "poisson", "bulk: 1 GPa, poisson")),
              "needs either bulk and shear or young and poisson"));
}

TEST_CASE("the grid is a whole number of cells") {
  CHECK(faults(replaced(plain_scene(), "cell: 1 mm", "cell: 1/7 mm")).empty());
  CHECK(fault(replaced(plain_scene(), "10 mm", "10.4 mm")) ==
        "scene.yaml:2:15: grid.size.0: not a whole number of cells of 0.001 m (nearest: 0.01 m), got '10.4 "
        "mm'");
  CHECK(holds(fault(replaced(plain_scene(), "1 mm}", "1 nm}")), "cells of"));
}

TEST_CASE("walls stand on the grid's faces, and a piston's speed is signed along its axis") {
  const Scene scene = parse(replaced(plain_scene(), "size:", "origin: [-1 mm, 0], size:") +
                            "boundaries:\n"
                            "  left: wall\n"
                            "  right: {wall: held, position: 8 mm}\n"
                            "  bottom: fixed\n"
                            "  top: {piston: 100 m/s, direction: down}\n");
  REQUIRE(scene.boundaries.size() == 4);
  const auto wall = [&](std::size_t k) { return std::get<WallSpec>(scene.boundaries[k].condition); };
  CHECK(wall(0).axis == 0);
  CHECK_FALSE(wall(0).upper);
  CHECK(wall(0).position == -0.001);
  CHECK_FALSE(wall(0).fixed);
  CHECK(wall(1).position == 0.008);
  CHECK(wall(1).fixed);
  CHECK(wall(2).axis == 1);
  CHECK(wall(2).fixed);
  CHECK(wall(3).upper);
  CHECK(wall(3).position == 0.02);
  CHECK(wall(3).speed.value == std::vector<double>{-100});
}

TEST_CASE("a piston moves inwards by default, along its own axis only, and its speed may be a table") {
  const auto top = [](const std::string& keys) {
    return std::get<WallSpec>(
        parse(plain_scene() + "boundaries: {top: {" + keys + "}}\n").boundaries[0].condition);
  };
  CHECK(top("piston: 3 m/s").speed.value == std::vector<double>{-3});
  CHECK(top("piston: 3 m/s, direction: +y").speed.value == std::vector<double>{3});
  const WallSpec ramp = top("piston: [[0, 0], [1 us, 2 m/s]]");
  CHECK(ramp.speed.time == std::vector<double>{0, 1e-6});
  CHECK(ramp.speed.value == std::vector<double>{0, -2});
  CHECK(top("piston: {times: [0, 1 us], values: [0, 2 m/s]}").speed.value == ramp.speed.value);
  const auto wrong = [](const std::string& keys) {
    return fault(plain_scene() + "boundaries: {top: {" + keys + "}}\n");
  };
  CHECK(holds(wrong("piston: 3, direction: left"), "moves along y only, got 'left'"));
  CHECK(holds(wrong("piston: [[1 us, 0], [1 us, 2]]"), "times must increase"));
  CHECK(holds(wrong("piston: {times: [0, 1], values: [1]}"), "2 times but 1 values"));
  CHECK(holds(wrong("piston: 3, position: 30 mm"), "outside the grid"));
  CHECK(holds(wrong("held: true"), "needs either piston (a speed) or wall"));
}

TEST_CASE("a box of nodes takes a velocity along any direction") {
  const Scene scene =
      parse(plain_scene() +
            "boundaries: {grip: {box: {from: [0, 0], to: [1 mm, 0]}, direction: [3, 4], speed: 2 m/s}}\n");
  const auto box = std::get<VelocityBoxSpec>(scene.boundaries[0].condition);
  CHECK(box.direction[0] == doctest::Approx(0.6));
  CHECK(box.direction[1] == doctest::Approx(0.8));
  CHECK(box.upper == Vec3{0.001, 0, 0});
}

TEST_CASE("rigid bodies may follow tables, and have a velocity field of their own") {
  const std::string rigid =
      replaced(plain_scene(), "bodies:\n",
               "  tool: {model: rigid}\n"
               "bodies:\n"
               "  - {name: tool, box: {from: [1 mm, 5 mm], to: [2 mm, 6 mm]}, material: tool, velocity: "
               "[0, [[0, 1], [1 us, 2]]]}\n");
  const Scene scene = parse(rigid);
  CHECK_FALSE(scene.bodies[0].rigid_velocity[0]);
  REQUIRE(scene.bodies[0].rigid_velocity[1]);
  CHECK(scene.bodies[0].rigid_velocity[1]->value == std::vector<double>{1, 2});
  CHECK(holds(fault(rigid + "contact: none\n"), "the rigid body 'tool' shares a velocity field"));
  CHECK(holds(fault(replaced(rigid, "material: steel", "material: steel, field: tool")),
              "'tool' shares a velocity field"));
  CHECK(holds(fault(replaced(rigid, "material: steel", "material: tool")), "every body is rigid"));
  CHECK(holds(fault(replaced(rigid, "material: tool", "material: steel")), "for rigid bodies only"));
}

TEST_CASE("bodies stay in the grid, have names of their own and one shape each") {
  CHECK(fault(replaced(plain_scene(), "to: [4 mm", "to: [12 mm")) ==
        "scene.yaml:7:5: bodies.0: body 'block' lies 0.002 m outside the grid, above in x (the body is at "
        "0.001 to 0.012 m, the grid at 0 to 0.01 m)");
  CHECK(holds(fault(plain_scene() +
                    "  - {name: block, disk: {centre: [5 mm, 9 mm], radius: 1 mm}, material: steel}\n"),
              "scene.yaml:8:12: bodies.1.name: another body is called 'block'"));
  CHECK(holds(fault(replaced(plain_scene(), "box: {", "disk: {centre: [3 mm, 3 mm], radius: 1 mm}, box: {")),
              "one shape"));
  CHECK(
      holds(fault(replaced(plain_scene(), "name: block, box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}, ", "")),
            "a body needs a shape"));
  CHECK(holds(fault(replaced(plain_scene(), "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}",
                             "sphere: {centre: [3 mm, 3 mm], radius: 1 mm}")),
              "a sphere exists in 3-D only. Did you mean 'disk'?"));
  CHECK(holds(fault(replaced(plain_scene(), "name: block", "name: a.b")), "not a name"));
  CHECK(holds(fault(replaced(plain_scene(), "material: steel", "material: steel, particles_per_cell: 9")),
              "from 1 to 8"));
}

TEST_CASE("every shape refuses what is no shape") {
  const auto wrong = [](const std::string& shape) {
    return fault(replaced(plain_scene(), "box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}", shape));
  };
  CHECK(holds(wrong("box: {from: [4 mm, 1 mm], to: [4 mm, 3 mm]}"), "'to' must lie above 'from' in x"));
  CHECK(holds(wrong("disk: {centre: [5 mm, 5 mm], radius: 0}"), "must be positive"));
  CHECK(holds(wrong("ring: {centre: [5 mm, 5 mm], inner: 2 mm, outer: 1 mm}"), "must be smaller"));
  CHECK(holds(wrong("polygon: [[1 mm, 1 mm], [2 mm, 2 mm]]"), "three or more points"));
  CHECK(holds(wrong("polygon: [[1 mm, 1 mm], [3 mm, 3 mm], [3 mm, 1 mm], [1 mm, 3 mm]]"), "crosses itself"));
  CHECK(holds(wrong("polygon: [[1 mm, 1 mm], [3 mm, 1 mm], [2 mm, 1 mm]]"), "folds back"));
  CHECK(
      holds(wrong("polygon: [[1 mm, 1 mm], [3 mm, 1 mm], [2 mm, 2 mm], [1 mm, 1 mm]]"), "closes by itself"));
  CHECK(holds(wrong("bitmap: nothing.png, extent: [1 mm, 1 mm]"), "no such file"));
}

TEST_CASE("a 3-D scene takes three components and no thickness") {
  const Scene scene = parse(solid_scene() + "gravity: {acceleration: [0, 0, -9.81 m/s^2], ramp: 1 us}\n");
  CHECK(scene.dimension() == 3);
  CHECK(scene.gravity.acceleration == Vec3{0, 0, -9.81});
  CHECK(scene.bodies[0].particles_per_cell == std::array<int, 3>{2, 2, 2});
  CHECK(holds(fault(solid_scene() + "thickness: 1 mm\n"), "a 3-D scene has no thickness"));
  CHECK(holds(fault(plain_scene() + "boundaries: {back: wall}\n"), "exists in 3-D only"));
}

TEST_CASE("the overlap of bodies is measured on request, in 2-D") {
  CHECK_FALSE(parse(plain_scene()).output.overlap);
  CHECK(parse(plain_scene() + "output: {overlap: true}\n").output.overlap);
  CHECK(fault(plain_scene() + "output: {overlap: yes}\n") ==
        "scene.yaml:8:19: output.overlap: not true or false, got 'yes'");
  CHECK(holds(fault(plain_scene() + "output: {overlapp: true}\n"), "Did you mean 'overlap'?"));
  CHECK(fault(solid_scene() + "output: {overlap: true}\n") ==
        "scene.yaml:8:19: output.overlap: the overlap of bodies is measured in 2-D only, got 'true'");
  CHECK_FALSE(parse(solid_scene() + "output: {overlap: false}\n").output.overlap);
}

TEST_CASE("checkpoints are asked for by wall time, by steps, by both or not at all") {
  const auto of = [](const std::string& value) {
    const Scene scene = parse(plain_scene() + "output: {checkpoint: " + value + "}\n");
    CHECK(parse(scene.resolved_yaml).resolved_yaml == scene.resolved_yaml);
    return scene.output.checkpoint;
  };
  const CheckpointSpec plain = parse(plain_scene()).output.checkpoint;
  CHECK((plain.active && plain.every == 600 && plain.steps == 0));
  CHECK(of("{every: 90 s}").every == 90);
  CHECK(of("{every: 90 s}").steps == 0);
  CHECK(of("{steps: 50}").steps == 50);
  CHECK(of("{steps: 50}").every == 0);
  CHECK((of("{every: 1 h, steps: 7}").every == 3600 && of("{every: 1 h, steps: 7}").steps == 7));
  CHECK((of("{every: none}").active && of("{every: none}").every == 0));
  CHECK_FALSE(of("none").active);
  const auto wrong = [](const std::string& value) {
    return fault(plain_scene() + "output: {checkpoint: " + value + "}\n");
  };
  CHECK(holds(wrong("{every: 5 mm}"), "output.checkpoint.every: 'mm' is a length"));
  CHECK(holds(wrong("{every: 0 s}"), "output.checkpoint.every: must be positive"));
  CHECK(holds(wrong("{steps: 0}"), "output.checkpoint.steps"));
  CHECK(holds(wrong("{step: 5}"), "Did you mean 'steps'?"));
  CHECK(holds(wrong("often"), "none or a map {every, steps}"));
}

TEST_CASE("a node by itself is the one nearest to its point, counted from the grid's origin") {
  const std::string moved = replaced(plain_scene(), "size:", "origin: [-2 mm, -4 mm], size:");
  const auto with = [&](const std::string& point) {
    return moved + "boundaries: {pin: {node: " + point + ", direction: x, speed: 1}}\n";
  };
  const auto pin = std::get<VelocityBoxSpec>(parse(with("[-1.6 mm, 2.4 mm]")).boundaries[0].condition);
  CHECK(pin.lower[0] == doctest::Approx(-2e-3));
  CHECK(pin.lower[1] == doctest::Approx(2e-3));
  CHECK(pin.upper == pin.lower);
  CHECK(faults(with("[8 mm, 16 mm]")).empty());  // the upper corner of the grid
  CHECK(holds(fault(with("[9 mm, 16 mm]")), "no node of the grid lies there in x"));
  CHECK(holds(fault(with("[0, -5 mm]")), "no node of the grid lies there in y"));
}

TEST_CASE("half of each pair of elastic constants is no pair, and three are too many") {
  const auto moduli = [](const std::string& text) {
    return fault(replaced(replaced(plain_scene(), "linear_elastic", "neo_hookean"),
                          "young: 210 GPa, poisson: 0.3", text));
  };
  const std::string needs = "needs either bulk and shear or young and poisson, ";
  CHECK(holds(moduli("shear: 1 GPa, young: 2 GPa"), needs + "but has only shear and young"));
  CHECK(holds(moduli("bulk: 1 GPa, poisson: 0.3"), needs + "but has only bulk and poisson"));
  CHECK(holds(moduli("bulk: 1 GPa, young: 2 GPa, poisson: 0.3"), needs + "not more"));
}

TEST_CASE("a grid has a cell along each edge at least, and a million at most") {
  const auto of = [](const std::string& size, const std::string& cell) {
    return faults(replaced(plain_scene(), "{size: [10 mm, 20 mm], cell: 1 mm}",
                           "{size: [" + size + "], cell: " + cell + "}"));
  };
  CHECK(of("20 mm, 20 mm", "20 mm").empty());
  CHECK(of("1000000 m, 1000000 m", "1 m").empty());
  CHECK(of("13 m, 26 m", "26 um").empty());  // 26 m over 26 um is a hair over a million in doubles
  const auto refused = [&](const std::string& size, const std::string& cell, const std::string& what) {
    CAPTURE(size);
    const auto all = of(size, cell);
    REQUIRE_FALSE(all.empty());
    CHECK(holds(all[0], what));
  };
  refused("10 mm, 20 mm", "20 mm", "grid.size.0: smaller than one cell of 0.02 m, got '10 mm'");
  refused("20 mm, 19.99 mm", "20 mm", "grid.size.1: smaller than one cell of 0.02 m, got '19.99 mm'");
  refused("20.01 mm, 20 mm", "20 mm",
          "grid.size.0: not a whole number of cells of 0.02 m (nearest: 0.02 m), got '20.01 mm'");
  refused("1 m, 1000001 m", "1 m", "grid.size.1: 1e+06 cells of 1 m (at most 1e+06), got '1000001 m'");
}
