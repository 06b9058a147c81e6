#include "engine/scene/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "engine/errors.hpp"
#include "engine/scene/include.hpp"
#include "engine/scene/sections.hpp"
#include "engine/scene/suggest.hpp"
#include "engine/scene/variables.hpp"

namespace mpmfast {

namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;  // bytes

/// ". Did you mean …?" of the files beside one that is not there.
std::string file_hint(const std::filesystem::path& file) {
  constexpr std::size_t kMostLooked = 1000;
  std::vector<std::string> known;
  std::error_code error;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string kind = entry.path().extension().string();
    if (kind == ".yaml" || kind == ".yml") known.push_back(entry.path().filename().string());
    if (known.size() == kMostLooked) break;
  }
  std::sort(known.begin(), known.end());
  const std::string meant = closest(file.filename().string(), known);
  return meant.empty() ? "" : fmt::format(". Did you mean '{}'?", (file.parent_path() / meant).string());
}

std::string read_text(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) -> FileError {
    return FileError(fmt::format("{}: cannot read the scene: {}", file.string(), why));
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw refuse("no such file" + file_hint(file));
  if (std::filesystem::is_directory(file, error)) throw refuse("it is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw refuse("it cannot be opened");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > kLargestFile) throw refuse("it is larger than 16 MiB");
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw refuse("reading failed");
  return text;
}

void read_head(MapReader& top, Scene& scene) {
  scene.title = scene.file.stem().string();
  if (const auto title = top.find("title")) scene.title = title->text().value_or("");
  const auto space = top.need("space", "plane_strain, plane_stress, axisymmetric or 3d");
  if (space && (space->node().scalar == "2d" || space->node().scalar == "2D"))  // no words that are known
    space->complain("not known here (one of plane_strain, plane_stress, axisymmetric, 3d)",
                    "plane_strain is the usual one of two dimensions");
  else if (space)
    scene.space = space->word(kSpaces).value_or(Space::plane_strain);
  const bool solid = scene.dimension() == 3, turned = scene.space == Space::axisymmetric;
  if (!solid && !turned) {
    top.quantity("thickness", Measure::length, kPositive, scene.thickness);
  } else if (const auto thickness = top.find("thickness")) {
    thickness->report(solid ? "a 3-D scene has no thickness"
                            : "an axisymmetric scene has no thickness: it is whole round its axis");
  }
}

/// What the readers see: with included files merged in, overrides in place and expressions computed.
std::optional<Node> read_tree(const std::string& text, const std::filesystem::path& file,
                              const std::vector<Override>& overrides, Problems& problems) {
  std::optional<Node> root = parse_tree(text, 0, problems);
  if (!root) return root;
  const auto apply = [&](bool includes) {
    for (std::size_t k = 0; k < overrides.size(); ++k) {
      const auto& [path, value] = overrides[k];
      if ((path.substr(0, path.find('.')) == "include") == includes)
        apply_override(*root, path, value, static_cast<int>(k) + 1, problems);
    }
  };
  apply(true);
  merge_includes(*root, file, problems);
  const auto used = names_in_expressions(*root);  // also what an override takes the place of
  apply(false);
  if (root->kind == Node::Kind::map) expand_variables(*root, problems, used);
  return root;
}

void read_sections(const Node& root, Scene& scene, Problems& problems) {
  MapReader top(Value(root, "", problems), "a map {title, space, grid, time, materials, bodies, …}");
  if (!top.valid()) return;
  if (index_of(root, "scene") >= 0 && index_of(root, "bodies") < 0)
    return top.value().report("this is a study, not a scene", "Run it with 'mpmfast study'");
  {
    const Silence early(problems.recorder());                        // the schema has them from elsewhere
    for (const char* key : {"include", "variables"}) top.find(key);  // done with (read_tree)
  }
  read_head(top, scene);
  const int dimension = scene.dimension();
  const bool grid_known = read_grid(top, dimension, scene.grid);
  read_time(top, scene.time);
  const bool strain_stated = read_method(top, scene.method);
  read_contact(top, dimension, strain_stated, scene.method.strain, scene.contact);
  read_gravity(top, dimension, scene.gravity);
  read_output(top, dimension, scene.output);
  read_materials(top, scene.materials);
  read_bodies(top, grid_known, scene);
  read_contact_pairs(top, scene);
  read_boundaries(top, grid_known, scene);
  if (scene.space == Space::plane_stress) check_plane_stress(top, scene);
  if (scene.space == Space::axisymmetric) check_axisymmetric(top, grid_known, scene);
  if (grid_known && scene.grid.leaving == LeavingKind::wall) close_faces(top, scene);
  top.finish();
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides,
                 std::vector<Diagnostic>* warnings) {
  return parse_scene(read_text(file), file, overrides, warnings);
}

void record_scene(const std::string& text, const std::string& file, Recorder& recorder) {
  Problems problems({file});
  problems.set_recorder(&recorder);
  Scene scene;
  scene.file = file;
  if (const std::optional<Node> root = parse_tree(text, 0, problems)) read_sections(*root, scene, problems);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<Override>& overrides, std::vector<Diagnostic>* warnings) {
  std::vector<std::string> sources{file.string()};
  for (const auto& [path, value] : overrides) sources.push_back(fmt::format("--set {}={}", path, value));
  Problems problems(sources);
  Scene scene;
  scene.file = file;
  const auto root = read_tree(text, file, overrides, problems);
  if (root) read_sections(*root, scene, problems);
  if (!problems.empty()) throw SceneError(problems.sorted());
  if (warnings) {
    find_suspicions(*root, scene, problems);
    *warnings = problems.sorted();
  }
  scene.resolved_yaml = write_scene(scene);
  return scene;
}

}  // namespace mpmfast
