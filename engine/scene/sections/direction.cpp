#include <algorithm>

#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

constexpr Keyword<Vec3> kDirections[] = {
    {{1, 0, 0}, "x", ""},   {{0, 1, 0}, "y", ""},     {{0, 0, 1}, "z", ""},     {{1, 0, 0}, "+x", ""},
    {{0, 1, 0}, "+y", ""},  {{0, 0, 1}, "+z", ""},    {{-1, 0, 0}, "-x", ""},   {{0, -1, 0}, "-y", ""},
    {{0, 0, -1}, "-z", ""}, {{-1, 0, 0}, "left", ""}, {{1, 0, 0}, "right", ""}, {{0, -1, 0}, "down", ""},
    {{0, 1, 0}, "up", ""},  {{0, 0, -1}, "in", ""},   {{0, 0, 1}, "out", ""},
};

}  // namespace

void take_unit_vector(Slot& slot, int dimension, Vec3& direction) {
  if (!slot.take(direction, Vector{Measure::number, dimension}) || !slot.reads()) return;
  const auto unit = unit_vector(direction);
  if (!unit) slot.report("the zero vector has no direction");
  direction = unit.value_or(Vec3{});
}

void describe_direction(Slot& slot, int dimension, bool any, Vec3& direction) {
  std::vector<Keyword<Vec3>> known;
  for (const Keyword<Vec3>& named : kDirections)
    if (dimension == 3 || named.value[2] == 0 || slot.describes()) known.push_back(named);
  const auto name = std::find_if(known.begin(), known.end(),
                                 [&](const Keyword<Vec3>& named) { return named.value == direction; });
  const bool by_vector = slot.reads() ? slot.value()->is(Node::Kind::list) : name == known.end();
  if (any && (slot.describes() || by_vector)) take_unit_vector(slot, dimension, direction);
  if (any && by_vector && !slot.describes()) return;
  auto index = static_cast<std::size_t>(name - known.begin());
  if (slot.choose(index, known) && slot.reads()) direction = known[index].value;
}

}  // namespace mpmfast
