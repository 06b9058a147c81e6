// Names and texts on their way into a script for gnuplot.

#include <doctest/doctest.h>

#include "tests/unit/study_fixture.hpp"
#include "tools/study/gnuplot.hpp"

using namespace mpmfast;

TEST_CASE("a text in a script is one quoted word, whatever it holds") {
  CHECK(gnuplot_text("Mean stress (MPa), a+b.force_x_N") == "\"Mean stress (MPa), a+b.force_x_N\"");
  CHECK(gnuplot_text("'a' holds ''b''") == "\"'a' holds ''b''\"");
  CHECK(gnuplot_text("a\nb\tc\x7f") == "\"a b c \"");
  CHECK(gnuplot_text("\"; system 'x'; \"") == "\"\\042; system 'x'; \\042\"");
  CHECK(gnuplot_text("`x` @y \\") == "\"\\140x\\140 \\100y \\134\"");
  CHECK(gnuplot_text("$0 {12 \\061 }") == "\"\\044\\060 \\173\\061\\062 \\134\\060\\066\\061 \\175\"");
  CHECK(gnuplot_text("é") == "\"é\"");
  CHECK(gnuplot_tic("50 % of %s") == "\"50 %% of %%s\"");
}

TEST_CASE("no byte ends the quotes of a text, or begins what gnuplot substitutes") {
  for (int byte = 1; byte < 256; ++byte)
    for (const char* around : {"", "'", "\"", "\\", "0"}) {
      const std::string text = around + std::string(1, static_cast<char>(byte)) + around + "7";
      const std::string quoted = gnuplot_text(text);
      REQUIRE(quoted.size() >= 2);
      const std::string inside = quoted.substr(1, quoted.size() - 2);
      CAPTURE(byte);
      CHECK(quoted.front() == '"');
      CHECK(quoted.back() == '"');
      CHECK(inside.find_first_of("\"`@\n\r") == std::string::npos);
      for (std::size_t at = inside.find('\\'); at != std::string::npos; at = inside.find('\\', at + 1))
        CHECK(inside.substr(at + 1, 3).find_first_not_of("01234567") == std::string::npos);
    }
}

TEST_CASE("a script names its pictures plainly, or not after the user's words at all") {
  const output_test::TemporaryFolder folder;
  const auto script_of = [&](const std::string& stem) {
    draw_with_gnuplot({folder.path(), stem, "svg"}, "", "plot 1 title " + gnuplot_text("t"), 200, 100);
    return output_test::read_text(folder.path() / (stem + ".svg.gp"));
  };
  CHECK(script_of("figure-1").find("picture = 'figure-1'") != std::string::npos);
  for (const char* stem : {"|touch x", "a'b", "a b", "-", "$x", "`x`"}) {
    const std::string script = script_of(stem);
    CHECK_MESSAGE(script.find("picture = 'chart'") != std::string::npos, stem);
    CHECK_MESSAGE(script.find(stem + std::string(".svg")) == std::string::npos, stem);
  }
}
