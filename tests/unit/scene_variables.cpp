#include <doctest/doctest.h>

#include <string>

#include "scene_helpers.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// The plain scene with variables on a line of their own at its end, line 8.
std::string with(const std::string& variables, const std::string& from, const std::string& to) {
  return replaced(plain_scene(), from, to) + "variables: {" + variables + "}\n";
}
std::string with_cell(const std::string& variables, const std::string& cell) {
  return with(variables, "cell: 1 mm", "cell: " + cell);
}

}  // namespace

TEST_CASE("a value may be a variable or arithmetic with its units") {
  CHECK(parse(with_cell("dx: 0.5 mm", "${dx}")).grid.cell == 0.0005);
  CHECK(parse(with_cell("dx: 1 mm", "${dx/2}")).grid.cell == 0.0005);
  CHECK(parse(with_cell("dx: 1/4 mm", "${ 2 * dx }")).grid.cell == 0.0005);
  CHECK(parse(with_cell("dx: 1 mm", "${min(dx, 2 mm)}")).grid.cell == 0.001);
  CHECK(parse(with_cell("speed: 5 m/s, t: 100 us", "${speed*t}")).grid.cell == 0.0005);
  CHECK(parse(with_cell("n: 5", "${10 mm/n}")).grid.cell == 0.002);
  CHECK(parse(with_cell("area: \"${(2 mm)^2}\"", "${sqrt(area)}")).grid.cell == 0.002);
  const Scene scene =
      parse(with("v: 100 m/s", "material: steel", "material: steel, velocity: [${-v}, ${9.81 m/s^2 * 2 s}]"));
  CHECK(scene.bodies[0].velocity == Vec3{-100, 19.62, 0});
  CHECK(parse(with("n: 3", "end: 1 us}", "end: 1 us}\noutput: {frames: ${2*n}}")).output.frames == 6);
}

TEST_CASE("a bare number is SI where one is expected, and zero has any unit") {
  CHECK(parse(with_cell("dx: 0.001", "${dx/2}")).grid.cell == 0.0005);
  CHECK(parse(with_cell("dx: 1 mm", "${max(0, dx)}")).grid.cell == 0.001);
}

TEST_CASE("a variable may be text, alone or within other text") {
  const Scene scene = parse(with("metal: steel, v: 0.5 km/s", "material: steel}",
                                 "material: ${metal}}\ntitle: ${metal} at ${v}, ${2*v}"));
  CHECK(scene.bodies[0].material == 0);
  CHECK(scene.title == "steel at 0.5 km/s, 1000 m/s");
}

TEST_CASE("variables may name each other in any order, but not themselves") {
  CHECK(parse(with_cell("half: \"${dx/2}\", dx: 1 mm", "${half}")).grid.cell == 0.0005);
  CHECK(fault(with_cell("a: \"${b}\", b: \"${2*a}\"", "${a}")) ==
        "scene.yaml:8:27: variables.b: a variable may not refer to itself (a → b → a), got '${2*a}'");
  CHECK(holds(fault(with_cell("a: \"${a + 1 mm}\"", "${a}")), "may not refer to itself (a → a)"));
}

TEST_CASE("arithmetic that mixes units is refused with their names") {
  const auto says = [](const std::string& cell) {
    return fault(with_cell("dx: 1 mm, v: 5 m/s, w: 3 rad/s", cell) + "title: ${dx} ${v} ${w}\n");
  };
  CHECK(holds(says("${dx + v}"), "scene.yaml:2:36: grid.cell: a velocity cannot be added to a length, got"));
  CHECK(holds(says("${dx - v}"), "a velocity cannot be subtracted from a length"));
  CHECK(holds(says("${max(dx, v)}"), "a velocity cannot be compared with a length"));
  CHECK(holds(says("${w*v}"), "grid.cell: 'm/s^2' is an acceleration"));
  CHECK(holds(says("${dx*v + w}"), "an angular velocity cannot be added to a quantity in m^2*s^-1"));
  CHECK(holds(says("${sin(dx)}"), "sin takes an angle, not a length"));
  CHECK(holds(says("${exp(v)}"), "exp takes a number, not a velocity"));
  CHECK(holds(says("${2^dx}"), "an exponent must be a number, not a length"));
  CHECK(holds(says("${sqrt(dx)}"), "a length to the power 0.5 has no unit"));
  CHECK(holds(says("${dx + 1}"), "a number cannot be added to a length"));
  CHECK(holds(says("${dx*v}"), "'m^2*s^-1' is not a unit of a length"));
}

TEST_CASE("a value of the wrong unit is shown as written and as computed") {
  CHECK(fault(with_cell("v: 5 m/s", "${2*v}")) ==
        "scene.yaml:2:36: grid.cell: 'm/s' is a velocity (a length: m, cm, mm, um), got '${2*v}', which is "
        "'10 m/s'");
}

TEST_CASE("radians count as numbers where they stand beside other units") {
  const Scene scene =
      parse(with("w: 10 rad/s, r: 2 mm, a: 30 deg", "material: steel",
                 "material: steel, velocity: [${w*r}, ${w^2*r * 1 s * sin(a)}], rotation: {about: "
                 "[2 mm, 2 mm], speed: ${w + 1 m/s/r}}"));
  CHECK(scene.bodies[0].velocity[0] == 0.02);
  CHECK(scene.bodies[0].velocity[1] == doctest::Approx(0.1).epsilon(1e-15));
  CHECK(scene.bodies[0].rotation->speed.value[0] == 510);
  CHECK(holds(fault(with("v: 1 m/s", "material: steel",
                         "material: steel, rotation: {about: [2 mm, 2 mm], speed: ${v/2 mm}}")),
              "'s^-1' is a rate (an angular velocity: rad/s, deg/s), got '${v/2 mm}', which is '500 s^-1'. "
              "Write rad/s, or "
              "multiply by 1 rad where it is computed"));
}

TEST_CASE("what cannot be computed is told once, where it stands") {
  CHECK(holds(fault(with_cell("dx: 1 mm", "${dy*dx}")),
              "no variable 'dy' (one of dx), got '${dy*dx}'. Did you mean 'dx'?"));
  CHECK(holds(fault(replaced(plain_scene(), "1 mm}", "${dx}}")),
              "scene.yaml:2:36: grid.cell: no variable 'dx' (the scene has no variables), got '${dx}'"));
  CHECK(holds(fault(with_cell("dx: 1 mm, n: 0", "${dx/n}")), "grid.cell: division by zero, got '${dx/n}'"));
  CHECK(holds(fault(with_cell("dx: 1e300 m", "${dx*1e300}")), "the result is not a finite number"));
  CHECK(holds(fault(with_cell("dx: 1 mm", "${log(-1)*dx}")), "the result is not a finite number"));
  CHECK(holds(fault(with_cell("dx: 1 mm", "${dx*}")),
              "not an expression: a number or a name was expected at the end"));
  CHECK(holds(fault(with_cell("dx: 1 mm", "${dx} ${}")),
              "nothing between '${' and '}' in '${}', got '${dx} ${}'"));
  CHECK(
      holds(fault(replaced(plain_scene(), "end: 1 us}", "end: \"${1 us\"}")), "a '}' is missing after '${'"));
  CHECK(holds(fault(with_cell("dx: steel", "${2*dx}")), "'dx' is no number but 'steel'"));
  CHECK(holds(fault(with_cell("dx: [1 mm]", "${dx}")),
              "variables.dx: not a number, a quantity or text, got a list of 1"));
  CHECK(holds(fault(with_cell("s: 2, dx: 1 mm", "${1 m/s + dx/s}")), "'s' is a variable and a unit"));
}

TEST_CASE("a variable that nobody uses is a mistake, and so is a name that no expression can hold") {
  CHECK(fault(plain_scene() + "variables: {dx: 1 mm}\n") ==
        "scene.yaml:8:13: variables.dx: nobody uses this variable");
  CHECK(holds(fault(with_cell("dx: 1 mm, dxx: 2 mm", "${dx}")),
              "variables.dxx: nobody uses this variable. Did you mean 'dx'?"));
  CHECK(holds(fault(with_cell("d-x: 1 mm", "1 mm")),
              "scene.yaml:8:13: variables.d-x: not a name for a variable"));
  CHECK(holds(fault(with_cell("pi: 3", "1 mm")), "variables.pi: pi is known already"));
  CHECK(holds(fault(plain_scene() + "variables: 3\n"), "variables: not a map of names and values"));
}

TEST_CASE("an override changes a variable before anything is computed, and may hold an expression") {
  const std::string text = with_cell("dx: 1 mm", "${dx/2}");
  CHECK(parse(text, {{"variables.dx", "2 mm"}}).grid.cell == 0.001);
  CHECK(parse(text, {{"time.end", "${3 us * dx/1 mm}"}}).time.end == doctest::Approx(3e-6).epsilon(1e-15));
  CHECK(fault(text, {{"variables.dxx", "2 mm"}}) ==
        "--set variables.dxx=2 mm: variables.dxx: nobody uses this variable. Did you mean 'dx'?");
  CHECK(fault(text, {{"variables.dx", "2 s"}}) ==
        "scene.yaml:2:36: grid.cell: 's' is a time (a length: m, cm, mm, um), got '${dx/2}', which is '1 s'");
}

TEST_CASE("the resolved scene has numbers and no variables, and text that looks like one survives") {
  const Scene scene = parse(with_cell("dx: 1 mm", "${dx/2}") + "title: $${dx} $$${dx} $ {\n");
  CHECK(scene.title == "${dx} $${dx} $ {");
  CHECK_FALSE(holds(scene.resolved_yaml, "variables"));
  const Scene again = parse(scene.resolved_yaml);
  CHECK(again.title == scene.title);
  CHECK(again.resolved_yaml == scene.resolved_yaml);
}

TEST_CASE("variables may not make endless text, nor long chains") {
  std::string text = plain_scene() + "title: ${x29}\nvariables:\n  x0: 0123456789\n";
  for (int k = 1; k < 30; ++k)
    text +=
        "  x" + std::to_string(k) + ": ${x" + std::to_string(k - 1) + "}${x" + std::to_string(k - 1) + "}\n";
  CHECK(holds(fault(text), "too much text (at most 16777216 bytes, expressions expanded)"));
  text = plain_scene() + "title: ${x0}\nvariables:\n";
  for (int k = 0; k < 999; ++k) text += "  x" + std::to_string(k) + ": ${x" + std::to_string(k + 1) + "}\n";
  CHECK(holds(fault(text + "  x999: 1\n"), "variables refer to each other over more than 32 steps"));
  CHECK(holds(fault(text + "  x999: 1\n  x1000: 1\n"), "1001 variables (at most 1000)"));
  CHECK(holds(fault(replaced(plain_scene(), "1 us", "${1" + std::string(1000, ' ') + "+1}")),
              "too long an expression"));
  CHECK(holds(fault(replaced(plain_scene(), "1 us", "${" + std::string(100, '(') + "1}")),
              "nested too deeply"));
  CHECK(holds(fault(replaced(plain_scene(), "1 us", "${((1 m)^50)^50}")), "has no unit"));
}

TEST_CASE("a variable that the file uses may be overridden away, one that nobody ever used stays a fault") {
  const std::string text = with_cell("dx: 0.5 mm", "${2*dx}");
  CHECK(parse(text, {{"grid.cell", "2 mm"}}).grid.cell == 0.002);
  CHECK(holds(fault(text, {{"variables.dy", "1 mm"}}), "nobody uses this variable. Did you mean 'dx'?"));
  CHECK(holds(fault(with_cell("dx: 1 mm", "1 mm") + "title: $${dx}\n", {{"grid.cell", "2 mm"}}),
              "nobody uses this variable"));
}

TEST_CASE("what begins like an expression and does not end on its side of a brace leaves the braces alone") {
  // The whole scene as one map in braces; of "$${" the scene takes "${" as it stands.
  const auto scene = [](const std::string& title) {
    return "{title: " + title +
           ", grid: {size: [10 mm, 20 mm], cell: 1 mm}, space: plane_strain,\n"
           "time: {end: 1 us}, materials: {steel: {model: linear_elastic, density: 7.85 g/cm^3, "
           "young: 210 GPa, poisson: 0.3}},\n"
           "bodies: [{box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}, material: steel}]}\n";
  };
  for (const char* quote : {"'", "\""}) {
    CAPTURE(quote);
    const auto quoted = [&](const std::string& text) { return scene(quote + text + quote); };
    CHECK(parse(quoted("five $${")).title == "five ${");
    CHECK(parse(quoted("$${a, b")).title == "${a, b");
    CHECK(parse(quoted("$${{a, b")).title == "${{a, b");
    CHECK(parse(quoted("$${a, b}")).title == "${a, b}");
    CHECK(parse(quoted("${min(1, 2)} of $${")).title == "1 of ${");
    CHECK(holds(fault(quoted("${a, b")), "scene.yaml:1:9: title: a '}' is missing after '${'"));
  }
}
