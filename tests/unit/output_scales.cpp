// From numbers to colours, ticks and units: known values, and values of the other sign.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/output/scales.hpp"

namespace mpmfast {
namespace {

TEST_CASE("a range has the same colours from end to end wherever it lies, and its end colours beyond") {
  for (const Range range : {Range{0, 1}, Range{2, 5}, Range{-5, -2}, Range{1e9, 3e9}, Range{-0.1, 5}}) {
    CAPTURE(range.lower);
    const ColourScale scale(range);
    CHECK(scale(range.lower) == Colour::hex(0x440154));
    CHECK(scale(range.lower + 0.5 * range.width()) == Colour::hex(0x21918d));
    CHECK(scale(range.upper) == Colour::hex(0xfde725));
    CHECK(scale(range.lower - range.width()) == Colour::hex(0x440154));
    CHECK(scale(range.upper + range.width()) == Colour::hex(0xfde725));
  }
  CHECK(ColourScale({0, 16})(1) == Colour{70, 23, 104});  // half-way between the first two
  CHECK(ColourScale({0, 1})(std::numeric_limits<double>::quiet_NaN()) == Colour{150, 150, 150});
}

TEST_CASE("where values take both signs zero is near white, and each sign has its colour") {
  for (const Range range : {Range{-2, 5}, Range{-5, 2}, Range{-5, 5}}) {
    CAPTURE(range.lower);
    const ColourScale scale(range);
    CHECK(scale(0) == Colour::hex(0xf2f1ee));
    CHECK(scale(-5) == Colour::hex(0x16315f));
    CHECK(scale(-2.5) == Colour::hex(0x6f9fd0));
    CHECK(scale(2.5) == Colour::hex(0xd98870));
    CHECK(scale(5) == Colour::hex(0x70162e));
  }
  // A tenth of the other sign is a trace still.
  CHECK(ColourScale({-0.5, 5}).range().lower == -0.5);
  CHECK(ColourScale({-5, 0.5}).range().upper == 0.5);
  CHECK(ColourScale({-0.51, 5}).range().lower == -5);
  CHECK(ColourScale({-5, 0.51}).range().upper == 5);
}

TEST_CASE("one value has a range around it and the colour of its middle, of either sign and at zero") {
  for (const double value : {3.0, -3.0, 0.0, 1e-300}) {
    CAPTURE(value);
    const double margin = value == 0 ? 1 : 0.05 * std::abs(value);
    const ColourScale scale({value, value});
    CHECK(scale.has_one_value());
    CHECK(scale.range().lower == value - margin);
    CHECK(scale.range().upper == value + margin);
    CHECK(scale(value) == Colour::hex(0x21918d));
  }
}

TEST_CASE("negative values have the range and the ticks of positive ones, mirrored") {
  std::vector<double> values(1001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = -static_cast<double>(i * i);
  CHECK(robust_range(values).lower == -990.0 * 990);
  CHECK(robust_range(values).upper == -10.0 * 10);
  for (const Range range : {Range{0.2, 1.4}, Range{3, 17}, Range{-0.03, 1.02}, Range{0, 10}})
    for (const int wanted : {3, 5, 8}) {
      const auto ticks = round_ticks(range, wanted),
                 mirrored = round_ticks({-range.upper, -range.lower}, wanted);
      REQUIRE(mirrored.size() == ticks.size());
      const double spacing = ticks[1] - ticks[0];
      for (std::size_t k = 0; k < ticks.size(); ++k) {
        CHECK(mirrored[ticks.size() - 1 - k] == doctest::Approx(-ticks[k]).epsilon(1e-12).scale(spacing));
        CHECK(ticks[k] >= range.lower - 1e-6 * spacing);
        CHECK(ticks[k] <= range.upper + 1e-6 * spacing);
      }
    }
}

TEST_CASE("ticks lie 1, 2 or 5 times a power of ten apart, as many as were asked for") {
  const auto first_two = [](Range range, int wanted) {
    const std::vector<double> ticks = round_ticks(range, wanted);
    REQUIRE(ticks.size() > 1);
    return ticks[1] - ticks[0];
  };
  CHECK(first_two({0, 10}, 5) == doctest::Approx(2));
  CHECK(first_two({0, 10}, 8) == doctest::Approx(1));
  CHECK(first_two({0, 10}, 3) == doctest::Approx(5));
  CHECK(first_two({0, 7}, 2) == doctest::Approx(5));
  CHECK(first_two({0, 8}, 1) == doctest::Approx(5));  // ten apart there would be one
  CHECK(first_two({0, 1e-4}, 5) == doctest::Approx(2e-5));
  CHECK(round_ticks({0, 10}, 5).size() == 6);
  CHECK(round_ticks({1, 1}, 5).empty());
  CHECK(round_ticks({2, 1}, 5).empty());
  CHECK(round_ticks({0, std::numeric_limits<double>::infinity()}, 5).empty());
}

TEST_CASE("a tick's label has the digits of the spacing, and a sign where it is negative") {
  struct Label {
    double tick, spacing;
    const char* text;
  };
  for (const auto& [tick, spacing, text] :
       {Label{0.6, 0.2, "0.6"}, Label{0.25, 0.05, "0.25"}, Label{0.001, 0.001, "0.001"}, Label{20, 10, "20"},
        Label{999999, 1, "999999"}, Label{1e6, 5e5, "1e+06"}, Label{2.5e6, 5e5, "2.5e+06"},
        Label{2e-5, 1e-5, "2e-05"}}) {
    CHECK(tick_label(tick, spacing) == text);
    CHECK(tick_label(-tick, spacing) == std::string("-") + text);
  }
  CHECK(tick_label(1e-8, 0.2) == "0");
  CHECK(tick_label(-1e-8, 0.2) == "0");
}

TEST_CASE("a unit is the usual one below which a size has a digit before the point") {
  struct Shown {
    double size;
    const char *si, *name;
    double in_si;
  };
  for (const auto& [size, si, name, in_si] :
       {Shown{1e12, "Pa", "TPa", 1e12},
        Shown{9e11, "Pa", "GPa", 1e9},
        Shown{1e6, "Pa", "MPa", 1e6},
        Shown{999.6, "Pa", "kPa", 1e3},
        Shown{999.4, "Pa", "Pa", 1},
        Shown{1e-3, "Pa", "Pa", 1},
        Shown{2e7, "m", "km", 1e3},
        Shown{0.9996, "m", "m", 1},
        Shown{0.9994, "m", "mm", 1e-3},
        Shown{3e-6, "m", "µm", 1e-6},
        Shown{3e-9, "m", "nm", 1e-9},
        Shown{3e-12, "m", "nm", 1e-9},
        Shown{5e3, "s", "s", 1},
        Shown{5e-3, "s", "ms", 1e-3},
        Shown{2e-3, "J", "mJ", 1e-3},
        Shown{5e3, "K", "K", 1},
        Shown{5e3, "m/s", "m/s", 1},
        Shown{5e-3, "-", "-", 1},
        Shown{5, "", "", 1},
        Shown{-5e3, "Pa", "Pa", 1},
        Shown{std::numeric_limits<double>::infinity(), "Pa", "Pa", 1}}) {
    CAPTURE(size);
    const DisplayUnit unit = display_unit(size, si);
    CHECK(unit.name == name);
    CHECK(unit.in_si == in_si);
  }
}

}  // namespace
}  // namespace mpmfast
