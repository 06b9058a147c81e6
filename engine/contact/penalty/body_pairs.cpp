#include "engine/contact/penalty/body_pairs.hpp"

#include <algorithm>

#include "engine/contact/penalty/item.hpp"

namespace mpmfast::penalty {

bool BodyPairs::may_touch(int body_a, int body_b) const {
  return item(field, body_a) != item(field, body_b) && !(item(rigid, body_a) && item(rigid, body_b));
}

const AnyLaw& BodyPairs::law(int body_a, int body_b) const {
  if (table.empty()) return laws.front();
  const int pair = table.pair[table.at(item(field, body_a), item(field, body_b))];
  return item(laws, pair + 1);
}

double BodyPairs::stiffness(int body_a, int body_b) const {
  const double a = item(modulus, body_a), b = item(modulus, body_b);
  const double softer = a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
  return springs.stiffness * softer / cell;
}

std::optional<BodyPairs::Named> BodyPairs::named(int body_a, int body_b) const {
  if (table.empty()) return std::nullopt;
  const int a = item(field, body_a), b = item(field, body_b);
  const std::size_t entry = table.at(a, b);
  if (table.pair[entry] < 0) return std::nullopt;
  // Within a group the field that comes first is the pair's first.
  const bool same_group = item(table.group, a) == item(table.group, b);
  return Named{static_cast<std::size_t>(table.pair[entry]), table.forward[entry] && !(same_group && a > b)};
}

template <int Dim>
BodyPairs make_body_pairs(const Scene& scene, const Plan& plan, const State<Dim>& seeded) {
  BodyPairs out;
  out.field = plan.body_field;
  out.table = plan.pairs;
  out.laws.push_back(scene.contact.law.acts);
  for (const PairLawSpec& pair : scene.contact.pairs) out.laws.push_back(pair.law.acts);
  out.springs = scene.contact.springs;
  out.cell = scene.grid.cell;
  for (const BodySpec& body : scene.bodies) out.rigid.push_back(is_rigid(scene, body));
  out.modulus.assign(scene.bodies.size(), 0);
  const auto& particles = seeded.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const std::size_t b = particles.body()[p];
    if (out.rigid[b]) continue;
    const double c = particles.column(Quantity::wave_speed)[p];
    const double density = density_of(item(scene.materials, scene.bodies[b].material));
    out.modulus[b] = std::max(out.modulus[b], density * c * c);
  }
  return out;
}

template BodyPairs make_body_pairs<2>(const Scene&, const Plan&, const State<2>&);
template BodyPairs make_body_pairs<3>(const Scene&, const Plan&, const State<3>&);

}  // namespace mpmfast::penalty
