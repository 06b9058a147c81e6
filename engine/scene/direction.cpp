#include <algorithm>
#include <cmath>

#include "engine/scene/sections.hpp"

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

std::optional<Vec3> unit_vector(const Vec3& vector) {
  const double longest = std::max({std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2])});
  if (longest == 0) return std::nullopt;
  Vec3 scaled = vector;
  if (longest < 1e-100 || longest > 1e100) {
    for (double& component : scaled) component /= longest;  // its square would under- or overflow
  }
  const double square = scaled[0] * scaled[0] + scaled[1] * scaled[1] + scaled[2] * scaled[2];
  constexpr double kRoundOff = 4e-15;
  if (std::abs(square - 1) > kRoundOff) {
    for (double& component : scaled) component /= std::sqrt(square);
  }
  return scaled;
}

std::optional<Vec3> read_direction(const Value& value, int dimension, bool any) {
  if (any && value.is(Node::Kind::list)) {
    const auto vector = value.vector(Measure::number, dimension);
    if (!vector) return std::nullopt;
    const auto unit = unit_vector(*vector);
    if (!unit) value.report("the zero vector has no direction");
    return unit;
  }
  std::vector<std::string> known;
  for (const NamedDirection& direction : kDirections) {
    if (direction.axis < dimension) known.emplace_back(direction.name);
  }
  const int index = value.word_index(known);
  if (index < 0) return std::nullopt;
  for (const NamedDirection& direction : kDirections) {
    if (known[static_cast<std::size_t>(index)] != direction.name) continue;
    Vec3 out{};
    out[static_cast<std::size_t>(direction.axis)] = direction.sign;
    return out;
  }
  return std::nullopt;
}

}  // namespace mpmfast
