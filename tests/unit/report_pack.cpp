#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tools/report/pack.hpp"

using namespace mpmfast;

namespace {

std::string inflated(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf got = size;
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &got,
                     reinterpret_cast<const Bytef*>(packed.data()),
                     static_cast<uLong>(packed.size())) == Z_OK);
  REQUIRE(got == size);
  return bytes;
}

/// What the page does (data.js).
std::vector<std::uint16_t> unpacked(const Packed& packed, std::size_t count, std::size_t width, int bits) {
  const std::string bytes = inflated(packed.bytes, count * static_cast<std::size_t>(bits) / 8);
  const std::uint16_t mask = bits == 8 ? 0xff : 0xffff;
  std::vector<std::uint16_t> levels(count);
  for (std::size_t i = 0; i < count; ++i) {
    levels[i] = static_cast<std::uint8_t>(bytes[i]);
    if (bits == 16)
      levels[i] = static_cast<std::uint16_t>(levels[i] | static_cast<std::uint8_t>(bytes[count + i]) << 8);
  }
  for (std::size_t i = 0; i < count && packed.space_order > 0; ++i)
    if (i % width != 0) levels[i] = static_cast<std::uint16_t>((levels[i] + levels[i - 1]) & mask);
  for (std::size_t i = width; i < count && packed.time_order > 0; ++i) {
    const int before = levels[i - width];
    const int expected =
        packed.time_order == 1 || i < 2 * width ? before : 2 * before - levels[i - 2 * width];
    levels[i] = static_cast<std::uint16_t>((levels[i] + expected) & mask);
  }
  return levels;
}

}  // namespace

TEST_CASE("packed levels come back, whichever differences are smallest") {
  std::mt19937 random(3);
  const std::size_t width = 500, frames = 7;
  bool time_used = false, space_used = false;
  for (const int bits : {8, 16}) {
    const int most = bits == 8 ? 256 : 65536;
    for (int kind = 0; kind < 4; ++kind) {
      std::vector<std::uint16_t> levels;
      for (std::size_t f = 0; f < frames; ++f)
        for (std::size_t i = 0; i < width; ++i) {
          const int noise = static_cast<int>(random() % static_cast<unsigned>(most));
          const int steady = static_cast<int>((i * i * 7919) % 65521),
                    smooth = static_cast<int>(13 * i + 100 * f);
          const int value = kind == 0   ? noise
                            : kind == 1 ? steady + 37 * static_cast<int>(f)
                            : kind == 2 ? smooth
                                        : 3;
          levels.push_back(static_cast<std::uint16_t>(value % most));
        }
      const Packed packed = pack_levels(levels, width, bits);
      CHECK(unpacked(packed, levels.size(), width, bits) == levels);
      time_used = time_used || packed.time_order > 0;
      space_used = space_used || packed.space_order > 0;
      if (kind == 1) CHECK(packed.bytes.size() < levels.size() / 2);
    }
  }
  CHECK(time_used);
  CHECK(space_used);
  CHECK(unpacked(pack_levels({}, 0, 8), 0, 1, 8).empty());
}

TEST_CASE("a value is its nearest level, and what is no number has a level of its own") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Levels even = Levels::even(-2, 6, 16);
  for (const double value : {-2.0, -1.23456, 0.0, 5.9999, 6.0})
    CHECK(std::abs(even.value(even.nearest(value)) - value) <= 0.5001 * even.spacing());
  CHECK(even.value(even.nearest(-2)) == -2);
  CHECK(even.value(even.nearest(6)) == doctest::Approx(6).epsilon(1e-12));
  CHECK(even.nearest(100) == even.nearest(6));
  CHECK(even.nearest(nan) == even.none());
  CHECK(even.nearest(100) != even.none());
  CHECK(Levels::even(5, 5, 8).nearest(5) == 0);
}

TEST_CASE("crowded levels keep the detail of the many beside an outlier, and zero exactly") {
  std::vector<double> sample;
  for (int k = 0; k <= 10000; ++k) sample.push_back(1e-4 * k);
  sample.push_back(1e6);
  const Levels levels = Levels::crowded(sample, 0, 1e6);
  double worst = 0;
  for (const double value : sample)
    if (value <= 1) worst = std::max(worst, std::abs(levels.value(levels.nearest(value)) - value));
  CHECK(worst < 0.01);  // half of one of 126 steps
  CHECK(levels.value(levels.nearest(0)) == 0);
  CHECK(levels.value(levels.nearest(1e6)) == 1e6);
  CHECK(levels.table().size() <= 255);
  const Levels signs = Levels::crowded({-1, -0.9, 0.31, 0.3, 0.9}, -1, 0.9);
  CHECK(signs.value(signs.nearest(1e-9)) == 0);
  CHECK(Levels::crowded({0, 0, 0}, 0, 0).nearest(0) == 0);
}

TEST_CASE("base64 as in RFC 4648") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}
