// What is written around a box: ticks as long sides have space for, titles that are whole.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "engine/output/picture.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

struct Text {
  double left, line, width;
  std::string text;
};

std::vector<Text> texts_of(Picture& picture) {
  const TemporaryFolder folder;
  picture.canvas().write(folder.path() / "x.svg");
  pugi::xml_document svg;
  REQUIRE(svg.load_file((folder.path() / "x.svg").c_str()).status == pugi::status_ok);
  std::vector<Text> out;
  for (const auto& found : svg.select_nodes("//text")) {
    const auto node = found.node();
    out.push_back({node.attribute("x").as_double(), node.attribute("y").as_double(),
                   node.attribute("textLength").as_double(), node.text().as_string()});
  }
  return out;
}

/// The labels of round numbers along a side.
std::vector<std::string> labels_of(const Range& range, double pixels, double apart, int fewest) {
  const std::vector<double> ticks = round_ticks(range, std::max(fewest, static_cast<int>(pixels / apart)));
  std::vector<std::string> out;
  for (const double tick : ticks) out.push_back(tick_label(tick, ticks[1] - ticks[0]));
  return out;
}

Labels labels_in(const DisplayUnit& unit) {
  Labels labels;
  labels.length = unit;
  labels.axes = "xy";
  return labels;
}

TEST_CASE("an axis has a number for each 110 pixels across and 90 up, a bar for each 90, and its name") {
  const Labels plain = labels_in({"mm", 1e-3});
  for (int k = 0; k < 30; ++k) {
    // A side of 852 pixels, or 886 beside it, and another one close to where it has space for one number
    // more.
    const bool high = k % 2 == 0;
    const double apart = high ? 110 : 90, long_side = high ? 852 : 768;
    const double short_side = apart * (3 + k % 5) + (k % 3 == 0 ? -0.6 : 0.4);
    const double metres = 1e-3 * std::pow(1.37, k % 29);
    const Range longer{-0.3 * metres, 0.7 * metres};
    const Range shorter{0.1 * metres, (0.1 + short_side / long_side) * metres};
    Labels labels = plain;
    labels.bar = Range{-2.5e3 * metres, 1e6 * metres};
    labels.bar_unit = "Pa";
    Picture picture(high ? shorter : longer, high ? longer : shorter, labels, PictureFormat::svg);
    const PixelPoint lower =
        picture.at(high ? shorter.lower : longer.lower, high ? longer.lower : shorter.lower);
    const PixelPoint upper =
        picture.at(high ? shorter.upper : longer.upper, high ? longer.upper : shorter.upper);
    const double width = upper.x - lower.x, height = lower.y - upper.y;
    CAPTURE(width);
    CAPTURE(height);
    picture.draw_axes();
    const ColourScale scale(*labels.bar);
    const bool with_bar = k % 2 == 1 && k < 16;
    if (with_bar) picture.draw_colour_bar(scale);
    const auto in_mm = [](const Range& range) { return Range{range.lower / 1e-3, range.upper / 1e-3}; };
    std::vector<std::string> expected = labels_of(in_mm(high ? shorter : longer), width, 110, 2);
    for (const auto& label : labels_of(in_mm(high ? longer : shorter), height, 90, 2))
      expected.push_back(label);
    expected.insert(expected.end(), {"x (mm)", "y (mm)"});
    if (with_bar) {
      const DisplayUnit unit = display_unit(std::max(-scale.range().lower, scale.range().upper), "Pa");
      for (const auto& label :
           labels_of({scale.range().lower / unit.in_si, scale.range().upper / unit.in_si}, height, 90, 3))
        expected.push_back(label);
      expected.push_back(unit.name);
    }
    std::vector<std::string> drawn;
    for (const Text& text : texts_of(picture)) drawn.push_back(text.text);
    CHECK(drawn == expected);
  }
}

TEST_CASE("a bar has the unit of its larger end, of either sign") {
  for (const auto& [range, name] : {std::pair(Range{-9e9, -2e6}, "GPa"), std::pair(Range{2e3, 9e6}, "MPa"),
                                    std::pair(Range{-2e3, 1}, "kPa")}) {
    Labels labels = labels_in({"m", 1});
    labels.bar = range;
    labels.bar_unit = "Pa";
    Picture picture({0, 1}, {0, 1}, labels, PictureFormat::svg);
    picture.draw_colour_bar(ColourScale(range));
    CHECK(texts_of(picture).back().text == name);
  }
}

TEST_CASE("two numbers along an axis have the digits of what is between them") {
  Picture picture({0.1, 0.75}, {0, 40}, labels_in({"m", 1}), PictureFormat::svg);
  picture.draw_axes();
  const std::vector<Text> texts = texts_of(picture);
  const auto is_number = [&](const char* text) {
    return std::any_of(texts.begin(), texts.end(), [&](const Text& t) { return t.text == text; });
  };
  CHECK(is_number("0"));
  CHECK(is_number("10"));
  Picture narrow({-0.01, 0.99}, {0, 3}, labels_in({"m", 1}), PictureFormat::svg);
  narrow.draw_axes();
  CHECK(texts_of(narrow)[1].text == "0.5");
}

TEST_CASE("space beside a box is for the widest number, whether it is the first or the last") {
  const double wide = Canvas::text_width("-2.5e+06");
  REQUIRE(12 + wide + 12 > 84);
  const auto left_of = [](const Range& y) {
    Picture picture({0, 3e6}, y, labels_in({"m", 1}), PictureFormat::svg);
    return picture.at(0, 0).x;
  };
  const auto widest = [](const Range& y, double height) {
    double out = 0;
    for (const auto& label : labels_of(y, height, 90, 2)) out = std::max(out, Canvas::text_width(label));
    return out;
  };
  for (const Range& y : {Range{-1.05e6, -0.55e6}, Range{0.5e6, 1.05e6}, Range{-2e6, -0.2e6}}) {
    Picture picture({0, 3e6}, y, labels_in({"m", 1}), PictureFormat::svg);
    const double height = picture.at(0, y.lower).y - picture.at(0, y.upper).y;
    CHECK(left_of(y) == doctest::Approx(std::max(84.0, 12 + widest(y, height) + 12)).epsilon(1e-6));
  }
  // A number that ends before the box does needs less space on the right.
  for (const double beyond : {0.0, 1e4, 2e4}) {
    const Range x{0, 4e3 + 1e-3 * beyond}, y{0, 1e3};
    Picture picture(x, y, labels_in({"mm", 1e-3}), PictureFormat::svg);
    const double pixels = picture.at(x.upper, 0).x - picture.at(4e3, 0).x;
    const double right = picture.canvas().width() - picture.at(x.upper, 0).x;
    CHECK(std::abs(right - std::max(30.0, 0.5 * Canvas::text_width("4e+06") - pixels + 12)) < 0.02);
  }
}

TEST_CASE("titles lie one line below the other above the box, and each line within the picture") {
  const std::string words = "some words of a title that goes on and on";
  const std::string much = words + " " + words + " " + words + " " + words + " " + words;
  for (const std::string& title : {std::string("A"), words, much})
    for (const std::string& subtitle : {std::string("b"), words + " below", much + " below"})
      for (const std::string& note : {std::string(), std::string("c"), words + " of note", much + " of note"})
        for (const double high : {1.0, 12.0}) {
          CAPTURE(title);
          CAPTURE(subtitle);
          CAPTURE(note);
          Labels labels = labels_in({"m", 1});
          labels.longest = {title, subtitle, note};
          Picture picture({0, 1}, {0, high}, labels, PictureFormat::svg);
          const double top = picture.at(0, high).y, space = picture.canvas().width() - 24;
          picture.write_titles(labels.longest);
          const std::vector<Text> lines = texts_of(picture);
          std::string all;
          for (std::size_t k = 0; k < lines.size(); ++k) {
            CHECK(lines[k].left == 12);
            CHECK(std::abs(lines[k].line - lines[0].line - 24 * static_cast<double>(k)) < 0.011);
            CHECK(lines[k].width <= space + 0.01);
            all += (k > 0 ? " " : "") + lines[k].text;
          }
          CHECK(top ==
                doctest::Approx(20 + 24 * static_cast<double>(lines.size()) + 16));  // space for these lines
          const bool behind = Canvas::text_width(subtitle + ", " + note) <= space;
          const std::string expected = title + " " + subtitle +
                                       (note.empty() ? ""
                                        : behind     ? ", " + note
                                                     : " " + note);
          const bool is_whole = expected == all;
          CHECK((is_whole || all.find("...") != std::string::npos));
          if (lines.size() < 8) CHECK(is_whole);
        }
}

TEST_CASE(
    "a picture of a series with shorter titles than the longest has space for those, and longer ones are "
    "cut") {
  Labels labels = labels_in({"m", 1});
  std::string much;
  for (int k = 0; k < 40; ++k) much += "word" + std::to_string(k) + " ";
  labels.longest = {"A title", "a subtitle", "a note"};
  const auto written = [&](const PictureText& text) {
    Picture picture({0, 1}, {0, 1}, labels, PictureFormat::svg);
    picture.write_titles(text);
    std::vector<std::string> out;
    for (const Text& line : texts_of(picture)) out.push_back(line.text);
    return out;
  };
  CHECK(written({"A", "b", ""}) == std::vector<std::string>{"A", "b"});
  CHECK(written({"A", "b", "c"}) == std::vector<std::string>{"A", "b, c"});
  const auto cut = written({much, much, ""});
  REQUIRE(cut.size() == 2);
  for (const std::string& line : cut) CHECK(line.ends_with("..."));
  labels.longest = {"A title", much, much};  // the note below, two or three lines each
  const auto below = written({"A", "b", "c"});
  CHECK(below == std::vector<std::string>{"A", "b", "c"});
  const auto all = written({"A", much, much});
  CHECK(all.size() > 4);
  const auto more = written({"A", much + much + much + much + much, much});
  CHECK(more.size() == all.size());
  CHECK(more.back().ends_with("..."));
}

}  // namespace
