// Laws of surfaces on a grid: how stiff springs and bonds may be beside the cells and the bodies.

#include <algorithm>
#include <variant>
#include <vector>

#include "engine/plan/contact_law.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Of the stiffest body over a cell: (800 + 4/3 300) MPa over 0.5 mm. What is rigid, and what no body is made
/// of, is no body's modulus.
constexpr double kUnit = 1200e6 / 0.5e-3;
Scene bodies_of_two_materials() {
  return scene_from(R"(
space: plane_strain
grid: {size: [12 mm, 12 mm], cell: 0.5 mm}
time: {end: 1 ms}
materials:
  soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  hard: {model: neo_hookean, density: 1200 kg/m^3, bulk: 800 MPa, shear: 300 MPa}
  none: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 GPa, shear: 30 GPa}
  tool: {model: rigid}
bodies:
  - {name: a, box: {from: [2 mm, 2 mm], to: [10 mm, 4 mm]}, material: soft}
  - {name: b, box: {from: [2 mm, 4 mm], to: [10 mm, 6 mm]}, material: hard}
  - {name: c, box: {from: [2 mm, 6 mm], to: [10 mm, 8 mm]}, material: tool}
contact: {friction: 0.1}
)");
}

template <class Law>
AnyLaw on_grid(const Law& law) {
  return law_on(SurfaceLaw{law, 0, {}}, bodies_of_two_materials());
}

TEST_CASE(
    "springs are as stiff as they are stated, up to a hundred moduli a cell; all above a thousand tie") {
  const auto springs = [](double normal, double shear, double pressed) {
    Interface law;
    law.normal_stiffness = normal * kUnit;
    law.shear_stiffness = shear * kUnit;
    law.compression_stiffness = pressed * kUnit;
    return on_grid(law);
  };
  const auto units = [](const AnyLaw& law) {
    const auto& one = std::get<Interface>(law);
    return std::vector<double>{one.normal_stiffness / kUnit, one.shear_stiffness / kUnit,
                               one.compression_stiffness / kUnit};
  };
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    return relative_difference(a, b) < 1e-12;
  };
  CHECK(same(units(springs(99, 0, 2)), {99, 0, 2}));
  CHECK(same(units(springs(99, 0, 0)), {99, 0, 99}));  // pressed as drawn
  CHECK(same(units(springs(101, 50, 999)), {100, 50, 100}));
  CHECK(same(units(springs(2000, 2000, 999)), {100, 100, 100}));
  CHECK(same(units(springs(2000, 999, 2000)), {100, 100, 100}));
  CHECK(same(units(springs(999, 2000, 2000)), {100, 100, 100}));
  CHECK(std::holds_alternative<Perfect>(springs(1001, 1001, 1001)));
  CHECK(std::holds_alternative<Perfect>(springs(1001, 1001, 0)));
}

TEST_CASE(
    "curves of tractions are followed as they are stated, and nowhere steeper than a hundred moduli a cell") {
  NonlinearInterface law;
  law.compression = CompressionModel::contact;
  // Pieces of 50, 400 and −200 units; of 99 and 300.
  law.normal_curve = {{0, 1e-6, 2e-6, 5e-6}, {0, 50e-6 * kUnit, 450e-6 * kUnit, -150e-6 * kUnit}};
  law.shear_curve = {{0, 1e-6, 2e-6}, {0, 99e-6 * kUnit, 399e-6 * kUnit}};
  const AnyLaw on = on_grid(law);
  const auto& one = std::get<NonlinearInterface>(on);
  // Each piece rises as before, over as long a way as a hundred units take.
  CHECK(relative_difference(one.normal_curve.jump, {-0.5e-3, 0, 1e-6, 5e-6, 11e-6}) < 1e-12);
  CHECK(relative_difference(one.normal_curve.traction,
                            {0, 0, 50e-6 * kUnit, 450e-6 * kUnit, -150e-6 * kUnit}) < 1e-12);
  CHECK(relative_difference(one.shear_curve.jump, {0, 1e-6, 4e-6}) < 1e-12);
  CHECK(one.shear_curve.traction == law.shear_curve.traction);
  law.compression = CompressionModel::spring;
  for (const double pressed : {0.0, 20.0, 700.0}) {  // 0: as it begins to open
    CAPTURE(pressed);
    law.compression_stiffness = pressed * kUnit;
    const AnyLaw sprung = on_grid(law);
    const auto& curve = std::get<NonlinearInterface>(sprung).normal_curve;
    const double stated = pressed > 0 ? pressed : 50;
    CHECK(curve.traction[0] == doctest::Approx(-stated * kUnit * 0.5e-3).epsilon(1e-12));
    CHECK(curve.slope(0) == doctest::Approx(std::min(stated, 100.0) * kUnit).epsilon(1e-12));
  }
}

TEST_CASE("bonds begin with ten moduli a cell or what is stated, a hundred at most, and can break") {
  Cohesive bond;  // breaks at once at 0.5 units
  bond.normal_strength = bond.shear_strength = 1e6;
  bond.normal_toughness = bond.shear_toughness = 1e12 / kUnit;
  const auto stiffness = [&](double stated, double pressed) {
    bond.initial_stiffness = stated * kUnit;
    bond.compression_stiffness = pressed * kUnit;
    const AnyLaw on = on_grid(bond);
    const auto& law = std::get<Cohesive>(on);
    return std::vector<double>{law.initial_stiffness / kUnit, law.compression_stiffness / kUnit};
  };
  CHECK(relative_difference(stiffness(0, 0), {10, 10}) < 1e-12);
  CHECK(relative_difference(stiffness(99, 3), {99, 3}) < 1e-12);
  CHECK(relative_difference(stiffness(101, 700), {100, 100}) < 1e-12);
  CHECK(relative_difference(stiffness(0.1, 0), {1.01 * 0.5, 1.01 * 0.5}) < 1e-12);
  bond.compression = CompressionModel::contact;
  CHECK(relative_difference(stiffness(99, 3), {99, 0}) < 1e-12);
}

}  // namespace
}  // namespace mpmfast
