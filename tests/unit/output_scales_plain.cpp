// Scales, units, ticks and covered samples against plain rules, over random numbers.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "engine/output/cover.hpp"
#include "engine/output/scales.hpp"
#include "tests/random.hpp"

namespace mpmfast {
namespace {

using test::Random;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

TEST_CASE("the range of values is from the one that a hundredth lies below to its like above") {
  Random random(1);
  for (const int n : {1, 2, 3, 50, 51, 52, 149, 150, 151, 1000}) {
    CAPTURE(n);
    std::vector<double> values;
    for (int k = 0; k < n; ++k) values.push_back((n % 2 == 0 ? 1e-3 : 1) * random.in(-3, 5));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (const double odd : {kNone, kInfinity, -kInfinity}) values.insert(values.begin() + n / 2, odd);
    const Range range = robust_range(values);
    const auto at = [&](double share) {
      return sorted[static_cast<std::size_t>(std::lround(share * (n - 1)))];
    };
    CHECK(range.lower == at(0.01));
    CHECK(range.upper == at(0.99));
  }
  // Where that is one value, all that there are.
  std::vector<double> values(1000, 2.0);
  values[500] = -7;
  values[20] = 9;
  CHECK(robust_range(values).lower == -7);
  CHECK(robust_range(values).upper == 9);
  for (const std::vector<double>& none : {std::vector<double>{}, std::vector<double>{kNone, kInfinity}}) {
    CHECK(robust_range(none).lower == 0);
    CHECK(robust_range(none).upper == 1);
  }
}

TEST_CASE("between the nine colours of a scale each of their three parts is a straight line") {
  constexpr std::array<std::array<unsigned, 9>, 2> kColours{
      {{0x440154, 0x472d7b, 0x3b518b, 0x2c718e, 0x21918d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725},
       {0x16315f, 0x2f63a8, 0x6f9fd0, 0xb5cfe6, 0xf2f1ee, 0xecc3ae, 0xd98870, 0xb54646, 0x70162e}}};
  const std::array<ColourScale, 2> scales{ColourScale({0, 8}), ColourScale({-4, 3})};  // −4 … 4
  Random random(2);
  for (std::size_t s = 0; s < 2; ++s)
    for (int k = 0; k < 300; ++k) {
      const double position = k < 9 ? k : random.in(-1, 9), within = std::clamp(position, 0.0, 8.0);
      CAPTURE(position);
      const auto i = static_cast<std::size_t>(std::min(within, 7.0));
      const double t = within - static_cast<double>(i);
      const Colour shown = scales[s](position - (s == 0 ? 0 : 4));
      const std::array<int, 3> parts{shown.red, shown.green, shown.blue};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto part = [&](unsigned hex) { return static_cast<int>(hex >> (8 * (2 - c)) & 255U); };
        const double line = (1 - t) * part(kColours[s][i]) + t * part(kColours[s][i + 1]);
        CHECK(std::abs(parts[c] - line) <= 0.5 + 1e-9);
      }
    }
}

TEST_CASE("28 bodies have a colour each, as the list has them, and then the list begins again") {
  constexpr std::array<unsigned, 28> kListed{
      0x1e69b4, 0xe15a0f, 0x00c369, 0xe187f0, 0x78004b, 0x0f4b00, 0xffc300, 0x4bc3ff, 0x78785a, 0x2dffe1,
      0x964bb4, 0xd2b4b4, 0x3c1e96, 0x008700, 0x7887ff, 0x3c3c4b, 0x963c1e, 0xa5f069, 0xb49600, 0xff7896,
      0x00a5a5, 0xc33c78, 0xa587b4, 0x006969, 0xff965a, 0xffc3ff, 0x96d2a5, 0x875a78};
  for (std::size_t body = 0; body < 100; ++body) CHECK(body_colour(body) == Colour::hex(kListed[body % 28]));
}

TEST_CASE(
    "a range narrower than a billionth of its size is one value, and signs count where both are large") {
  Random random(3);
  for (int k = 0; k < 300; ++k) {
    const double lower = std::exp(random.in(-20, 20)) * (k % 2 == 0 ? 1 : -1),
                 upper = lower + std::abs(lower) * std::exp(random.in(-30, 3));
    CAPTURE(lower);
    CAPTURE(upper);
    const double size = std::max(std::abs(lower), std::abs(upper)), width = upper - lower;
    if (std::abs(width - 1e-9 * size) < 1e-12 * size) continue;
    const ColourScale scale({lower, upper});
    CHECK(scale.has_one_value() == (width < 1e-9 * size));
    const bool both = lower < -0.1 * size && upper > 0.1 * size;
    if (width < 1e-9 * size) {
      CHECK(scale.range().lower == doctest::Approx(lower - 0.05 * size).epsilon(1e-12));
      CHECK(scale.range().upper == doctest::Approx(upper + 0.05 * size).epsilon(1e-12));
    } else {
      CHECK(scale.range().lower == (both ? -size : lower));
      CHECK(scale.range().upper == (both ? size : upper));
    }
  }
}

TEST_CASE("units have the prefixes that are usual for what they measure") {
  struct Unit {
    const char* name;
    double in_si;
  };
  struct Units {
    const char* si;
    std::vector<Unit> units;  ///< from the largest
  };
  const std::vector<Units> known{{"Pa", {{"TPa", 1e12}, {"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}, {"Pa", 1}}},
                                 {"m", {{"km", 1e3}, {"m", 1}, {"mm", 1e-3}, {"µm", 1e-6}, {"nm", 1e-9}}},
                                 {"s", {{"s", 1}, {"ms", 1e-3}, {"µs", 1e-6}, {"ns", 1e-9}}},
                                 {"J", {{"J", 1}, {"mJ", 1e-3}, {"µJ", 1e-6}, {"nJ", 1e-9}}},
                                 {"", {{"", 1}}},
                                 {"-", {{"-", 1}}},
                                 {"K", {{"K", 1}}},
                                 {"m/s", {{"m/s", 1}}}};
  for (const auto& [si, units] : known) {
    CAPTURE(si);
    for (int power = -60; power <= 60; ++power)
      for (const double share : {0.9994, 0.9996, 3.0}) {
        const double size = share * std::pow(10.0, power / 4.0);
        CAPTURE(size);
        auto fits =
            std::find_if(units.begin(), units.end(), [&](const Unit& u) { return size >= 0.9995 * u.in_si; });
        if (fits == units.end()) fits = units.end() - 1;
        CHECK(display_unit(size, si).name == fits->name);
        CHECK(display_unit(size, si).in_si == fits->in_si);
      }
    for (const double odd : {0.0, -1e9, kNone, kInfinity}) {
      CHECK(display_unit(odd, si).name == si);
      CHECK(display_unit(odd, si).in_si == 1);
    }
  }
}

/// The multiples of the first of 1, 2, 5 and 10 times a power of ten that is not much less than the range
/// over `wanted`.
std::vector<double> plain_ticks(Range range, int wanted) {
  const double raw = (range.upper - range.lower) / wanted;
  double decade = 1e-30;
  while (10 * decade <= raw * (1 + 1e-12)) decade *= 10;
  double spacing = 10 * decade;
  for (const double step : {5.0, 2.0, 1.0})
    if (step * decade >= 0.7 * raw) spacing = step * decade;
  std::vector<double> ticks;
  for (double n = std::floor(range.lower / spacing) - 1; n < range.upper / spacing + 2; ++n)
    if (n * spacing > range.lower - 1e-9 * spacing && n * spacing < range.upper + 1e-9 * spacing)
      ticks.push_back(n * spacing);
  return ticks.size() < 2 && wanted < 16 ? plain_ticks(range, wanted + 1) : ticks;
}

TEST_CASE(
    "ticks are all round numbers in a range, tiny and huge ones too, and their labels tell them apart") {
  Random random(4);
  for (int k = 0; k < 600; ++k) {
    const double width = std::exp(random.in(-25, 25)), lower = width * random.in(-3, 3);
    const Range range{lower, lower + width};
    const int wanted = 1 + random.below(9);
    CAPTURE(lower);
    CAPTURE(width);
    CAPTURE(wanted);
    const std::vector<double> ticks = round_ticks(range, wanted), plain = plain_ticks(range, wanted);
    REQUIRE(ticks.size() == plain.size());
    REQUIRE(ticks.size() > 1);
    const double spacing = plain[1] - plain[0];
    std::set<std::string> labels;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      CHECK(std::abs(ticks[i] - plain[i]) < 1e-9 * spacing);
      const std::string label = tick_label(ticks[i], spacing);
      labels.insert(label);
      CHECK(std::abs(std::stod(label) - ticks[i]) <= 1e-5 * std::max(std::abs(ticks[i]), spacing));
    }
    CHECK(labels.size() == ticks.size());
  }
  // Ends that are ticks count.
  for (const double size : {1e-9, 1e-3, 1.0, 1e6}) {
    CHECK(round_ticks({0, 10 * size}, 5).size() == 6);
    CHECK(round_ticks({-4 * size, 6 * size}, 5).front() == doctest::Approx(-4 * size));
    CHECK(round_ticks({-4 * size, 6 * size}, 5).back() == doctest::Approx(6 * size));
  }
  CHECK(round_ticks({0, 0}, 5).empty());
  CHECK(round_ticks({0, kNone}, 5).empty());
}

TEST_CASE(
    "a label has as many digits behind the point as its spacing, and powers of ten where that is far off") {
  for (int power = -4; power < 6; ++power)
    for (const int step : {1, 2, 5})
      for (int n = -7; n <= 7; ++n) {
        const double spacing = step * std::pow(10.0, power), tick = n * spacing;
        CAPTURE(spacing);
        CAPTURE(n);
        std::string expected = fmt::format("{:.{}f}", tick, std::max(0, -power));
        if (std::abs(tick) >= 1e6 * (1 - 1e-12)) expected = fmt::format("{:.6g}", tick);
        CHECK(tick_label(tick, spacing) == (n == 0 ? "0" : expected));
      }
  CHECK(tick_label(1e-3, 1e-4) == "0.0010");
  CHECK(tick_label(2e-5, 0.99e-4) == "2e-05");
  CHECK(tick_label(2e-5, 1.01e-4) == "0.0000");
  CHECK(tick_label(0.9e-6, 1) == "0");
  CHECK(tick_label(1.1e-6, 1e-5) == "1.1e-06");
}

TEST_CASE("a disc covers the samples whose centres lie in it, and shows where one of them was free") {
  constexpr int kWidth = 13, kHeight = 9, kSamples = Canvas::kSamples;
  Random random(5);
  for (int picture = 0; picture < 40; ++picture) {
    Cover cover(kWidth, kHeight);
    std::vector<bool> covered(static_cast<std::size_t>(kWidth * kHeight * kSamples * kSamples));
    for (int k = 0; k < 25; ++k) {
      const PixelPoint centre{random.in(-4, kWidth + 4), random.in(-4, kHeight + 4)};
      const double radius = k % 5 == 0 ? random.in(0, 12) : random.in(0, 2.5);
      bool shows = false;
      for (int row = 0; row < kHeight * kSamples; ++row)
        for (int column = 0; column < kWidth * kSamples; ++column) {
          const double x = (column + 0.5) / kSamples - centre.x, y = (row + 0.5) / kSamples - centre.y;
          if (x * x + y * y >= radius * radius) continue;
          const auto at = static_cast<std::size_t>(row * kWidth * kSamples + column);
          shows = shows || !covered[at];
          covered[at] = true;
        }
      REQUIRE(cover.add(centre, radius) == shows);
    }
  }
}

}  // namespace
}  // namespace mpmfast
