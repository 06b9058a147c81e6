#include <doctest/doctest.h>

#include <filesystem>

#include "scene_helpers.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

/// A folder with the files of a scene.
class SceneFolder {
 public:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const auto file = folder_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Scene read(const std::string& name, const std::vector<Override>& overrides = {}) const {
    return read_scene(folder_.path() / name, overrides);
  }
  /// All that is wrong, without the folder.
  std::string faults(const std::string& name, const std::vector<Override>& overrides = {}) const {
    try {
      read(name, overrides);
    } catch (const SceneError& error) {
      std::string text = error.what();
      const std::string folder = folder_.path().string() + "/";
      for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
        text.erase(at, folder.size());
      return text;
    }
    return "good";
  }

 private:
  output_test::TemporaryFolder folder_;
};

const std::string kSteel =
    "materials:\n"
    "  steel: {model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}\n";

/// The plain scene without its materials, its first line an include.
std::string without_materials(const std::string& include) {
  return "include: " + include + "\n" + replaced(plain_scene(), kSteel, "");
}

}  // namespace

TEST_CASE("an included file gives what the scene leaves out, key by key, and the scene wins") {
  const SceneFolder folder;
  folder.write("lib/steel.yaml", kSteel + "  lead: {model: rigid}\ntime: {end: 5 us, cfl: 0.3}\n");
  folder.write("scene.yaml", without_materials("lib/steel.yaml") + "materials: {lead: {density: 2}}\n");
  const Scene scene = folder.read("scene.yaml");
  REQUIRE(scene.materials.size() == 2);
  CHECK(std::get<LinearElastic>(scene.materials[0].model).young == 210e9);
  CHECK(std::get<Rigid>(scene.materials[1].model).density == 2);
  CHECK(scene.time.end == 1e-6);
  CHECK(scene.time.cfl == 0.3);
  CHECK_FALSE(holds(scene.resolved_yaml, "include"));
  CHECK(parse_scene(scene.resolved_yaml, "elsewhere/scene.yaml").resolved_yaml == scene.resolved_yaml);
}

TEST_CASE("of several included files the later wins, lists are replaced as a whole") {
  const SceneFolder folder;
  folder.write("a.yaml", kSteel + "time: {end: 5 us, cfl: 0.3}\ngravity: [1, 2]\n");
  folder.write("b.yaml", "time: {cfl: 0.4}\ngravity: [3, 4]\n");
  folder.write("scene.yaml", without_materials("[a.yaml, b.yaml]"));
  CHECK(folder.read("scene.yaml").time.cfl == 0.4);
  CHECK(folder.read("scene.yaml").gravity.acceleration == Vec3{3, 4, 0});
  CHECK(folder.read("scene.yaml", {{"include", "[b.yaml, a.yaml]"}}).time.cfl == 0.3);
  CHECK(folder.read("scene.yaml", {{"include.1", "a.yaml"}}).time.cfl == 0.3);
  CHECK(folder.read("scene.yaml", {{"time.cfl", "0.2"}}).time.cfl == 0.2);
}

TEST_CASE("included variables serve the scene, may be set by it, and need not all be used") {
  const SceneFolder folder;
  folder.write("lib.yaml", kSteel + "variables: {dx: 1 mm, half: \"${dx/2}\", other: 3}\n");
  folder.write("scene.yaml", replaced(without_materials("lib.yaml"), "cell: 1 mm", "cell: ${half}"));
  CHECK(folder.read("scene.yaml").grid.cell == 0.0005);
  folder.write("own.yaml", replaced(without_materials("lib.yaml"), "cell: 1 mm", "cell: ${half}") +
                               "variables: {dx: 2 mm}\n");
  CHECK(folder.read("own.yaml").grid.cell == 0.001);
  CHECK(folder.read("own.yaml", {{"variables.dx", "4 mm"}}).grid.cell == 0.002);
}

TEST_CASE("what is wrong in an included file is told with its name, line and column") {
  const SceneFolder folder;
  folder.write("lib/steel.yaml", replaced(kSteel, "210 GPa", "210 GPA"));
  folder.write("scene.yaml", without_materials("lib/steel.yaml") + "outptu: 1\n");
  CHECK(folder.faults("scene.yaml") ==
        "scene.yaml:7:1: outptu: unknown key. Did you mean 'output'?\n"
        "lib/steel.yaml:2:63: materials.steel.young: unknown unit 'GPA' (a pressure: Pa, kPa, MPa, GPa), got "
        "'210 "
        "GPA'. Did you mean 'GPa'?");
  folder.write("lib/steel.yaml", "materials: [\n");
  CHECK(holds(folder.faults("scene.yaml"), "lib/steel.yaml:1:12: not valid YAML: this '[' is not closed"));
  folder.write("lib/steel.yaml", "# nothing\n");
  CHECK(holds(folder.faults("scene.yaml"), "lib/steel.yaml: empty (a map of sections was expected)"));
  folder.write("lib/steel.yaml", "- 1\n");
  CHECK(holds(folder.faults("scene.yaml"),
              "lib/steel.yaml:1:1: not a map of sections such as materials, got a list of 1"));
}

TEST_CASE("a file that cannot be included is named where it is asked for") {
  const SceneFolder folder;
  folder.write("scene.yaml", without_materials("[nowhere.yaml, ., {a: 1}, \"${x}\", /dev/zero]"));
  const std::string text = folder.faults("scene.yaml", {{"materials", "{steel: {model: rigid}}"}});
  CHECK(holds(text, "scene.yaml:1:11: include.0: cannot include nowhere.yaml: no such file"));
  CHECK(holds(text, "scene.yaml:1:25: include.1: cannot include "));
  CHECK(holds(text, ": it is a folder"));
  CHECK(holds(text, "include.2: not a file name or a list of file names, got a map"));
  CHECK(holds(text, "include.3: cannot include ${x}: no such file. Its name takes no variables"));
  CHECK(holds(text, "include.4: cannot include /dev/zero: it is not a file but a device"));
}

TEST_CASE("files that include each other are refused, and so are too many and too deep ones") {
  const SceneFolder folder;
  folder.write("scene.yaml", without_materials("scene.yaml") + kSteel);
  CHECK(folder.faults("scene.yaml") ==
        "scene.yaml:1:10: include: cannot include scene.yaml: it includes this file, or is it");
  folder.write("a.yaml", "include: sub/../b.yaml\n");
  folder.write("b.yaml", "include: a.yaml\n");
  folder.write("scene.yaml", without_materials("a.yaml") + kSteel);
  CHECK(folder.faults("scene.yaml") ==
        "b.yaml:1:10: include: cannot include a.yaml: it includes this file, or is it");
  folder.write("d.yaml", "gravity: [0, 1]\n");
  folder.write("a.yaml", "include: d.yaml\n");
  folder.write("b.yaml", "include: d.yaml\n");
  folder.write("scene.yaml", without_materials("[a.yaml, b.yaml]") + kSteel);
  CHECK(folder.faults("scene.yaml") == "good");  // twice the same is no circle
  for (int k = 0; k < 9; ++k)
    folder.write("n" + std::to_string(k) + ".yaml", "include: n" + std::to_string(k + 1) + ".yaml\n");
  folder.write("n9.yaml", kSteel);
  folder.write("scene.yaml", without_materials("n1.yaml"));
  CHECK(holds(folder.faults("scene.yaml"),
              "n8.yaml:1:10: include: cannot include n9.yaml: nested too deeply (at most 8"));
  folder.write("scene.yaml", without_materials("n2.yaml"));
  CHECK(folder.faults("scene.yaml") == "good");
  std::string many = "[a.yaml";
  for (int k = 0; k < 64; ++k) many += ", d.yaml";
  folder.write("scene.yaml", without_materials(many + "]") + kSteel);
  CHECK(holds(folder.faults("scene.yaml"), "too many files (at most 64)"));
}

TEST_CASE("included files may not be large in all") {
  const SceneFolder folder;
  folder.write("a.yaml", "title: " + std::string(9 << 20, 'x') + "\n");
  folder.write("scene.yaml", without_materials("[a.yaml, a.yaml]") + kSteel);
  CHECK(holds(folder.faults("scene.yaml"),
              "include.1: cannot include a.yaml: larger than 16 MiB, with the files before it"));
  std::string values = "gravity: [1";
  for (int k = 0; k < 150000; ++k) values += ",1";
  folder.write("a.yaml", values + "]\n");
  CHECK(holds(folder.faults("scene.yaml"), "include.1: cannot include a.yaml: too much in all"));
}

TEST_CASE("pictures and surfaces that an included file names lie beside it") {
  const SceneFolder folder;
  folder.write("lib/bodies.yaml",
               "bodies:\n  - {bitmap: grains.png, extent: [1 mm, 1 mm], material: steel}\n");
  folder.write("scene.yaml",
               "include: lib/bodies.yaml\nspace: plane_strain\ngrid: {size: [10 mm, 20 mm], cell: 1 mm}\n"
               "time: {end: 1 us}\n" +
                   kSteel);
  CHECK(folder.faults("scene.yaml") ==
        "lib/bodies.yaml:2:14: bodies.0.bitmap: cannot read the image lib/grains.png: no such file, got "
        "'grains.png', "
        "which is 'lib/grains.png'");
  folder.write("lib/bodies.yaml", "bodies:\n  - {stl: {file: part.stl, scale: 1 mm}, material: steel}\n");
  CHECK(holds(folder.faults("scene.yaml", {{"space", "3d"}, {"grid.size", "[1, 1, 1]"}}),
              "cannot read the surface lib/part.stl"));
}

TEST_CASE("sixty-four files may be included, and not one more") {
  const SceneFolder folder;
  folder.write("a.yaml", "gravity: [0, 1]\n");
  std::string names = "[a.yaml";
  for (int k = 1; k < 64; ++k) names += ", a.yaml";
  folder.write("scene.yaml", without_materials(names + "]") + kSteel);
  CHECK(folder.faults("scene.yaml") == "good");
  folder.write("scene.yaml", without_materials(names + ", a.yaml]") + kSteel);
  CHECK(holds(folder.faults("scene.yaml"), "include.64: cannot include a.yaml: too many files (at most 64)"));
}
