#include "engine/plan/pair_table.hpp"

#include "engine/plan/plan.hpp"

namespace mpmfast {

PairTable make_pair_table(const Scene& scene, const std::vector<int>& body_field, int fields) {
  PairTable table;
  const auto& pairs = scene.contact.pairs;
  if (pairs.empty()) return table;
  const auto n = static_cast<std::size_t>(fields);
  std::vector<int> material(n, -1);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    material[static_cast<std::size_t>(body_field[b])] = scene.bodies[b].material;
  const auto field_of = [&](int body) { return body_field[static_cast<std::size_t>(body)]; };

  // Groups: the materials first, then every field that a pair of bodies names.
  table.groups = static_cast<int>(scene.materials.size());
  table.group = material;
  std::vector<int> group_material;
  for (int m = 0; m < table.groups; ++m) group_material.push_back(m);
  for (const PairLawSpec& pair : pairs) {
    if (pair.materials) continue;
    for (int body : pair.between) {
      int& group = table.group[static_cast<std::size_t>(field_of(body))];
      if (group >= static_cast<int>(scene.materials.size())) continue;
      group_material.push_back(group);
      group = table.groups++;
    }
  }

  const auto count = static_cast<std::size_t>(table.groups);
  table.pair.assign(count * count, -1);
  table.forward.assign(count * count, true);
  const auto enter = [&](int a, int b, int k) {
    const auto ab = static_cast<std::size_t>(a) * count + static_cast<std::size_t>(b),
               ba = static_cast<std::size_t>(b) * count + static_cast<std::size_t>(a);
    table.pair[ab] = table.pair[ba] = k;
    table.forward[ba] = a == b;
    table.forward[ab] = true;
  };
  // A pair of bodies says more than one of materials, so it comes last.
  for (const bool materials : {true, false})
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (pairs[k].materials != materials) continue;
      const auto in = [&](int group, int side) {
        if (materials) return group_material[static_cast<std::size_t>(group)] == side;
        return group == table.group[static_cast<std::size_t>(field_of(side))];
      };
      for (int a = 0; a < table.groups; ++a)
        for (int b = 0; b < table.groups; ++b)
          if (in(a, pairs[k].between[0]) && in(b, pairs[k].between[1])) enter(a, b, static_cast<int>(k));
    }
  return table;
}

}  // namespace mpmfast
