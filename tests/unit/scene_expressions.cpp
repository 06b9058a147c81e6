#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "engine/errors.hpp"
#include "tests/unit/study_fixture.hpp"

using namespace study_test;

namespace {

Expression parsed(const std::string& text) {
  auto out = Expression::parse(text);
  const auto* wrong = std::get_if<std::string>(&out);
  REQUIRE_MESSAGE(wrong == nullptr, text << ": " << (wrong ? *wrong : ""));
  return std::get<Expression>(out);
}

double value(const std::string& text) { return evaluate(parsed(text), {}); }

/// What is wrong with the text; empty when nothing is.
std::string wrong(const std::string& text) {
  const auto out = Expression::parse(text);
  const auto* message = std::get_if<std::string>(&out);
  return message ? *message : "";
}

}  // namespace

TEST_CASE("an expression computes as in print: powers before signs, signs before products, from the left") {
  CHECK(value("1 + 2 * 3") == 7);
  CHECK(value("(1 + 2) * 3") == 9);
  CHECK(value("8 - 3 - 2") == 3);
  CHECK(value("8 / 4 / 2") == 1);
  CHECK(value("2 ^ 3 ^ 2") == 512);
  CHECK(value("-2 ^ 2") == -4);
  CHECK(value("2 ^ -1") == 0.5);
  CHECK(value("3 * -2") == -6);
  CHECK(value("- -+4") == 4);
  CHECK(value("1.5e3+.5") == 1500.5);
}

TEST_CASE("a number may carry a simple unit and is then in SI") {
  CHECK(value("5 mm") == doctest::Approx(0.005).epsilon(1e-15));
  CHECK(value("7.5 mm / 0.9622") == doctest::Approx(0.0075 / 0.9622).epsilon(1e-15));
  CHECK(value("2GPa") == 2e9);
  CHECK(value("3 us * 2") == doctest::Approx(6e-6).epsilon(1e-15));
  CHECK(value("(5 mm)^2") == doctest::Approx(25e-6).epsilon(1e-15));
}

TEST_CASE("the power of a unit is refused: it would be read as a power of the quantity") {
  CHECK(wrong("5 mm^2") == "a unit takes no power (write (5 mm)^2) at '^2'");
  CHECK(wrong("5 mm ^ 2") == "a unit takes no power (write (5 mm)^2) at '^ 2'");
}

TEST_CASE("an amount carries its unit through the arithmetic, a plain value does not") {
  const auto amount = [](const std::string& text) {
    const auto out = parsed(text).amount({});
    return std::holds_alternative<Amount>(out) ? amount_text(std::get<Amount>(out))
                                               : std::get<std::string>(out);
  };
  CHECK(value("5 mm + 2 s") == 2.005);
  CHECK(amount("5 mm + 2 s") == "a time cannot be added to a length");
  CHECK(amount("5 mm + 2 m") == "2.005 m");
  CHECK(amount("6 m / 2 s") == "3 m/s");
  CHECK(amount("2 kg * (3 m)^2 / (1 s)^2 / (1 m)^3") == "18 Pa");
  CHECK(amount("2 K * 3 kg") == "6 kg*K");
  CHECK(amount("(4 m)^-0.5 * 1") == "a length to the power -0.5 has no unit");
  CHECK(amount("sqrt((4 m)^2) + hypot(3 m, 4 m)") == "9 m");
  CHECK(amount("sin(90 deg) + step(2 m) + cos(0)") == "3");
  CHECK(amount("atan2(1 m, 1 m) * 4") == fmt::format("{} rad", std::numbers::pi));
  CHECK(amount("atan2(1 m, 1 s)") == "a time cannot be compared with a length");
  CHECK(amount("1 m / 0") == "division by zero");
  CHECK(amount("0 * -1") == "0");
}

TEST_CASE("a product has the units of its factors, whichever comes first, and a sum the radians of either") {
  const auto amount = [](const std::string& text) {
    const auto out = parsed(text).amount({});
    return std::holds_alternative<Amount>(out) ? amount_text(std::get<Amount>(out))
                                               : std::get<std::string>(out);
  };
  const std::vector<std::string> units{"m", "kg", "s", "K"};
  for (const std::string& a : units)
    for (const std::string& b : units) {
      CAPTURE(a);
      CAPTURE(b);
      CHECK(amount("2 " + a + " * 3 " + b) == amount("3 " + b + " * 2 " + a));
      CHECK(amount("6 * 1 " + a + " / 2 " + b) == amount("3 / (1 " + b + ") * 1 " + a));
      CHECK(amount("6 " + a + " * 1 " + b + " / 2 " + b) == "3 " + a);
      CHECK(amount("6 " + a + " / 2 " + b + " / 1 " + a + " * 1 " + b) == "3");
    }
  CHECK(amount("3 kg * 2 K") == "6 kg*K");
  CHECK(amount("2 J / 1 kg / 1 K * 3 kg * 4 K") == amount("24 J * 1"));
  CHECK(amount("24 J / 4 K * 1 K") == amount("6 J * 1"));
  CHECK(amount("2 rad * 3 / 1 s") == "6 rad/s");
  CHECK(amount("6 / 1 s * 1 rad") == "6 rad/s");
  for (const std::string sum :
       {"2 rad / 1 s + 1 / 1 s", "1 / 1 s + 2 rad / 1 s", "4 rad / 1 s - 1 / 1 s", "4 / 1 s - 1 rad / 1 s",
        "min(3 rad / 1 s, 7 / 1 s)", "max(1 rad / 1 s, 3 / 1 s)"})
    CHECK_MESSAGE(amount(sum) == "3 rad/s", sum);
  CHECK(amount("1 + 2 rad") == "3 rad");
  CHECK(amount("2 rad + 1") == "3 rad");
  CHECK(amount("1 K + 2 rad") == "an angle cannot be added to a temperature");
}

TEST_CASE("functions and pi are known to an expression") {
  CHECK(value("sin(pi / 6)") == doctest::Approx(0.5).epsilon(1e-15));
  CHECK(value("atan2(1, -1)") == doctest::Approx(0.75 * std::numbers::pi).epsilon(1e-15));
  CHECK(value("hypot(3, 4) + abs(-2)") == 7);
  CHECK(value("min(2, max(1, 5))") == 2);
  CHECK(value("step(0) + step(0.1)") == 1);
  CHECK(value("exp(log(3)) - sqrt(9)") == doctest::Approx(0).epsilon(1e-14));
  CHECK(value("erf(0) + tan(0) + atan(0) + cos(0)") == 1);
}

TEST_CASE("an expression runs over the columns of a table, and a constant stands before a column") {
  const Table table{{"time_s", "all.mean_stress_yy_Pa", "left-block.vx"},
                    {{0, 1, 2}, {-4e6, -5e6, 6e6}, {1, 2, 3}}};
  CHECK(evaluate(parsed("-all.mean_stress_yy_Pa / 1e6"), table, {}) == std::vector<double>{4, 5, -6});
  CHECK(evaluate(parsed("`left-block.vx` ^ 2 + time_s"), table, {}) == std::vector<double>{1, 5, 11});
  CHECK(evaluate(parsed("shift + time_s"), table, {{"shift", 10}}) == std::vector<double>{10, 11, 12});
  CHECK(evaluate(parsed("time_s"), table, {{"time_s", 7}}) == std::vector<double>{7, 7, 7});
  CHECK(parsed("time_s * time_s + `left-block.vx`").names() ==
        std::vector<std::string>{"time_s", "left-block.vx"});
  CHECK_THROWS_WITH_AS(evaluate(parsed("time"), table, {}), "no column 'time' for 'time'", FileError);
}

TEST_CASE("what is wrong with an expression is told with the place where it stops making sense") {
  CHECK(wrong("") == "a number or a name was expected at the end");
  CHECK(wrong("1 +") == "a number or a name was expected at the end");
  CHECK(wrong("2 * / 3") == "a number or a name was expected at '/ 3'");
  CHECK(wrong("(1 + 2") == "a ')' is missing at the end");
  CHECK(wrong("1 + 2)") == "an operator was expected at ')'");
  CHECK(wrong("a b") == "an operator was expected at 'b'");
  CHECK(wrong("5 parsecs") == "an operator or a unit was expected at 'parsecs'");
  CHECK(wrong("`a") == "a closing '`' is missing at '`a'");
  CHECK(wrong("1e999") == "not a number at '1e999'");
  CHECK(wrong("atan2(1)") == "atan2 takes 2 arguments at ')'");
  CHECK(wrong("sin(1, 2)") == "a ')' is missing after the argument of sin at ', 2)'");
  CHECK(wrong("sqr(4)").find("no function 'sqr' (one of abs, sqrt") == 0);
  CHECK(wrong("sqr(4)").find("Did you mean 'sqrt'?") != std::string::npos);
  CHECK(wrong(std::string(100, '(') + "1").find("nested too deeply") == 0);
  CHECK(wrong(std::string(60, '(') + "1" + std::string(60, ')')).empty());
}

TEST_CASE("a table is read with quoted cells and without a torn last line") {
  const StudyFolder folder;
  const auto file = folder.path() / "table.csv";
  write_text(file, "time_s,\"a, \"\"b\"\"\"\r\n0, 1.5 \r\n1,-2e3\n2,3");
  const Table table = read_table(file, Unended::torn);
  CHECK(table.names == std::vector<std::string>{"time_s", "a, \"b\""});
  CHECK(table.columns == std::vector<std::vector<double>>{{0, 1}, {1.5, -2000}});
  CHECK(table.find("absent") == nullptr);
}

TEST_CASE("a table that a person wrote has its last line, also from a spreadsheet") {
  const StudyFolder folder;
  const auto file = folder.path() / "table.csv";
  write_text(file, "\xEF\xBB\xBFtime_s,force\r\n0,+1.5\r\n1,-2e3");
  const Table table = read_table(file, Unended::whole);
  CHECK(table.names == std::vector<std::string>{"time_s", "force"});
  CHECK(table.columns == std::vector<std::vector<double>>{{0, 1}, {1.5, -2000}});
  write_text(file, "a\n+-1\n");
  CHECK_THROWS_AS(read_table(file, Unended::whole), FileError);
}

TEST_CASE("a table with a ragged row, a word or no header is refused with its line") {
  const StudyFolder folder;
  const auto file = folder.path() / "table.csv";
  const auto says = [&](const std::string& text) -> std::string {
    write_text(file, text);
    try {
      read_table(file, Unended::whole);
    } catch (const FileError& error) {
      return std::string(error.what()).substr(file.string().size());
    }
    return "";
  };
  CHECK(says("a,b\n1,2\n3\n") == ":3: 1 cells, but 2 in the header");
  CHECK(says("a,b\n1,x\n") == ":2: not a number, got 'x'");
  CHECK(says("a,b\n1,\n") == ":2: not a number, got ''");
  CHECK(says("") == ": no header");
  CHECK_THROWS_WITH_AS(read_table("/dev/zero", Unended::whole),
                       "/dev/zero: cannot read the table: it is not a file but a device, a pipe or a socket",
                       FileError);
}
