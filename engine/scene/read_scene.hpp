#pragma once

/// @file YAML → Scene.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/scene.hpp"
#include "engine/scene/text/diagnostic.hpp"

namespace mpmfast {

/// Dotted path and the YAML text that replaces its scalar (list entries by index: bodies.0.velocity).
using Override = std::pair<std::string, std::string>;

/// Reads and validates a scene. Throws SceneError with every error found, FileError when it cannot be read.
/// @param warnings  where it is given: what in a good scene is likely a mistake
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                 std::vector<Diagnostic>* warnings = nullptr);

/// The same from text; `file` is the name that messages show and the folder that relative paths start from.
Scene parse_scene(const std::string& text, const std::filesystem::path& file,
                  const std::vector<Override>& overrides = {}, std::vector<Diagnostic>* warnings = nullptr);

}  // namespace mpmfast
