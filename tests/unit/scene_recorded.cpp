/// The reader of scenes, held against tables in tests/recorded: what it makes of a scene, says of a doubtful
/// one and refuses, whole.

#include <fmt/ranges.h>

#include "engine/scene/keys/known.hpp"
#include "engine/scene/text/tree.hpp"
#include "recorded_table.hpp"
#include "tests/support.hpp"

using namespace mpmfast;
using namespace mpmfast::test;
using namespace mpmfast::test::recorded;

TEST_CASE("lines of a table agree where their words do and their numbers nearly") {
  CHECK(same_line("at 1.5e-07 m, of 3", "at 1.5000001e-07 m, of 3"));
  CHECK_FALSE(same_line("at 1.5e-07 m", "at 1.50001e-07 m"));
  CHECK_FALSE(same_line("at 1.5e-07 m", "at 1.5e-07 s"));
  CHECK_FALSE(same_line("at 1", "at -1"));
  CHECK_FALSE(same_line("of 3", "of 3 m"));
  CHECK_FALSE(same_line("of 3 and", "of 3"));
  CHECK_FALSE(same_line("0", "1e-12"));
}

namespace {

std::vector<std::string> resolved(const Scene& scene) { return lines_of(scene.resolved_yaml); }

}  // namespace

TEST_CASE("scenes with every key are read and written whole, with every default") {
  check_table("reader_scenes.txt", resolved, Warnings::shown);
}

TEST_CASE("space, grid, time and gravity are read as they stand, and refused with what is wrong") {
  check_table("reader_head.txt", resolved, Warnings::shown);
}

TEST_CASE("materials are read as they stand, and refused with what is wrong") {
  check_table("reader_materials.txt", resolved, Warnings::shown);
}

TEST_CASE("bodies are read as they stand, and refused with what is wrong") {
  check_table("reader_bodies.txt", resolved, Warnings::shown);
}

TEST_CASE("boundaries are read as they stand, and refused with what is wrong") {
  check_table("reader_boundaries.txt", resolved, Warnings::shown);
}

TEST_CASE("methods are read as they stand, and refused with what is wrong") {
  check_table("reader_method.txt", resolved, Warnings::shown);
}

TEST_CASE("contact is read as it stands, and refused with what is wrong") {
  check_table("reader_contact.txt", resolved, Warnings::shown);
}

TEST_CASE("laws of contact are read as they stand, and refused with what is wrong") {
  check_table("reader_bonds.txt", resolved, Warnings::shown);
}

TEST_CASE("cracks are read as they stand, and refused with what is wrong") {
  check_table("reader_cracks.txt", resolved, Warnings::shown);
}

TEST_CASE("heat is read as it stands, and refused with what is wrong") {
  check_table("reader_heat.txt", resolved, Warnings::shown);
}

TEST_CASE("output is read as it stands, and refused with what is wrong") {
  check_table("reader_output.txt", resolved, Warnings::shown);
}

TEST_CASE("words of other programs, and keys of other sections, are told with what they are here") {
  check_table("reader_words.txt", resolved, Warnings::shown);
}

TEST_CASE("axisymmetric scenes are read as they stand, and refused with what is wrong") {
  check_table("reader_axis.txt", resolved, Warnings::shown);
}

TEST_CASE("variables, overrides, included files and YAML are read, and refused with what is wrong") {
  check_table("reader_text.txt", resolved, Warnings::shown);
}

TEST_CASE("good scenes that are likely mistakes are told, on one side of each limit") {
  check_table("reader_doubts.txt", resolved, Warnings::shown);
}

namespace {

const char* kind_text(Form::Kind kind) {
  constexpr const char* kKinds[] = {"word", "truth", "whole",  "quantity", "table", "points",
                                    "text", "name",  "vector", "list",     "map"};
  return kKinds[static_cast<std::size_t>(kind)];
}

std::string form_text(const Form& form) {
  std::string text = kind_text(form.kind);
  if (form.measure != Measure::number) text += fmt::format(" {}", noun_of(form.measure));
  if (form.along != Measure::number) text += fmt::format(" along {}", noun_of(form.along));
  if (std::isfinite(form.limit.lower) || std::isfinite(form.limit.upper))
    text += fmt::format(" in {}{:g}, {:g}{}{}", form.limit.lower_open ? "(" : "[", form.limit.lower,
                        form.limit.upper, form.limit.upper_open ? ")" : "]",
                        form.limit.moves ? " which moves" : "");
  if (form.least != 0 || form.most != Form::kNoEnd)
    text +=
        fmt::format(", {} to {}", form.least, form.most == Form::kNoEnd ? "any" : std::to_string(form.most));
  return text;
}

/// All that the reader tells of the keys of a scene.
std::vector<std::string> known_lines() {
  std::vector<std::string> lines;
  for (const auto& [pattern, known] : known_values()) {
    std::string line = pattern.empty() ? "(the scene)" : pattern;
    if (known.needed) line += ", needed";
    for (const Form& form : known.forms) line += "; " + form_text(form);
    if (known.standard) line += fmt::format("; default {}", *known.standard);
    if (known.varies) line += ", which varies";
    if (!known.keys.empty()) line += fmt::format("; keys {}", fmt::join(known.keys, " "));
    if (known.closed) line += ", no others";
    for (const auto& group : known.one_of) line += fmt::format("; either {}", fmt::join(group, " and "));
    for (const KnownKeyword& word : known.words) line += fmt::format("; '{}'", word.name);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace

TEST_CASE("what the reader tells of its keys is what is recorded: forms, limits, words, defaults, groups") {
  const std::vector<std::string> lines = known_lines();
  check_lines_of("reader_keys.txt", lines);
}

TEST_CASE("pictures beside an included file are found where its folder is called like an expression") {
  const Folder place;
  const std::filesystem::path inner = place / "${a}" / "x${b}y${c";
  std::filesystem::create_directories(inner);
  std::filesystem::copy_file(recorded::folder() / "grains.png", inner / "grains.png");
  std::ofstream(inner / "part.yaml")
      << "bodies: [{name: grain, bitmap: grains.png, extent: [4 mm, 4 mm], skip: [255], material: rubber}]\n";
  const std::string text =
      "include: part.yaml\nspace: plane_strain\ngrid: {size: [8 mm, 8 mm], cell: 0.5 mm}\ntime: {end: 2 us}\n"
      "materials: {rubber: {model: neo_hookean, density: 1.2 g/cm^3, young: 80 MPa, poisson: 0.33}}\n";
  const Scene scene = parse_scene(text, inner / "scene.yaml");
  REQUIRE(scene.bodies.size() == 3);
  CHECK(std::get<BitmapShape>(scene.bodies[0].shape).file == inner / "grains.png");
  CHECK(parse_scene(scene.resolved_yaml, "/another/scene.yaml").resolved_yaml == scene.resolved_yaml);
}

TEST_CASE("a tree has the size of all its values and keys, and the depth of its deepest branch") {
  const auto size = [](const std::string& text) {
    Problems problems({"text"});
    const auto root = parse_tree(text, 0, problems);
    REQUIRE(root);
    return size_of(*root);
  };
  const TreeSize mixed = size("[[[1], 22], {a: {bc: [3]}}, 4]");
  CHECK(mixed.nodes == 12);  // six lists and maps, four scalars, two keys
  CHECK(mixed.text == 8);
  CHECK(mixed.levels == 4);
  CHECK(size("{a: {bc: [3]}, d: [1]}").levels == 3);
  CHECK(size("[1, [2]]").levels == 2);
  CHECK(size("[[2], 1]").levels == 2);
  CHECK(size("one").levels == 0);
  CHECK(size("one").nodes == 1);
}
