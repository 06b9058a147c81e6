#include <doctest/doctest.h>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

const char* const kElastic = "{model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}";

std::string with(const std::string& material) { return replaced(plain_scene(), kElastic, material); }

template <class Law>
Law law(const std::string& material) {
  return std::get<Law>(parse(with(material)).materials[0].model);
}

const char* const kNickel =
    "{model: mie_gruneisen, density: 8.87 g/cm^3, bulk: 188 GPa, gruneisen: 2, hugoniot_slope: 1.44, "
    "heat_capacity: 0.444 J/g/K, linear_viscosity: 0.4, quadratic_viscosity: 4}";
const char* const kCopper =
    "{model: johnson_cook, density: 8.96 g/cm^3, young: 124 GPa, poisson: 0.34, yield: 90 MPa, hardening: "
    "292 "
    "MPa, exponent: 0.31, rate_factor: 0.025, softening: 1.09, melt: 1356 K, temperature: 300 K, "
    "heat_capacity: "
    "383 J/kg/K, equation_of_state: {gruneisen: 2, hugoniot_slope: 1.49}}";

}  // namespace

TEST_CASE("metals are read with their defaults") {
  const auto nickel = law<MieGruneisen>(kNickel);
  CHECK(nickel.shear == 0);
  CHECK(nickel.heat_capacity == doctest::Approx(444).epsilon(1e-14));
  CHECK(nickel.start_temperature == 293);
  CHECK(nickel.volume.slope == 1.44);
  CHECK(nickel.volume.quadratic_viscosity == 4);
  const auto copper = law<MieGruneisenJohnsonCook>(kCopper);
  CHECK(copper.volume.bulk == doctest::Approx(124e9 / 0.96).epsilon(1e-12));
  CHECK(copper.heat_share == 0.9);
  CHECK(copper.volume.linear_viscosity == 0);
  CHECK(copper.yield.reference == 300);  // the starting temperature
  CHECK(copper.yield.reference_rate == 1);
  CHECK(copper.yield.melt == 1356);
  const auto steel = law<ElasticPlastic>(
      "{model: j2_plasticity, density: 7.85 g/cm^3, bulk: 160 GPa, shear: 80 GPa, yield: 400 MPa}");
  CHECK(steel.yield.hardening == 0);
  const auto rubber = law<LogarithmicNeoHookean>(
      "{model: logarithmic_neo_hookean, density: 1010 kg/m^3, young: 73 MPa, poisson: 0.4}");
  CHECK(rubber.shear == doctest::Approx(73e6 / 2.8).epsilon(1e-13));
  CHECK(rubber.lambda == doctest::Approx(4 * rubber.shear).epsilon(1e-13));
}

TEST_CASE("what is wrong with a metal is said where it is") {
  const auto wrong = [](const char* material, const char* from, const char* to) {
    return fault(with(replaced(material, from, to)));
  };
  CHECK(holds(wrong(kNickel, "heat_capacity: 0.444 J/g/K, ", ""), "materials.steel.heat_capacity: missing"));
  CHECK(holds(wrong(kNickel, "gruneisen: 2", "gruneisen: -2"),
              "materials.steel.gruneisen: must be zero or more"));
  CHECK(holds(wrong(kNickel, "hugoniot_slope", "hugonoit_slope: 1, hugoniot_slope"),
              "Did you mean 'hugoniot_slope'"));
  CHECK(holds(wrong(kNickel, "0.444 J/g/K", "444 Pa"), "'Pa' is a pressure (a heat capacity: J/kg/K)"));
  CHECK(holds(wrong(kCopper, "melt: 1356 K", "melt: 299 K"),
              "materials.steel.melt: must be above the reference temperature"));
  CHECK(holds(wrong(kCopper, "{gruneisen: 2, ", "{gamma: 2, gruneisen: 2, "),
              "materials.steel.equation_of_state.gamma: unknown key"));
  CHECK(holds(wrong(kCopper, "young: 124 GPa, ", ""), "needs either bulk and shear or young and poisson"));
  CHECK(holds(fault(with("{model: j2_plasticty, density: 1}")), "Did you mean 'j2_plasticity'"));
  CHECK(holds(
      fault(with("{model: logarithmic_neo_hookean, density: 1, bulk: 1 Pa, lambda: 1 Pa, shear: 1 Pa}")),
      "bulk"));
}

TEST_CASE("a metal written with its defaults reads as the same metal") {
  for (const char* material :
       {kNickel, kCopper,
        "{model: johnson_cook, density: 1/7 kg/m^3, bulk: 1/3 GPa, shear: 1 GPa, yield: 1 MPa, hardening: 1 "
        "MPa, "
        "exponent: 0.3, melt: 900 K, reference: 280 K, heat_capacity: 400, reference_rate: 1e-3 s^-1}",
        "{model: j2_plasticity, density: 8 g/cm^3, bulk: 1 GPa, shear: 1 GPa, yield: 1 MPa, hardening: 3 "
        "MPa, "
        "heat_capacity: 400 J/kg/K, equation_of_state: {gruneisen: 1, hugoniot_slope: 1}}",
        "{model: logarithmic_neo_hookean, density: 1 kg/m^3, lambda: 0, shear: 1 MPa}"}) {
    const std::string once = parse(with(material)).resolved_yaml;
    CHECK(parse(once).resolved_yaml == once);
  }
}
