#pragma once

/// @file The parts of a study file: what read_axes.cpp offers to read_study.cpp.

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/keys/fields.hpp"
#include "study.hpp"

namespace mpmfast {

std::optional<Formula> read_formula(const Value& value);
/// Replaces `out` when the key is there and good.
void read_formula(MapReader& map, const std::string& key, std::optional<Formula>& out);

/// `set`: {dotted key: value}.
std::vector<Setting> read_settings(MapReader& map);

/// `only`: {axis: value} or {axis: [values]}.
Only read_only(MapReader& map, const std::vector<Axis>& axes);

/// `scene`: a path from `folder`.
std::optional<std::filesystem::path> read_scene_path(MapReader& map, const std::filesystem::path& folder);

/// `vary`: a list holds values of the scene's key, a map holds named choices.
void read_axes(const Value& vary, const std::filesystem::path& folder, std::vector<Axis>& axes);

/// `only` of these choices, when all axes are known.
void read_only_of_axes(const Value& vary, std::vector<Axis>& axes);

/// `variants`. `vary` was read before, so that `only` can name its axes.
Axis read_variants(const Value& list, const std::vector<Axis>& axes);

/// `window`: [from, to].
void read_window(MapReader& map, std::optional<Formula>& from, std::optional<Formula>& to);

/// `holds`: a list of conditions.
std::vector<Condition> read_conditions(const Value& list, const std::vector<Axis>& axes);

/// `map`: {panels, columns, judged}.
MapSpec read_map(const Value& value, const std::vector<Axis>& axes);

/// The index of the axis that the value names.
std::optional<std::size_t> read_axis(const Value& value, const std::vector<Axis>& axes);

}  // namespace mpmfast
