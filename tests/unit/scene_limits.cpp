// Text that would take endless memory or time: refused at once, at its place.

#include <doctest/doctest.h>

#include <ctime>

#include "engine/geometry/load.hpp"
#include "scene_helpers.hpp"
#include "tests/sanitized.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

std::string repeated(const std::string& text, int count) {
  std::string out;
  for (int k = 0; k < count; ++k) out += text;
  return out;
}

/// Seconds of processor time that the reader takes; a sanitizer may slow it twentyfold.
double seconds_to_refuse(const std::string& text) {
  const std::clock_t begin = std::clock();
  CHECK_FALSE(faults(text).empty());
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace

TEST_CASE("aliases may not multiply values") {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 12; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + repeated(before + ", ", 9) +
            before + "]\n";
  }
  CHECK(holds(fault(text), "scene.yaml:5:"));
  CHECK(holds(fault(text), "too many values (at most 200000, aliases expanded)"));
}

TEST_CASE("aliases may not multiply text") {
  const std::string text =
      "a: &a " + std::string(1 << 20, 'x') + "\nb: [" + repeated("*a, ", 10000) + "*a]\n";
  CHECK(holds(fault(text), "scene.yaml:2:"));
  CHECK(holds(fault(text), "too much text (at most 16777216 bytes, aliases expanded)"));
}

TEST_CASE("aliases may not deepen the nesting") {
  std::string text = "a0: &a0 " + repeated("[", 20) + repeated("]", 20) + "\n";
  text += "a1: &a1 " + repeated("[", 20) + "*a0" + repeated("]", 20) + "\n";
  CHECK(fault(text) == "scene.yaml:2:29: nested too deeply (at most 32 levels, aliases expanded)");
}

TEST_CASE("anchors inside anchors, whose values are all kept, count as often") {
  const std::string text =
      "a: " + repeated("&a [", 30) + std::string(1 << 20, 'x') + repeated("]", 30) + "\n";
  CHECK(holds(fault(text), "too much text"));
}

TEST_CASE("text without end in sight is refused fast") {
  constexpr int kMany = 100000;
  constexpr double kPatience = 20;  // s; each is a fraction of one without sanitizers, and would be hours
  const std::vector<std::string> texts{
      repeated("[", 10 * kMany),    repeated("{", 10 * kMany),
      repeated("- ", kMany),        repeated("? ", kMany),
      repeated("a: ", kMany),       repeated("[]: ", kMany),
      repeated("&a ", kMany),       repeated("!t ", kMany),
      repeated("'", kMany + 1),     repeated("\n ", kMany) + "x: [",
      repeated("--- ", kMany),      repeated("%x\n", kMany),
      std::string(10 * kMany, 'x'), "materials: " + std::string(10 * kMany, '1')};
  for (const std::string& text : texts) {
    CAPTURE(text.substr(0, 20));
    CHECK(seconds_to_refuse(text) < kPatience);
  }
}

TEST_CASE("tens of thousands of entries are read in a time that does not grow with their square" *
          doctest::skip(sanitized())) {
  std::string keys, materials = "materials:\n", bodies = "bodies:\n", pairs = "contact: {pairs: [";
  for (int k = 0; k < 60000; ++k) keys += "k" + std::to_string(k) + ": 1\n";
  for (int k = 0; k < 30000; ++k) materials += "  m" + std::to_string(k) + ": {model: rigid}\n";
  for (int k = 0; k < 12000; ++k) bodies += "  - {box: 1, material: m" + std::to_string(40000 - k) + "}\n";
  constexpr double kPatience = 60;  // s, under sanitizers
  CHECK(seconds_to_refuse(keys) < kPatience);
  CHECK(seconds_to_refuse("space: 3d\n" + materials + bodies) < kPatience);
  CHECK(faults(keys).size() >= 60000);
}

TEST_CASE("numbers that no double holds, and words for none, are refused where they stand") {
  for (const char* number :
       {"1e999", "-1e999", "nan", ".nan", "NaN", ".inf", "-inf", "0x10", "010", "1e", "1_000", "1e308 km",
        "1/0 mm", "1/1e-320 mm", "--1", "+-1", "1 mm^9", "1 mm mm"}) {
    CAPTURE(number);
    CHECK(holds(fault(replaced(plain_scene(), "cell: 1 mm", std::string("cell: ") + number)),
                "scene.yaml:2:36: grid.cell: "));
  }
}

TEST_CASE("a picture that promises more than its file holds is refused before it takes the memory") {
  using Bytes = std::vector<unsigned char>;
  const auto with = [](Bytes bytes, std::size_t at, unsigned char value) {
    bytes[at] = value;
    return bytes;
  };
  // 1 × 1, grey 7, as a PNG.
  const Bytes good{0x89, 'P', 'N', 'G', '\r', '\n', 26,  '\n', 0,    0,    0,    13,   'I', 'H', 'D', 'R', 0,
                   0,    0,   1,   0,   0,    0,    1,   8,    0,    0,    0,    0,    0,   0,   0,   0,   0,
                   0,    0,   10,  'I', 'D',  'A',  'T', 0x78, 0x9c, 0x63, 0x60, 0x07, 0,   0,   9,   0,   8,
                   0,    0,   0,   0,   0,    0,    0,   0,    'I',  'E',  'N',  'D',  0,   0,   0,   0};
  const auto fault_of = [](const Bytes& bytes) {
    std::string why_not;
    return decode_grey_png(bytes, why_not) ? std::string() : why_not;
  };
  REQUIRE(fault_of(good) == "");
  CHECK(fault_of(with(good, 33, 0x3F)) == "damaged: a chunk is longer than the rest of the file");
  CHECK(holds(fault_of(with(good, 15, 'X')), "begins without IHDR"));
  CHECK(holds(fault_of(Bytes(good.begin(), good.end() - 12)), "ends before its IEND"));
  CHECK(holds(fault_of(with(good, 18, 0x10)), "damaged: "));
  CHECK(holds(fault_of(with(good, 16, 0x10)), "at most 32768 along an edge"));
  // 32768 × 32768 pixels, and 8192 × 8193: a row more than there may be.
  CHECK(
      holds(fault_of(with(with(good, 18, 0x80), 22, 0x80)), "at most 32768 along an edge, 67108864 in all"));
  CHECK(holds(fault_of(with(with(good, 18, 0x20), 22, 0x20)), "8193 × 8193 pixels (at most"));
}

TEST_CASE("what an alias holds may reach down to level 32, and no further") {
  // The map of the scene is level 1, the lists around the alias are 20 more.
  const auto deep = [](const std::string& open, const std::string& close, int levels) {
    return faults("a: &a " + repeated(open, levels) + "1" + repeated(close, levels) +
                  "\nb: " + repeated("[", 20) + "*a" + repeated("]", 20) + "\n");
  };
  const auto too_deep = [](const std::vector<std::string>& all) {
    return all.size() == 1 && holds(all[0], "nested too deeply");
  };
  CHECK_FALSE(too_deep(deep("[", "]", 11)));
  CHECK(too_deep(deep("[", "]", 12)));
  CHECK_FALSE(too_deep(deep("{k: ", "}", 11)));
  CHECK(too_deep(deep("{k: ", "}", 12)));
}

TEST_CASE("a value stands as deep as an empty list may, and no deeper") {
  // The map of the scene is level 1; of no value is it asked what it is for.
  const auto too_deep = [](const std::string& open, const std::string& inside, const std::string& close,
                           int levels) {
    const auto all = faults("a: " + repeated(open, levels) + inside + repeated(close, levels) + "\n");
    return all.size() == 1 && holds(all[0], "nested too deeply (at most 32 levels, aliases expanded)");
  };
  for (const char* inside : {"", "1", "word", "\"\"", "~", "1, 2", "&b 1, *b"}) {
    CAPTURE(inside);
    CHECK_FALSE(too_deep("[", inside, "]", 31));
    CHECK(too_deep("[", inside, "]", 32));
  }
  for (const char* inside : {"1", "word", "\"\"", "~"}) {
    CAPTURE(inside);
    CHECK_FALSE(too_deep("{k: ", inside, "}", 31));
    CHECK(too_deep("{k: ", inside, "}", 32));
  }
}
