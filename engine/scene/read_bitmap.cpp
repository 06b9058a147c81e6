#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr int kLevels = 256;

/// The path as written, or {file: …}; made absolute from the folder of the scene.
std::optional<std::filesystem::path> image_path(const Value& bitmap, const Scene& scene) {
  std::optional<std::string> text;
  if (bitmap.is(Node::Kind::map)) {
    MapReader map(bitmap);
    const auto file = map.need("file", "an 8-bit grey PNG file");
    if (file) text = file->text();
    map.finish();
  } else if (bitmap.is(Node::Kind::scalar)) {
    text = bitmap.text();
  } else {
    bitmap.complain("not a file name (an 8-bit grey PNG)");
  }
  if (!text) return std::nullopt;
  return std::filesystem::absolute(scene.file.parent_path() / *text).lexically_normal();
}

std::array<bool, kLevels> levels_of(const GreyImage& image) {
  std::array<bool, kLevels> present{};
  for (const unsigned char grey : image.pixel) present[grey] = true;
  return present;
}

/// Levels that are empty space.
void remove_skipped(MapReader& body, std::array<bool, kLevels>& present) {
  const auto skip = body.find("skip");
  if (!skip) return;
  if (!skip->is_list()) return skip->complain("not a list of grey levels");
  for (std::size_t k = 0; k < skip->size(); ++k) {
    if (const auto level = skip->item(k).integer(0, kLevels - 1))
      present[static_cast<std::size_t>(*level)] = false;
  }
}

std::map<int, Value> materials_by_level(MapReader& body, const std::array<bool, kLevels>& present) {
  std::map<int, Value> out;
  const auto section = body.find("materials");
  if (!section) return out;
  MapReader map(*section, "a map {GREY: NAME}");
  if (!map.valid()) return out;
  for (std::size_t k = 0; k < section->size(); ++k) {
    const Key& key = section->node().keys[k];
    const Value material = section->entry(k, "GREY");
    material.offers_name();
    Node level_node;
    level_node.kind = Node::Kind::scalar;
    level_node.place = key.place;
    level_node.scalar = key.text;
    const Value level_value(level_node, material.path(), section->problems());
    const Silence of_the_key(section->problems().recorder());
    const auto level = level_value.integer(0, kLevels - 1);
    if (!level) continue;
    if (!present[static_cast<std::size_t>(*level)]) {
      level_value.report("the image has no such grey level, or it is skipped");
    }
    out.emplace(*level, material);
  }
  return out;
}

}  // namespace

std::vector<BitmapPart> read_bitmap(MapReader& body, const Value& bitmap, const Scene& scene) {
  BitmapShape shape;
  const auto path = image_path(bitmap, scene);
  const When beside(body.value(), "bitmap");
  const auto extent_value = body.need("extent", "a list of 2 lengths");
  const auto extent = extent_value ? extent_value->vector(Measure::length, 2, kPositive) : std::nullopt;
  const auto origin_value = body.find("origin");
  const auto origin = origin_value ? origin_value->vector(Measure::length, 2) : scene.grid.origin;
  if (path) {
    std::string why_not;
    shape.file = *path;
    shape.image = load_grey_png(*path, why_not);
    if (!shape.image) bitmap.complain(fmt::format("cannot read the image {}: {}", path->string(), why_not));
  }
  std::array<bool, kLevels> present{};
  present.fill(true);  // when the image is unknown, so is what it lacks
  if (shape.image) present = levels_of(*shape.image);
  remove_skipped(body, present);
  const std::map<int, Value> materials = materials_by_level(body, present);
  if (!shape.image || !extent || !origin) return {};
  shape.lower = *origin;
  shape.lower[2] = 0;
  shape.upper = {shape.lower[0] + (*extent)[0], shape.lower[1] + (*extent)[1], 0};
  std::vector<BitmapPart> parts;
  for (int level = 0; level < kLevels; ++level) {
    if (!present[static_cast<std::size_t>(level)]) continue;
    shape.grey = level;
    const auto material = materials.find(level);
    parts.push_back(
        {shape, material == materials.end() ? std::nullopt : std::optional<Value>(material->second)});
  }
  if (parts.empty()) bitmap.report("every grey level of the image is skipped");
  return parts;
}

}  // namespace mpmfast
