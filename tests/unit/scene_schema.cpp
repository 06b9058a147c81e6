/// What the reader says of itself: the recorder, its notes, and what is printed from them.

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "engine/scene/catalogue.hpp"
#include "engine/scene/recorder.hpp"
#include "engine/scene/schema/key_notes.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "scene_helpers.hpp"
#include "tests/source_folder.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A key, or what stands for keys of the user's choice: a pattern with a part of its own behind a point.
bool is_key(const std::string& pattern) {
  const std::string plain = unconditional(pattern);
  return !plain.empty() && plain.back() != ']' && pattern.back() != '>';
}

/// What is known of a pattern, but for its default, which depends on the other keys of a scene.
std::string summary(const Known& known) {
  std::string out;
  for (const Form& f : known.forms) {
    out += std::to_string(static_cast<int>(f.kind)) + " " + kind_of(f.measure).name + " " +
           std::to_string(f.least) + " " + std::to_string(f.most);
    if (!f.limit.moves) out += " " + std::to_string(f.limit.lower) + " " + std::to_string(f.limit.upper);
    out += "; ";
  }
  std::vector<std::string> names = known.keys;
  for (const KnownWord& word : known.words) names.push_back(word.name);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) out += name + " ";
  return out + (known.needed ? "needed " : "") + (known.closed ? "closed" : "");
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
                    two = replaced(plain, "material: b}\n",
                                   "material: b}\n  - {name: two, material: b, box: {from: [6 mm, 1 mm], "
                                   "to: [9 mm, 4 mm]}}\n");
  return {plain,
          plain + "boundaries: {left: {wall: sliding, at: surface}}\n",
          material("model: mie_gruneisen, density: 8, bulk: 1, " + heat + state),
          material("model: j2_plasticity, " + metal + heat + "equation_of_state: {" + state + "}"),
          material("model: johnson_cook, " + metal + heat +
                   "hardening: 1 GPa, exponent: 1, melt: 1300 K, equation_of_state: {" + state + "}"),
          plain + "gravity: {acceleration: [0, 1 m/s^2]}\ncontact: {}\nboundaries: {left: {piston: 1 m/s}}\n",
          plain + "contact: {" + bond + "}\n",
          replaced(plain, "material: b}", "material: b, rotation: {about: [0, 0]}}"),
          two + "contact: {pairs: [{between: [one, two], " + bond + "}]}\n",
          two + "contact: {pairs: [{between: [one, two]}]}\n",
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

/// Does the scene state this key? Of materials, only the first counts.
bool is_given(const std::string& text, const std::string& pattern, const std::string& key) {
  // `grid` is a key of `output`, too.
  const std::size_t output = text.find("\noutput:");
  if (pattern.starts_with("output."))
    return output != std::string::npos && holds(text.substr(output), key + ":");
  const std::size_t first = pattern.starts_with("materials") ? text.find("  a: {") : 0;
  const std::size_t end = pattern.starts_with("materials") ? text.find('\n', first) : text.size();
  return holds(text.substr(first, end - first), key + ":");
}

}  // namespace

TEST_CASE("every key that the reader knows has a note, and every note a key") {
  for (const auto& [pattern, known] : known_values()) {
    if (!is_key(pattern)) continue;
    CAPTURE(pattern);
    CHECK(note_on(pattern) != nullptr);
    const auto plain = known_values().find(unconditional(pattern));
    const bool reached =
        !known.forms.empty() || (plain != known_values().end() && !plain->second.forms.empty());
    CHECK_MESSAGE(reached, "no probe reaches the value");
  }
  for (const KeyNote& note : key_notes()) {
    CAPTURE(note.pattern);
    const auto& all = known_values();
    CHECK(std::any_of(all.begin(), all.end(), [&](const auto& entry) {
      return is_key(entry.first) && note_on(entry.first) == &note;
    }));
  }
}

TEST_CASE("no committed scene makes the reader ask for what the probes do not find") {
  int scenes = 0;
  for (const char* folder : {"configs", "configs/hard", "configs/bench"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      ++scenes;
      CAPTURE(entry.path().string());
      Recorder recorder = [] {
        Recorder out;
        record_probes(out);
        return out;
      }();
      record_scene(content(entry.path()), entry.path().string(), recorder);
      CHECK(recorder.found().size() == known_values().size());
      for (const auto& [pattern, known] : recorder.found()) {
        CAPTURE(pattern);
        const auto before = known_values().find(pattern);
        REQUIRE(before != known_values().end());
        CHECK(summary(before->second) == summary(known));
      }
    }
  }
  CHECK(scenes > 30);
}

TEST_CASE("a default, written out, changes nothing") {
  const std::vector<std::string> scenes = small_scenes();
  for (const auto& [pattern, known] : known_values()) {
    if (!known.standard) continue;
    const std::string path = path_of(pattern), key = path.substr(path.rfind('.') + 1);
    int tried = 0;
    for (const std::string& text : scenes) {
      const std::string file = (test::source_folder() / "configs/scene.yaml").string();
      Recorder own;  // has this scene such a key, and leaves it to its default?
      record_scene(text, file, own);
      const auto here = own.found().find(pattern);
      if (here == own.found().end() || !here->second.standard || is_given(text, pattern, key)) continue;
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
  for (const auto& [pattern, known] : known_values()) {
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

TEST_CASE("the committed page is what the program prints") {
  const std::string committed = content(test::source_folder() / "tools/manual/scene.md");
  CHECK_MESSAGE(committed == write_reference(),
                "write it again: build/ci/mpmfast schema --markdown > tools/manual/scene.md");
}
