#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/geometry/load.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

constexpr int kLevels = 256;

/// A grey level that heads a material, as a value.
std::optional<int> read_level(const Slot& material, const Key& key,
                              const std::array<bool, kLevels>& present) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.location = key.location;
  node.scalar = key.text;
  const Value level(node, material.value()->path(), material.value()->problems());
  const auto number = level.integer(0, kLevels - 1);
  if (number && !present[static_cast<std::size_t>(*number)])
    level.report("the image has no such grey level, or it is skipped");
  return number;
}

void describe_materials(Keys& map, const std::vector<std::string>& names,
                        const std::array<bool, kLevels>& present, BitmapEntry& entry) {
  map.allow_other_keys();
  const std::size_t count = map.count(entry.materials.size());
  entry.materials.resize(map.reads() ? 0 : count);
  for (std::size_t k = 0; k < count; ++k) {
    std::pair<std::string, int> one = map.reads() ? std::pair<std::string, int>{} : entry.materials[k];
    std::optional<int> level = 0;
    const bool good = map.entry(k, "GREY", "The material of this grey level.", one.first, [&](Slot& slot) {
      if (slot.reads()) level = read_level(slot, map.reader().value().node().keys[k], present);
      slot.reference(one.second, names);
    });
    if (!map.reads() || !level) continue;
    if (!good) one.second = -1;
    entry.materials.push_back(one);
  }
}

}  // namespace

void describe_file(Slot& slot, const Scene& scene, std::filesystem::path& file) {
  std::string text = file.string();
  if (slot.take(text, Text{}) && slot.reads())
    file = std::filesystem::absolute(scene.file.parent_path() / text).lexically_normal();
}

namespace {

/// Of the pictures of a scene, which keep a byte each.
constexpr std::size_t kMostPixelsInAll = std::size_t{1} << 28;

/// Of all pictures so far; the levels of one follow each other.
std::size_t pixels_so_far(const Scene& scene) {
  std::size_t sum = 0;
  const GreyImage* last = nullptr;
  for (const BodySpec& body : scene.bodies) {
    const auto* bitmap = std::get_if<BitmapShape>(&body.shape);
    const GreyImage* image = bitmap ? bitmap->image.get() : nullptr;
    if (image && image != last) sum += image->pixel.size();
    last = image;
  }
  return sum;
}

}  // namespace

void describe_bitmap(Slot& slot, const Scene& scene, BitmapEntry& entry) {
  std::filesystem::path& file = entry.shape.file;
  constexpr const char* kDescription = "Path, counted from the folder of the scene.";
  const bool map = slot.is_map(false, [&](Keys& keys) {
    keys.need_at("file", kDescription, "an 8-bit grey PNG file",
                 [&](Slot& inner) { describe_file(inner, scene, file); });
  });
  if (!map && slot.reads() && !slot.value()->is(Node::Kind::scalar))
    return slot.complain("not a file name (an 8-bit grey PNG)");
  if (!map) describe_file(slot, scene, file);
  if (!slot.reads() || !slot.good()) return;
  std::string why_not;
  entry.shape.image = load_grey_png(file, why_not);
  if (!entry.shape.image)
    return slot.complain(fmt::format("cannot read the image {}: {}", file.string(), why_not));
  if (pixels_so_far(scene) + entry.shape.image->pixel.size() <= kMostPixelsInAll) return;
  entry.shape.image.reset();
  slot.complain(fmt::format("the images of the scene have more than {} pixels in all", kMostPixelsInAll));
}

void describe_bitmap_keys(Keys& body, const Scene& scene, const std::vector<std::string>& material_names,
                          BitmapEntry& entry) {
  Vec3 extent = entry.extent;
  body.derived_at("origin", "Lower left corner of the picture; that of the grid if not given.",
                  [&](Slot& slot) {
                    slot.take(entry.shape.lower, Vector{Measure::length, 2});
                  });
  if (body.reads() && !body.stated("origin")) entry.shape.lower = scene.grid.origin;
  body.need("extent", "Width and height that the picture is stretched over.", extent,
            Vector{Measure::length, 2, kPositive});
  entry.extent = extent;
  body.at("skip", "Grey levels that are empty, such as 255.", [&](Slot& slot) {
    std::size_t count = entry.skip.size();
    slot.list("a list of grey levels", 0, Form::kNoEnd, count, [&](Slot& item, std::size_t k) {
      int level = item.writes() ? entry.skip[k] : 0;
      if (item.take(level, Whole{0, kLevels - 1}) && item.reads()) entry.skip.push_back(level);
    });
  });
  std::array<bool, kLevels> present{};
  present.fill(true);  // when the image is unknown, so is what it lacks
  if (entry.shape.image) present = entry.shape.image->levels();
  for (const int level : entry.skip) present[static_cast<std::size_t>(level)] = false;
  for (int level = 0; body.reads() && entry.shape.image && level < kLevels; ++level)
    if (present[static_cast<std::size_t>(level)]) entry.levels.push_back(level);
  body.section("materials", "Materials of single grey levels.", "a map {GREY: NAME}",
               [&](Keys& map) { describe_materials(map, material_names, present, entry); });
}

namespace {

/// The extent that, added to `lower`, rounds to `upper` again.
double extent_between(double lower, double upper) {
  const double extent = upper - lower;
  double more = extent, less = extent;
  for (int tries = 0; tries < 8; ++tries) {
    if (lower + more == upper) return more;
    if (lower + less == upper) return less;
    more = std::nextafter(more, kInfinity);
    less = std::nextafter(less, 0.0);
  }
  return extent;
}

/// The entry of the bodies first … last − 1, the grey levels of one bitmap.
BodyEntry bitmap_entry(const Scene& scene, std::size_t first, std::size_t last) {
  BodyEntry entry;
  entry.body = scene.bodies[first];
  BodySpec& body = entry.body;
  entry.bitmap.shape = std::get<BitmapShape>(body.shape);
  const BitmapShape& shape = entry.bitmap.shape;
  const std::string suffix = fmt::format("_{}", shape.grey);
  const auto own = [&](const BodySpec& level) { return level.field == level.name; };
  const auto at = [&](std::size_t b) { return scene.bodies.begin() + static_cast<std::ptrdiff_t>(b); };
  if (std::all_of(at(first), at(last), own)) body.field.clear();
  body.name.erase(body.name.size() - suffix.size());
  entry.bitmap.extent = {extent_between(shape.lower[0], shape.upper[0]),
                         extent_between(shape.lower[1], shape.upper[1]), 0};
  std::array<bool, 256> skipped = shape.image->levels();
  for (std::size_t b = first; b < last; ++b) {
    const int grey = std::get<BitmapShape>(scene.bodies[b].shape).grey;
    skipped[static_cast<std::size_t>(grey)] = false;
    entry.bitmap.materials.emplace_back(std::to_string(grey), scene.bodies[b].material);
  }
  for (int grey = 0; grey < 256; ++grey)
    if (skipped[static_cast<std::size_t>(grey)]) entry.bitmap.skip.push_back(grey);
  return entry;
}

}  // namespace

std::vector<BodyEntry> entries_of(const Scene& scene) {
  std::vector<BodyEntry> out;
  for (std::size_t first = 0, last = 0; first < scene.bodies.size(); first = last) {
    const auto* bitmap = std::get_if<BitmapShape>(&scene.bodies[first].shape);
    last = first + 1;
    if (!bitmap) {
      out.push_back({scene.bodies[first], {}, true, true});
      continue;
    }
    for (; last < scene.bodies.size(); ++last) {
      const auto* next = std::get_if<BitmapShape>(&scene.bodies[last].shape);
      if (!next || next->image != bitmap->image) break;
    }
    out.push_back(bitmap_entry(scene, first, last));
  }
  return out;
}

}  // namespace mpmfast
