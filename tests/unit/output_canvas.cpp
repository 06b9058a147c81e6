// Shapes and text in pixels and as vectors.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <pugixml.hpp>

#include "engine/output/canvas.hpp"
#include "engine/output/cover.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

constexpr int kWidth = 120, kHeight = 80;
constexpr Colour kBlue{40, 90, 200};

/// The pixels of what is drawn.
struct Drawn {
  explicit Drawn(const std::function<void(Canvas&)>& draw) {
    Canvas canvas(kWidth, kHeight);
    draw(canvas);
    pixel = canvas.pixels();
  }
  Colour at(int x, int y) const {
    const std::size_t i = 3 * static_cast<std::size_t>(y * kWidth + x);
    return {pixel[i], pixel[i + 1], pixel[i + 2]};
  }
  /// How much of the pixel a shape of kBlue covers.
  double share(int x, int y) const { return (255 - at(x, y).red) / (255.0 - kBlue.red); }
  /// Of a rectangle of pixels, those at its lower ends included.
  double area(int left, int top, int right, int bottom) const {
    double sum = 0;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) sum += share(x, y);
    return sum;
  }
  double area() const { return area(0, 0, kWidth, kHeight); }
  std::vector<std::uint8_t> pixel;
};

std::string written(PictureFormat format, const std::function<void(Canvas&)>& draw) {
  const TemporaryFolder folder;
  Canvas canvas(kWidth, kHeight, format);
  draw(canvas);
  canvas.write(folder.path() / "x");
  return read_text(folder.path() / "x");
}

}  // namespace

TEST_CASE("shapes cover the pixels that they are told to, in their exact colour") {
  const Drawn polygon([](Canvas& canvas) {
    canvas.fill_convex(std::array<PixelPoint, 4>{{{10, 10}, {70, 22}, {58, 72}, {4, 52}}}, kBlue);
  });
  CHECK(polygon.area() == doctest::Approx(2766).epsilon(0.01));  // by the corners
  CHECK(polygon.at(30, 40) == kBlue);
  CHECK(polygon.at(90, 40) == Colour{255, 255, 255});

  const Drawn disc([](Canvas& canvas) { canvas.fill_disc({50, 40}, 20, kBlue); });
  CHECK(disc.area() == doctest::Approx(std::numbers::pi * 400).epsilon(0.01));
  CHECK(disc.at(50, 22) == kBlue);
  CHECK(disc.at(50, 18) == Colour{255, 255, 255});

  const Drawn line([](Canvas& canvas) { canvas.line({10, 30.5}, {110, 30.5}, 3, kBlue); });
  CHECK(line.area() == doctest::Approx(300));
  CHECK(line.area(10, 29, 110, 32) == doctest::Approx(300));

  const Drawn frame([](Canvas& canvas) { canvas.frame({20, 20}, {60, 50}, 2, kBlue); });
  CHECK(frame.area(20, 20, 60, 50) == 0);  // it goes around
  CHECK(frame.area() == doctest::Approx(44 * 34 - 40 * 30));
}

TEST_CASE("what covers a half of a pixel gives it half of its colour") {
  const Drawn half([](Canvas& canvas) {
    canvas.fill_convex(std::array<PixelPoint, 4>{{{10, 10}, {20, 10}, {20, 20.5}, {10, 20.5}}}, kBlue);
  });
  CHECK(half.share(15, 20) > 0.3);
  CHECK(half.share(15, 20) < 0.7);
  CHECK(half.share(15, 19) == 1);
  CHECK(half.share(15, 21) == 0);
}

TEST_CASE("neighbours that share their edges show no seam, in one colour and in several") {
  constexpr double kTurn = 0.3;
  const auto place = [](double u, double v) {
    return PixelPoint{60 + 3.1 * (u * std::cos(kTurn) - v * std::sin(kTurn)),
                      40 + 3.1 * (u * std::sin(kTurn) + v * std::cos(kTurn))};
  };
  for (const int colours : {1, 2}) {
    const Drawn tiles([&](Canvas& canvas) {
      for (int i = -8; i < 8; ++i)
        for (int j = -8; j < 8; ++j)
          canvas.fill_convex(
              std::array<PixelPoint, 4>{{place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)}},
              (i + j) % colours == 0 ? kBlue : Colour{kBlue.red, 90, 100});
    });
    for (int y = 25; y < 55; ++y)
      for (int x = 45; x < 75; ++x) CHECK(int{tiles.at(x, y).red} == kBlue.red);
  }
}

TEST_CASE("polygons of one colour that overlap do not cancel, whichever way they turn") {
  const Drawn both([](Canvas& canvas) {
    canvas.fill_convex(std::array<PixelPoint, 3>{{{10, 10}, {50, 10}, {10, 50}}}, kBlue);
    canvas.fill_convex(std::array<PixelPoint, 3>{{{10, 10}, {10, 50}, {50, 10}}}, kBlue);
  });
  CHECK(both.at(15, 15) == kBlue);
}

TEST_CASE("what is outside is cut, and what is not a number is left out") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  const Drawn wide([](Canvas& canvas) {
    canvas.fill_convex(std::array<PixelPoint, 3>{{{-1e12, -1e12}, {1e12, -1e12}, {0, 1e12}}}, kBlue);
  });
  CHECK(wide.area() == kWidth * kHeight);
  const Drawn none([&](Canvas& canvas) {
    for (const double odd : {kNan, kInfinity}) {
      canvas.fill_convex(std::array<PixelPoint, 3>{{{0, 0}, {odd, 10}, {10, 0}}}, kBlue);
      canvas.fill_disc({odd, 10}, 5, kBlue);
      canvas.fill_disc({10, 10}, odd, kBlue);
    }
    canvas.fill_disc({-1e9, 10}, 5, kBlue);
  });
  CHECK(none.area() == 0);
}

TEST_CASE("text is as wide as it says, and lies where it is told") {
  constexpr const char* kText = "Hill 0.25";
  const double width = Canvas::text_width(kText);
  CHECK(Canvas::text_width("") == 0);
  CHECK(width > 40);
  CHECK(width < 110);
  CHECK(Canvas::text_width("Hill 0.25Hill 0.25") == doctest::Approx(2 * width));
  const auto ink = [&](Align align, double x) {  // where it begins and ends
    const Drawn drawn([&](Canvas& canvas) { canvas.text({x, 40}, align, kText, kBlue); });
    CHECK(drawn.area(0, 32, kWidth, 48) == doctest::Approx(drawn.area()));  // at mid height
    CHECK(drawn.area(0, 32, kWidth, 36) > 0);
    int first = kWidth, last = -1;
    for (int column = 0; column < kWidth; ++column)
      if (drawn.area(column, 0, column + 1, kHeight) > 0.05) {
        first = std::min(first, column);
        last = column + 1;
      }
    return std::array<int, 2>{first, last};
  };
  constexpr double kBearing = 2.5;  // pixels that a letter leaves free on its sides
  for (const auto& [align, x] : {std::pair(Align::left, 5.0), std::pair(Align::centre, 5 + width / 2),
                                 std::pair(Align::right, 5 + width)}) {
    const auto [first, last] = ink(align, x);
    CHECK(std::abs(first - 5) <= kBearing);
    CHECK(std::abs(last - (5 + width)) <= kBearing);
  }
}

TEST_CASE("letters that are not ASCII are drawn as themselves") {
  const auto pixels = [](const char* text) {
    return Drawn([&](Canvas& canvas) { canvas.text({10, 40}, Align::left, text, kBlue); }).pixel;
  };
  const std::vector<std::string> letters{"u", "µ", "°", "²", "³", "·", "é", "σ", "ж"};
  for (const std::string& a : letters)
    for (const std::string& b : letters) CHECK((pixels(a.c_str()) == pixels(b.c_str())) == (a == b));
}

TEST_CASE("text of any bytes is drawn, in every format") {
  using namespace std::string_literals;
  const std::string hard[] = {"",
                              "a\nb\tc\x7f",
                              "nul \0 nul"s,
                              "\xff\xfe",
                              "cut \xc3",
                              "cut \xf0\x9f\x98",
                              "overlong \xc0\xaf",
                              "surrogate \xed\xa0\x80",
                              "no character \xef\xbf\xbf \xef\xb7\x90",
                              "beyond \xf4\x90\x80\x80",
                              "\u200f\u202e right to left \u05d0",
                              "<b> & \"quoted\" ]]>",
                              std::string(5000, 'x')};
  for (const auto format : {PictureFormat::png, PictureFormat::pdf, PictureFormat::svg})
    for (const std::string& text : hard) {
      CAPTURE(text);
      CHECK(std::isfinite(Canvas::text_width(text)));
      const std::string file = written(format, [&](Canvas& canvas) {
        canvas.set_title(text);
        canvas.text({10, 40}, Align::left, text);
        canvas.fill_disc({50, 40}, 20, kBlue);
      });
      if (format == PictureFormat::svg)
        CHECK(pugi::xml_document().load_string(file.c_str()).status == pugi::status_ok);
      else
        CHECK(file.starts_with(format == PictureFormat::pdf ? "%PDF" : "\x89PNG"));
    }
}

TEST_CASE("bytes that are no characters show as such, and control characters as blanks") {
  using namespace std::string_literals;
  const std::vector<std::pair<std::string, std::string>> known{{"a\xff"
                                                                "b",
                                                                "a\uFFFDb"},
                                                               {"a\xfe\xff"
                                                                "b",
                                                                "a\uFFFD\uFFFDb"},
                                                               {"cut \xc3", "cut \uFFFD"},
                                                               {"a\xef\xbf\xbf"
                                                                "b",
                                                                "a\uFFFDb"},
                                                               {"a\xef\xbf\xbe"
                                                                "b",
                                                                "a\uFFFDb"},
                                                               {"a\xef\xb7\x90"
                                                                "b",
                                                                "a\uFFFDb"},
                                                               {"a\xef\xb7\xaf"
                                                                "b",
                                                                "a\uFFFDb"},
                                                               {"a\x01\x1f\x7f"
                                                                "b",
                                                                "a   b"},
                                                               {"a\0b"s, "a b"},
                                                               {"a\xc2\x80\xc2\x9f"
                                                                "b",
                                                                "a  b"},
                                                               {"a !~\u00a0\u00a1b", "a !~\u00a0\u00a1b"}};
  for (const auto& [bytes, shown] : known) {
    CAPTURE(shown);
    const std::string file = written(PictureFormat::svg, [&](Canvas& canvas) {
      canvas.set_title(bytes);
      canvas.text({10, 40}, Align::left, bytes);
    });
    pugi::xml_document svg;
    REQUIRE(svg.load_string(file.c_str()).status == pugi::status_ok);
    CHECK(svg.child("svg").child("title").text().as_string() == shown);
    CHECK(svg.select_node("//text").node().text().as_string() == shown);
    CHECK(Canvas::text_width(bytes) == Canvas::text_width(shown));
  }
}

TEST_CASE("an SVG has its shapes as paths and its text as text") {
  const std::string file = written(PictureFormat::svg, [](Canvas& canvas) {
    canvas.set_title("Steel & glass");
    canvas.fill_convex(std::array<PixelPoint, 3>{{{10, 10}, {50, 10}, {10, 50}}}, kBlue);
    canvas.fill_convex(std::array<PixelPoint, 3>{{{60, 10}, {90, 10}, {60, 50}}}, kBlue);
    canvas.text({60, 60}, Align::centre, "σ < 3 µm²", kBlue);
  });
  pugi::xml_document svg;
  REQUIRE(svg.load_string(file.c_str()).status == pugi::status_ok);
  CHECK(svg.child("svg").attribute("width").as_string() == std::string("120px"));
  CHECK(svg.child("svg").first_child().name() == std::string("title"));
  CHECK(svg.child("svg").child("title").text().as_string() == std::string("Steel & glass"));
  const auto text = svg.select_node("//text").node();
  CHECK(text.text().as_string() == std::string("σ < 3 µm²"));
  const double width = text.attribute("textLength").as_double();
  CHECK(width == doctest::Approx(Canvas::text_width("σ < 3 µm²")).epsilon(0.001));
  CHECK(text.attribute("x").as_double() == doctest::Approx(60 - width / 2).epsilon(0.001));
  CHECK(svg.select_nodes("//image").empty());
  std::size_t of_blue = 0;
  for (const auto& path : svg.select_nodes("//path"))
    of_blue +=
        std::string(path.node().attribute("style").as_string()).find("fill:rgb(15.68") != std::string::npos
            ? 1u
            : 0u;
  CHECK(of_blue == 1);  // both in one
}

TEST_CASE("a PDF is one page without an image or a date, and has its title") {
  const auto draw = [](Canvas& canvas) {
    canvas.set_title("Ellipses");
    canvas.fill_disc({50, 40}, 20, kBlue);
    canvas.text({10, 70}, Align::left, "Ellipses");
  };
  const std::string file = written(PictureFormat::pdf, draw);
  CHECK(file.starts_with("%PDF-"));
  CHECK(file.find("/Count 1\n") != std::string::npos);
  CHECK(file.find("/Title (Ellipses)") != std::string::npos);
  CHECK(file.find("/Image") == std::string::npos);
  CHECK(file.find("Date") == std::string::npos);
  CHECK(file == written(PictureFormat::pdf, draw));
}

TEST_CASE("the name of a file tells its format") {
  CHECK(picture_format("a/b.png") == PictureFormat::png);
  CHECK(picture_format("b.svg") == PictureFormat::svg);
  CHECK(picture_format("b.x.pdf") == PictureFormat::pdf);
  CHECK_FALSE(picture_format("b.jpg"));
  CHECK_FALSE(picture_format("pdf"));
}

TEST_CASE("a canvas that Cairo cannot hold is refused") { CHECK_THROWS(Canvas(200000, 10)); }

TEST_CASE("a disc shows where none before it covers all of it") {
  Cover cover(kWidth, kHeight);
  CHECK(cover.add({40, 40}, 10));
  CHECK_FALSE(cover.add({42, 40}, 7));
  CHECK(cover.add({42, 40}, 9));
  CHECK_FALSE(cover.add({40, 40}, 10));
  CHECK_FALSE(cover.add({-50, 40}, 10));  // outside
  CHECK(cover.add({0, 0}, 10));
  CHECK(cover.add({1e9, 40}, 2e9));
  CHECK_FALSE(cover.add({100, 70}, 5));
}
