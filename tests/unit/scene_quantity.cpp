#include <doctest/doctest.h>

#include "engine/quantities/quantity.hpp"

using namespace mpmfast;

namespace {

double value(const char* text, Measure kind) {
  const auto parsed = parse_quantity(text, kind);
  REQUIRE_MESSAGE(std::holds_alternative<double>(parsed), text);
  return std::get<double>(parsed);
}

std::string error(const char* text, Measure kind) {
  const auto parsed = parse_quantity(text, kind);
  const auto* fault = std::get_if<QuantityError>(&parsed);
  return fault ? fault->message + "|" + fault->hint : "good";
}

}  // namespace

TEST_CASE("a quantity with a unit is the double nearest to its decimal value in SI") {
  CHECK(value("5 mm", Measure::length) == 0.005);
  CHECK(value("0.3 um", Measure::length) == 3e-7);
  CHECK(value("0.5 us", Measure::time) == 5e-7);
  CHECK(value("2450 MPa", Measure::pressure) == 2.45e9);
  CHECK(value("78.09 GPa", Measure::pressure) == 78.09e9);
  CHECK(value("2.78 g/cm^3", Measure::density) == 2780.0);
  CHECK(value("100 m/s", Measure::velocity) == 100.0);
  CHECK(value("2 km/s", Measure::velocity) == 2000.0);
  CHECK(value("-9.81 m/s^2", Measure::acceleration) == -9.81);
  CHECK(value("180 deg", Measure::angle) == doctest::Approx(3.14159265358979).epsilon(1e-14));
}

TEST_CASE("a rational is divided once") {
  CHECK(value("1/70 mm", Measure::length) == 1.0 / 70000.0);
  CHECK(value("1 / 3", Measure::number) == 1.0 / 3.0);
  CHECK(value("-2/3 mm", Measure::length) == -2.0 / 3000.0);
}

TEST_CASE("a bare number is SI, and its forms are those of decimals") {
  CHECK(value("0.005", Measure::length) == 0.005);
  CHECK(value("+1.5e-3", Measure::time) == 0.0015);
  CHECK(value(".5", Measure::number) == 0.5);
  CHECK(value("5.", Measure::number) == 5);
  CHECK(value("1E3", Measure::pressure) == 1000);
}

TEST_CASE("units may be compound and in the spellings that people paste") {
  CHECK(value("1 N/mm^2", Measure::pressure) == 1e6);
  CHECK(value("1 kg*m/s^2/m^2", Measure::pressure) == 1);
  CHECK(value("1 g/cm3", Measure::density) == 1000);
  CHECK(value("1 g/cm³", Measure::density) == 1000);
  CHECK(value("1 kg*m^-3", Measure::density) == 1);
  CHECK(value("7 µm", Measure::length) == 7e-6);
  CHECK(value("5mm", Measure::length) == 0.005);
  CHECK(value("5e-3m", Measure::length) == 0.005);
  CHECK(value("0.5 \u00b5s", Measure::time) == 5e-7);
  CHECK(value("0.5 \u03bcs", Measure::time) == 5e-7);
}

TEST_CASE("prefixes above and below a line cancel, whichever is the larger") {
  CHECK(value("5 um/ms", Measure::velocity) == 0.005);
  CHECK(value("5 mm/us", Measure::velocity) == 5000);
  CHECK(value("5 mm/ms", Measure::velocity) == 5);
  CHECK(value("7 mm^2/cm", Measure::length) == 7e-4);
}

TEST_CASE("a unit of another dimension is named as what it is") {
  CHECK(error("5 mm", Measure::pressure) == "'mm' is a length (a pressure: Pa, kPa, MPa, GPa)|");
  CHECK(error("5 GPa", Measure::time) == "'GPa' is a pressure (a time: s, ms, us, ns)|");
  CHECK(error("5 m/s", Measure::number) == "'m/s' is a velocity (a number without a unit)|");
  CHECK(error("5 kg*s", Measure::length) == "'kg*s' is not a unit of a length (a length: m, cm, mm, um)|");
}

TEST_CASE("an unknown unit suggests the nearest known one") {
  CHECK(error("210 GPA", Measure::pressure) ==
        "unknown unit 'GPA' (a pressure: Pa, kPa, MPa, GPa)|Did you mean 'GPa'?");
  CHECK(error("5 MM", Measure::length) == "unknown unit 'MM' (a length: m, cm, mm, um)|Did you mean 'mm'?");
  CHECK(error("5 furlong", Measure::length) == "unknown unit 'furlong' (a length: m, cm, mm, um)|");
}

TEST_CASE("a unit whose signs are written otherwise, and a decimal comma, are told with what works") {
  const auto hint = [](const char* text, Measure kind) {
    const std::string all = error(text, kind);
    return all.substr(all.find('|') + 1);
  };
  for (const char* text : {"1200 kgm-3", "1200 kg m^-3", "1200 kg m-3", "1200 kg·m-3", "1200 kg/m^3."})
    CHECK_MESSAGE(hint(text, Measure::density) == "Write kg/m^3", text);
  CHECK(hint("10 m s-1", Measure::velocity) == "Write m/s");
  CHECK(hint("10 ms-1", Measure::velocity) == "Write m/s");
  CHECK(hint("10 MPa.", Measure::pressure) == "Write MPa");
  CHECK(hint("1,25 g/cm^3", Measure::density) == "Write 1.25 g/cm^3");
  CHECK(hint("10 000 m", Measure::length) == "Write 10000 m");
  CHECK(hint("10_000 m", Measure::length) == "Write 10000 m");
  CHECK(hint("1,000 m", Measure::length).empty());  // one, or a thousand?
}

TEST_CASE("a unit without a number, and a number cut short, are errors") {
  CHECK(error("mm", Measure::length) ==
        "the number is missing before the unit 'mm' (a length: m, cm, mm, um)|");
  CHECK(error("5 /", Measure::length) == "a number is missing after '/' (a length)|");
  CHECK(error("1/0 mm", Measure::length) == "division by zero (a length)|");
  CHECK(error("", Measure::length) == "not a number (a length: m, cm, mm, um)|");
  CHECK(error("5 m/", Measure::length) != "good");
  CHECK(error("5 m^", Measure::length) != "good");
  CHECK(error("5 m^12", Measure::length) != "good");
}

TEST_CASE("numbers that other readers take for something else are refused") {
  for (const char* text : {"010", "0x10", "nan", ".nan", "inf", "-.inf", "infinity", "1e999", "1e-999",
                           "1_000", "1,5", "1d-3", "1e", "--1", "+", "."}) {
    CHECK_MESSAGE(error(text, Measure::number) != "good", text);
  }
  CHECK(error("0", Measure::number) == "good");
  CHECK(error("0.10", Measure::number) == "good");
  CHECK(error("1e300 km", Measure::length) == "good");
  CHECK(error("1e306 km", Measure::length) == "a number out of range (a length)|");
}

TEST_CASE("what is written in SI reads back as the same number") {
  for (const double number : {1.0 / 3.0, 1e-300, 6.02214076e23, 0.1, -1.0 / 70000.0}) {
    CHECK(value(quantity_text(number, Measure::pressure).c_str(), Measure::pressure) == number);
  }
}
