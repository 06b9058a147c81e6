#include "engine/scene/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "engine/errors.hpp"
#include "engine/geometry/read_regular.hpp"
#include "engine/scene/sections/describe.hpp"
#include "engine/scene/suspicions.hpp"
#include "engine/scene/text/include.hpp"
#include "engine/scene/text/suggest.hpp"
#include "engine/scene/text/variables.hpp"

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
  std::string why_not;
  if (auto text = read_regular(file, kLargestFile, why_not)) return *std::move(text);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) why_not += file_hint(file);
  throw FileError(fmt::format("{}: cannot read the scene: {}", file.string(), why_not));
}

/// What the sections see: with included files merged in, overrides in place and expressions computed.
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

/// @return the places of the bodies
std::vector<BodyLocation> read_sections(const Node& root, Scene& scene, Problems& problems) {
  Keys top(Value(root, "", problems), "a map {title, space, grid, time, materials, bodies, …}");
  if (!top.reader().valid()) return {};
  if (find_value(root, "scene") && !find_value(root, "bodies")) {
    top.report("this is a study, not a scene", "Run it with 'mpmfast study'");
    return {};
  }
  scene.title = scene.file.stem().string();
  return describe_scene(top, scene);
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides,
                 std::vector<Diagnostic>* warnings) {
  return parse_scene(read_text(file), file, overrides, warnings);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<Override>& overrides, std::vector<Diagnostic>* warnings) {
  std::vector<std::string> sources{file.string()};
  for (const auto& [path, value] : overrides) sources.push_back(fmt::format("--set {}={}", path, value));
  Problems problems(sources);
  Scene scene;
  scene.file = file;
  const auto root = read_tree(text, file, overrides, problems);
  const auto locations = root ? read_sections(*root, scene, problems) : std::vector<BodyLocation>();
  if (!problems.empty()) throw SceneError(problems.sorted());
  if (warnings) {
    find_suspicions(*root, scene, locations, problems);
    *warnings = problems.sorted();
  }
  scene.resolved_yaml = write_scene(scene);
  return scene;
}

}  // namespace mpmfast
