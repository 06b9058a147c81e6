/// What the descriptions of keys tell: all that a scene may say, and what is printed from it.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "engine/scene/catalogue.hpp"
#include "engine/scene/keys/known.hpp"
#include "engine/scene/schema/known_keys.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "engine/scene/text/problems.hpp"
#include "engine/scene/text/tree.hpp"
#include "scene_helpers.hpp"
#include "tests/sanitized.hpp"
#include "tests/source_folder.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The pattern without its conditions.
std::string unconditional(const std::string& pattern) {
  return std::regex_replace(pattern, std::regex("<[^>]*>"), "");
}

/// A key, or what stands for keys of the user's choice: a pattern with a part of its own behind a point.
bool is_key(const std::string& pattern) {
  const std::string plain = unconditional(pattern);
  return !plain.empty() && plain.back() != ']' && pattern.back() != '>';
}

std::string pattern_part(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Scenes that between them have every map that holds a key with a default.
std::vector<std::string> small_scenes() {
  const std::string metal = "density: 8 g/cm^3, bulk: 100 GPa, shear: 40 GPa, yield: 1 GPa, ",
                    state = "gruneisen: 2, hugoniot_slope: 1.5", heat = "heat_capacity: 400 J/kg/K, ";
  const auto material = [](const std::string& text) {
    return "space: plane_strain\ngrid: {size: [10 mm, 10 mm], cell: 1 mm}\ntime: {end: 1 us}\n"
           "materials:\n  a: {" +
           text +
           "}\n  b: {model: neo_hookean, density: 1, bulk: 1, shear: 1}\n"
           "bodies:\n  - {name: one, box: {from: [1 mm, 1 mm], to: [4 mm, 4 mm]}, material: b}\n"
           "method: {}\noutput: {checkpoint: {}}\n";
  };
  const auto solid = [](const std::string& shape, const std::string& space) {
    const std::string size = space == "3d" ? "[20 mm, 20 mm, 20 mm]" : "[20 mm, 20 mm]";
    return "space: " + space + "\ngrid: {size: " + size +
           ", cell: 1 mm}\ntime: {end: 1 us}\n"
           "materials: {a: {model: neo_hookean, density: 1, bulk: 1, shear: 1}}\n"
           "bodies:\n  - {name: one, " +
           shape + ", material: a}\n";
  };
  const std::string plain = material("model: rigid"),
                    bond = "law: adhesion, normal_strength: 1, shear_strength: 1",
                    joint = "law: interface, normal_stiffness: 1, shear_stiffness: 1",
                    curves =
                        "law: nonlinear_interface, normal_curve: [[0, 0], [1, 1]], shear_curve: [[0, 0]]",
                    glue =
                        "law: cohesive, normal_strength: 1, shear_strength: 1, normal_toughness: 1, "
                        "shear_toughness: 1",
                    two = replaced(plain, "material: b}\n",
                                   "material: b}\n  - {name: two, material: b, box: {from: [6 mm, 1 mm], "
                                   "to: [9 mm, 4 mm]}}\n");
  const auto cracked = [&](const std::string& law) {
    return plain + "cracks: [{body: one, line: [[0, 2 mm], [3 mm, 2 mm]]" + law + "}]\n";
  };
  const auto pressed = [](const std::string& place) {
    return "loads: {pressure: [{body: one, value: 1, where: {" + place + "}}]}\n";
  };
  return {plain,
          plain + "boundaries: {left: {wall: sliding, at: surface}}\n",
          material("model: mie_gruneisen, density: 8, bulk: 1, " + heat + state),
          material("model: j2_plasticity, " + metal + heat + "equation_of_state: {" + state + "}"),
          material("model: johnson_cook, " + metal + heat +
                   "hardening: 1 GPa, exponent: 1, melt: 1300 K, equation_of_state: {" + state + "}"),
          material("model: drucker_prager, density: 1, bulk: 1, shear: 1, friction_angle: 30 deg"),
          plain + "gravity: {acceleration: [0, 1 m/s^2]}\ncontact: {}\nboundaries: {left: {piston: 1 m/s}}\n",
          plain + pressed("ellipse: {centre: [0, 0], radii: [1, 1]}"),
          solid("box: {from: [1 mm, 1 mm, 1 mm], to: [4 mm, 4 mm, 4 mm]}", "3d") +
              pressed("ellipsoid: {centre: [0, 0, 0], radii: [1, 1, 1]}"),
          plain + "contact: {" + bond + "}\n",
          replaced(plain, "method: {}", "method: {basis: bspline2, extension: {}}"),
          replaced(plain, "method: {}", "method: {basis: lcpdi, split: {}}"),
          replaced(plain, "material: b}", "material: b, rotation: {about: [0, 0]}}"),
          two + "contact: {pairs: [{between: [one, two], " + bond + "}]}\n",
          plain + "contact: {" + joint + "}\n",
          plain + "contact: {" + curves + "}\n",
          two + "contact: {pairs: [{between: [one, two], " + curves + "}]}\n",
          plain + "contact: {" + glue + ", crack: {from: [0, 0], to: [1, 1]}}\n",
          two + "contact: {pairs: [{between: [one, two], " + glue + "}]}\n",
          two + "contact: {pairs: [{between: [one, two], " + joint + "}]}\n",
          two + "contact: {pairs: [{between: [one, two]}]}\n",
          two + "contact: {family: penalty}\n",
          cracked(""),
          cracked(", " + bond),
          cracked(", " + joint),
          cracked(", " + curves),
          cracked(", " + glue),
          replaced(cracked(", " + glue + ", growth: {}"), "model: rigid",
                   "model: neo_hookean, density: 1, bulk: 1, shear: 1"),
          replaced(solid("box: {from: [1 mm, 1 mm], to: [4 mm, 4 mm]}", "plane_strain"), "shear: 1}",
                   "shear: 1, heat_capacity: 1}") +
              "  - {name: two, box: {from: [4 mm, 1 mm], to: [8 mm, 4 mm]}, material: a}\n"
              "heat: {}\ncontact: {pairs: [{between: [one, two]}]}\n",
          solid("ellipse: {centre: [5 mm, 5 mm], radii: [2 mm, 3 mm]}", "plane_strain"),
          solid("ellipsoid: {centre: [5 mm, 5 mm, 5 mm], radii: [2 mm, 3 mm, 3 mm]}", "3d"),
          replaced(solid("stl: {file: ball.stl, scale: 1 mm}", "3d"), "grid: {",
                   "grid: {origin: [-10 mm, -10 mm, -10 mm], ")};
}

/// The path of a pattern in the small scenes.
std::string path_of(const std::string& pattern) {
  std::string path = unconditional(pattern);
  path = pattern_part(path, "[]", ".0");
  path = pattern_part(path, "materials.NAME", "materials.a");
  return pattern_part(path, "boundaries.FACE", "boundaries.left");
}

/// Does the scene, with every default, have this key?
bool has_key(const std::string& resolved, const std::string& path) {
  Problems problems({"resolved"});
  const auto root = parse_tree(resolved, 0, problems);
  const Node* node = root ? &*root : nullptr;
  for (std::size_t begin = 0; node && begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string part = path.substr(begin, end - begin);
    const int index = part == "0" ? 0 : index_of(*node, part);
    const bool there = index >= 0 && static_cast<std::size_t>(index) < node->items.size();
    node = there ? &node->items[static_cast<std::size_t>(index)] : nullptr;
    begin = end + 1;
  }
  return node;
}

/// Does the scene state this key? Of materials, only the first counts.
bool is_given(const std::string& text, const std::string& pattern, const std::string& key) {
  // `grid` is a key of `output`, too.
  const std::size_t output = text.find("\noutput:");
  if (pattern.starts_with("output."))
    return output != std::string::npos && holds(text.substr(output), key + ":");
  const std::size_t first = pattern.starts_with("materials") ? text.find("  a: {") : 0;
  const std::size_t end = pattern.starts_with("materials") ? text.find('\n', first) : text.size();
  return first == std::string::npos || holds(text.substr(first, end - first), key + ":");
}

/// Does the scene state the section that this path leads into?
bool has_section(const std::string& text, const std::string& path) {
  const std::size_t point = path.find('.');
  return point == std::string::npos || holds(text, "\n" + path.substr(0, point) + ":");
}

}  // namespace

TEST_CASE("every key says what it means, and what its value may be") {
  CHECK(known_values().size() > 200);
  for (const auto& value : known_values()) {
    const auto& pattern = value.first;
    const auto& known = value.second;
    if (!is_key(pattern)) continue;
    CAPTURE(pattern);
    CHECK(known.description.ends_with('.'));
    const auto plain = known_values().find(unconditional(pattern));
    const bool formed =
        !known.forms.empty() || (plain != known_values().end() && !plain->second.forms.empty());
    CHECK(formed);
  }
}

TEST_CASE("a default, written out, changes nothing" * doctest::skip(sanitized())) {
  const std::vector<std::string> scenes = small_scenes();
  for (const auto& value : known_values()) {
    const auto& pattern = value.first;
    const auto& known = value.second;
    if (!known.standard) continue;
    const std::string path = path_of(pattern), key = path.substr(path.rfind('.') + 1);
    int tried = 0;
    for (const std::string& text : scenes) {
      const std::string file = (test::source_folder() / "configs/scene.yaml").string();
      if (!has_section(text, path) || is_given(text, pattern, key) ||
          !has_key(parse_scene(text, file).resolved_yaml, path))
        continue;
      ++tried;
      CAPTURE(path);
      CAPTURE(text);
      std::string standard = *known.standard;
      if (holds(text, "space: 3d") && !holds(pattern, "translate"))  // a vector has a component more there
        standard = pattern_part(pattern_part(standard, "0 m]", "0 m, 0 m]"), "0 m/s]", "0 m/s, 0 m/s]");
      std::string with;
      try {
        with = parse_scene(text, file, {{path, standard}}).resolved_yaml;
      } catch (const SceneError& error) {
        with = error.what();
      }
      CHECK(with == parse_scene(text, file).resolved_yaml);
    }
    CAPTURE(pattern);
    CHECK(tried > 0);
  }
}

TEST_CASE("all that mpmfast list names is in the schema and on the page") {
  const std::string schema = write_schema(), page = write_reference();
  for (const std::string& topic : catalogue_topics()) {
    for (const CatalogueEntry& entry : catalogue(topic)) {
      std::string word = pattern_part(entry.name, "(m)", "(5)");
      if (holds(word, "{")) continue;  // a map: its keys follow
      CAPTURE(word);
      CHECK(holds(schema, "\"" + word + "\""));
      CHECK(holds(page, "`" + entry.name + "`"));
    }
  }
}

TEST_CASE("every key of the reader is in the schema and on the page") {
  const std::string schema = write_schema(), page = write_reference();
  for (const auto& value : known_values()) {
    const auto& pattern = value.first;
    const auto& known = value.second;
    for (const std::string& key : known.keys) {
      if (key == "FACE" || key == "NAME" || key == "GREY") continue;
      CAPTURE(pattern);
      CAPTURE(key);
      CHECK(holds(schema, "\"" + key + "\""));
      const bool on_page = holds(page, "`" + key + "`") || holds(page, "." + key + "`");
      CHECK(on_page);
    }
  }
}

TEST_CASE("a key that every body may have stands beside the shapes, one of a bitmap beside the bitmap") {
  const std::string page = write_reference();
  const std::size_t beside_shape = page.find("Beside the shape:"),
                    beside_bitmap = page.find("Beside a `bitmap`:");
  REQUIRE(beside_bitmap < page.size());
  const std::string every = page.substr(beside_shape, beside_bitmap - beside_shape);
  const std::string bitmap = page.substr(beside_bitmap, page.find("\n## ", beside_bitmap) - beside_bitmap);
  for (const KnownKey& key : all_keys("bodies[]")) {
    const auto& shapes = known_at("bodies[]").one_of;
    if (std::any_of(shapes.begin(), shapes.end(), [&](const auto& group) { return group[0] == key.name; }))
      continue;
    CAPTURE(key.name);
    const std::string row = "\n| `" + key.name + "` |";
    CHECK(holds(every, row) == (key.condition != "bitmap"));
    CHECK(holds(bitmap, row) == (key.condition == "bitmap"));
  }
}

TEST_CASE("the committed page is what the program prints") {
  const std::string committed = content(test::source_folder() / "tools/manual/scene.md");
  CHECK_MESSAGE(committed == write_reference(),
                "write it again: build/ci/mpmfast schema --markdown > tools/manual/scene.md");
}
