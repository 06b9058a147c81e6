#include <algorithm>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

struct NamedDirection {
  const char* name;
  int axis;
  double sign;
};
constexpr NamedDirection kDirections[] = {
    {"x", 0, 1},     {"y", 1, 1},     {"z", 2, 1},   {"+x", 0, 1},  {"+y", 1, 1},
    {"+z", 2, 1},    {"-x", 0, -1},   {"-y", 1, -1}, {"-z", 2, -1}, {"left", 0, -1},
    {"right", 0, 1}, {"down", 1, -1}, {"up", 1, 1},  {"in", 2, -1}, {"out", 2, 1},
};

}  // namespace

void describe_direction(Slot& slot, int dimension, bool any, Vec3& direction) {
  std::vector<std::string> known;
  std::vector<Vec3> vectors;
  for (const NamedDirection& named : kDirections) {
    if (named.axis >= dimension && !slot.tells()) continue;
    known.emplace_back(named.name);
    vectors.push_back({});
    vectors.back()[static_cast<std::size_t>(named.axis)] = named.sign;
  }
  const auto name = std::find(vectors.begin(), vectors.end(), direction);
  const bool by_vector = slot.reads() ? slot.value()->is(Node::Kind::list) : name == vectors.end();
  if (any && (slot.tells() || by_vector)) {
    const bool good = slot.take(direction, Vector{Measure::number, dimension});
    if (slot.reads() && good) {
      const auto unit = unit_vector(direction);
      if (!unit) slot.report("the zero vector has no direction");
      direction = unit.value_or(Vec3{});
    }
    if (!slot.tells()) return;
  }
  std::string word = name == vectors.end() ? "" : known[static_cast<std::size_t>(name - vectors.begin())];
  if (!slot.take(word, known) || !slot.reads()) return;
  direction = vectors[static_cast<std::size_t>(std::find(known.begin(), known.end(), word) - known.begin())];
}

}  // namespace mpmfast
