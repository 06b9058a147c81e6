// Words and their characters: misspelt ones against the definition of an edit, characters against the table
// of UTF-8, tables in time against sums of trapezia.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "engine/quantities/closest.hpp"
#include "engine/quantities/code_point.hpp"
#include "engine/quantities/printable.hpp"
#include "engine/quantities/time_table.hpp"

namespace mpmfast {
namespace {

using Draw = std::mt19937_64;

int whole(Draw& draw, int lower, int upper) { return std::uniform_int_distribution<int>(lower, upper)(draw); }

std::string word_of(Draw& draw, const std::string& letters, int longest) {
  std::string out(static_cast<std::size_t>(whole(draw, 0, longest)), ' ');
  for (char& c : out)
    c = letters[static_cast<std::size_t>(whole(draw, 0, static_cast<int>(letters.size()) - 1))];
  return out;
}

/// The fewest edits, by trying each as the last one.
int edits(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
  const std::string short_a = a.substr(0, a.size() - 1), short_b = b.substr(0, b.size() - 1);
  if (a.back() == b.back()) return edits(short_a, short_b);
  int least = 1 + std::min({edits(short_a, b), edits(a, short_b), edits(short_a, short_b)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && b.back() == a[a.size() - 2])
    least = std::min(least, 1 + edits(a.substr(0, a.size() - 2), b.substr(0, b.size() - 2)));
  return least;
}

TEST_CASE("between two words lie the fewest edits: letters inserted, deleted, replaced, neighbours swapped") {
  Draw draw(21);
  for (int k = 0; k < 300; ++k) {
    const std::string a = word_of(draw, "abc", 5), b = word_of(draw, "abc", 5);
    CAPTURE(a);
    CAPTURE(b);
    CHECK(edit_distance(a, b) == edits(a, b));
  }
  CHECK(edit_distance("", "abcd") == 4);
  CHECK(edit_distance("particles_per_cell", "partciles_percell") == 2);
  for (const std::size_t longest : {63, 64})
    CHECK(edit_distance(std::string(longest, 'a'), "b" + std::string(longest - 1, 'a')) == 1);
  CHECK(edit_distance(std::string(65, 'a'), "a") == INT_MAX);
  CHECK(edit_distance("a", std::string(65, 'a')) == INT_MAX);
}

TEST_CASE("the nearest word is one of which at most a third differs, and case counts least") {
  Draw draw(22);
  int found = 0;
  for (int k = 0; k < 400; ++k) {
    const std::string word = word_of(draw, "abAB", 6);
    std::vector<std::string> known;
    for (int n = 0; n < 4; ++n) known.push_back(word_of(draw, "abAB", 6));
    std::string nearest;
    int least = INT_MAX;
    for (const std::string& one : known) {
      const auto small = [](std::string s) {
        for (char& c : s) c = c == 'A' ? 'a' : c == 'B' ? 'b' : c;
        return s;
      };
      const int distance = edits(small(word), small(one)),
                longer = static_cast<int>(std::max(word.size(), one.size()));
      if (one == word || 3 * distance > longer + 1 || (word.size() < 2 && distance > 0)) continue;
      const int score = 2 * distance + (edits(word, one) > distance);
      if (score < least) nearest = one;
      least = std::min(score, least);
    }
    CAPTURE(word);
    CHECK(closest(word, known) == nearest);
    CHECK(closest_hint(word, known) == (nearest.empty() ? "" : "Did you mean '" + nearest + "'?"));
    found += !nearest.empty();
  }
  CHECK(found > 100);
  CHECK(lower_case("aZ_\xC3\x84 9") == "az_\xC3\x84 9");
}

std::string encoded(std::uint32_t code) {
  const auto tail = [&](int shift) { return static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xC0 | (code >> 6)), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xE0 | (code >> 12)), tail(6), tail(0)};
  return {static_cast<char>(0xF0 | (code >> 18)), tail(12), tail(6), tail(0)};
}

/// How many bytes the sequence at the front has that table 3-7 of the Unicode standard calls well-formed.
std::size_t well_formed(const std::string& text) {
  const auto in = [&](std::size_t k, int low, int high) {
    if (k >= text.size()) return false;
    const int byte = static_cast<unsigned char>(text[k]);
    return byte >= low && byte <= high;
  };
  const auto tail = [&](std::size_t k) { return in(k, 0x80, 0xBF); };
  if (in(0, 0x00, 0x7F)) return 1;
  if (in(0, 0xC2, 0xDF) && tail(1)) return 2;
  if (in(0, 0xE0, 0xE0) && in(1, 0xA0, 0xBF) && tail(2)) return 3;
  if (in(0, 0xE1, 0xEC) && tail(1) && tail(2)) return 3;
  if (in(0, 0xED, 0xED) && in(1, 0x80, 0x9F) && tail(2)) return 3;
  if (in(0, 0xEE, 0xEF) && tail(1) && tail(2)) return 3;
  if (in(0, 0xF0, 0xF0) && in(1, 0x90, 0xBF) && tail(2) && tail(3)) return 4;
  if (in(0, 0xF1, 0xF3) && tail(1) && tail(2) && tail(3)) return 4;
  if (in(0, 0xF4, 0xF4) && in(1, 0x80, 0x8F) && tail(2) && tail(3)) return 4;
  return 0;
}

TEST_CASE("every character of UTF-8 is read as its number, wherever it stands, and nothing else is one") {
  for (std::uint32_t code = 0; code <= 0x10FFFF; code += code < 0x3000 ? 1 : 61) {
    if (code >= 0xD800 && code <= 0xDFFF) continue;
    const std::string text = "ab" + encoded(code);
    const CodePoint point = code_point(text, 2);
    if (point.code != code || point.bytes != text.size() - 2) FAIL(code);
  }
  for (int first = 0x80; first < 0x100; ++first)
    for (int second = 0; second < 0x100; ++second)
      for (const std::string& rest : {std::string("\x80\x80"), std::string("\xBF\xBF"), std::string("\xBF"),
                                      std::string(), std::string("a\x80"), std::string("\x80\xC0")}) {
        const std::string text{static_cast<char>(first), static_cast<char>(second)};
        if (code_point(text + rest, 0).bytes != well_formed(text + rest)) FAIL(first << " " << second);
      }
  for (int first = 0x80; first < 0x100; ++first)
    CHECK(code_point(std::string(1, static_cast<char>(first)), 0).bytes == 0);
}

TEST_CASE(
    "in a printable text every character that acts is told by its number, and every byte that is none") {
  const auto acts = [](std::uint32_t code) {
    return (code < 0x20 && code != 9 && code != 10) || (code >= 0x7F && code <= 0x9F) || code == 0x200E ||
           code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  };
  for (std::uint32_t code = 0; code < 0x2100; ++code) {
    const std::string shown =
        "a" +
        (acts(code) ? fmt::format("\\{}{:0{}x}", code < 0x100 ? 'x' : 'u', code, code < 0x100 ? 2 : 4)
                    : encoded(code)) +
        "z";
    if (printable("a" + encoded(code) + "z") != shown) FAIL(code);
  }
  CHECK(printable("1\xFF\xC3\n\xE2\x82\xAC\xE2\x82") == "1\\xff\\xc3\n\xE2\x82\xAC\\xe2\\x82");
  CHECK(printable("") == "");
}

TEST_CASE("pasted forms of units become plain ones, all of them") {
  CHECK(plain_spelling("\xC2\xB5\xCE\xBC\xC2\xB0\xC2\xB7\xC2\xB2\xC2\xB3") == "uudeg*^2^3");
  CHECK(plain_spelling("\xC2\xB5m\xC2\xB7\xC2\xB5m m\xC2\xB2/s\xC2\xB2 \xC2\xB9") ==
        "um*um m^2/s^2 \xC2\xB9");
  CHECK(plain_spelling("") == "");
}

TEST_CASE("a table in time is linear between its points, constant beyond, and so are its integral and mean") {
  Draw draw(23);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    TimeTable table;
    double at = unit(draw);
    for (int k = whole(draw, 1, 5); k > 0; --k) {
      table.time.push_back(at += 0.3 + 0.2 * unit(draw));
      table.value.push_back(3 * unit(draw));
    }
    const std::size_t n = table.time.size();
    const auto plain = [&](double t) {
      double sum = t < table.time[0] ? table.value[0] : 0;
      if (t >= table.time[n - 1]) sum = table.value[n - 1];
      for (std::size_t k = 0; k + 1 < n; ++k)
        if (t >= table.time[k] && t < table.time[k + 1]) {
          const double s = (t - table.time[k]) / (table.time[k + 1] - table.time[k]);
          sum = (1 - s) * table.value[k] + s * table.value[k + 1];
        }
      return sum;
    };
    // Trapezia between all kinks are exact.
    const auto area = [&](double from, double to) {
      std::vector<double> cuts{from, to};
      for (const double t : table.time)
        if (t > from && t < to) cuts.push_back(t);
      std::sort(cuts.begin(), cuts.end());
      double sum = 0;
      for (std::size_t k = 1; k < cuts.size(); ++k)
        sum += 0.5 * (plain(cuts[k - 1]) + plain(cuts[k])) * (cuts[k] - cuts[k - 1]);
      return sum;
    };
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-13; };
    for (int k = 0; k < 20; ++k) {
      const double t = 2.5 * unit(draw), dt = 1 + unit(draw);
      CHECK(near(value_at(table, t), plain(t)));
      CHECK(near(integral_to(table, t), t > 0 ? area(0, t) : -area(t, 0)));
      CHECK(near(mean_over(table, t, dt) * dt, area(t, t + dt)));
      CHECK(near(mean_over(table, t, 0), plain(t)));
    }
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      CHECK(near(value_at(table, table.time[k]), table.value[k]));
      most = std::max(most, std::abs(table.value[k]));
    }
    CHECK(largest(table) == most);
  }
}

TEST_CASE("a table is written as its value where it is one from the start on, else point by point") {
  CHECK(table_text({{0}, {2}}, Measure::velocity) == "2 m/s");
  CHECK(table_text({{1}, {2}}, Measure::velocity) == "[[1 s, 2 m/s]]");
  CHECK(table_text({{0, 0.5, 2}, {0, -1, 3}}, Measure::number) == "[[0 s, 0], [0.5 s, -1], [2 s, 3]]");
  CHECK(points_text({0, 0.001}, {0, 1e6}, {Measure::length, Measure::pressure}) ==
        "[[0 m, 0 Pa], [0.001 m, 1000000 Pa]]");
}

}  // namespace
}  // namespace mpmfast
