#include <doctest/doctest.h>

#include "tools/study/handy_units.hpp"

using namespace mpmfast;

namespace {

std::string unit_of_text(const std::string& text) {
  return unit_of(std::get<Expression>(Expression::parse(text)));
}

std::string shown(const std::string& unit, double value) {
  const HandyUnit handy = handy_unit(unit, value);
  return std::to_string(static_cast<int>(value * handy.factor + 0.5)) + " " + handy.symbol;
}

}  // namespace

TEST_CASE(
    "the end of a column's name tells its unit; a sum of columns of one unit has it, a product has none") {
  CHECK(unit_of_column("left.mean_stress_xx_Pa") == "Pa");
  CHECK(unit_of_column("paddle.moment_z_Nm") == "N m");
  CHECK(unit_of_column("left-block.vx") == "m/s");
  CHECK(unit_of_column("momentum_x").empty());
  CHECK(unit_of_column("s").empty());
  CHECK(unit_of_text("kinetic_J + stored_J - friction_J") == "J");
  CHECK(unit_of_text("-`a/b.x_m` - 3 mm") == "m");
  CHECK(unit_of_text("kinetic_J + time_s").empty());
  CHECK(unit_of_text("time_s * 1e3").empty());  // who scales himself has a unit in mind
  CHECK(unit_of_text("3").empty());
  CHECK(quantity_in("Pa") == "stress");
  CHECK(quantity_in("kg m/s").empty());
}

TEST_CASE("beside its unit a column is named without it, any other expression as it is") {
  const auto beside = [](const std::string& text) {
    const auto expression = std::get<Expression>(Expression::parse(text));
    return name_beside(expression, unit_of(expression));
  };
  CHECK(beside("kinetic_J") == "kinetic");
  CHECK(beside("time_s") == "time");
  CHECK(beside("`A+B.force_x_N`") == "A+B.force_x");
  CHECK(beside("block.vy") == "block.vy");
  CHECK(beside("kinetic_J + stored_J") == "kinetic_J + stored_J");
  CHECK(beside("time_s * 1e3") == "time_s * 1e3");
}

TEST_CASE("a handy unit leaves the largest number between 1 and 1000") {
  CHECK(shown("s", 300e-6) == "300 µs");
  CHECK(shown("s", 2e-3) == "2 ms");
  CHECK(shown("s", 7000) == "7000 s");
  CHECK(shown("N", 31e3) == "31 kN");
  CHECK(shown("Pa", 194e9) == "194 GPa");
  CHECK(shown("Pa", 5e15) == "5000000 GPa");
  CHECK(shown("J", 0.25) == "250 mJ");
  CHECK(shown("kg", 5000) == "5000 kg");
  CHECK(shown("N", 0) == "0 N");
  CHECK(shown("J/m", 81900) == "82 kJ/m");
  CHECK(shown("kg/m", 5000) == "5000 kg/m");
}
