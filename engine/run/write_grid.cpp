#include "engine/run/write_grid.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/output/vtu.hpp"
#include "engine/plan/contact_law.hpp"

namespace mpmfast {

namespace {

constexpr std::array<std::string_view, 3> kAxes{"X", "Y", "Z"};
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Of one field on one node, with those it meets.
struct NodeContact {
  std::array<float, 3> normal{}, impulse{};
  float separation = kUnknown;
  std::uint8_t touching = 0;
  std::array<float, 3> jump{};  ///< of the displacements, from this field to the other
  float damage = kUnknown;
};

/// Includes pair e; of several the nearest gives normal and separation. @param sign  −1 on the side of b
template <int Dim>
void include_contact(const PairColumns<Dim>& pairs, int e, float sign, NodeContact& contact) {
  const PairGeometry<Dim>& geometry = pairs.geometry[e];
  if (pairs.status[e].touching) {
    contact.touching = 1;
    for (int d = 0; d < Dim; ++d)
      contact.impulse[static_cast<std::size_t>(d)] += sign * static_cast<float>(pairs.impulse[e].now[d]);
  }
  const auto separation = static_cast<float>(geometry.separation);
  if (geometry.normal.squaredNorm() == 0 || contact.separation <= separation) return;
  contact.separation = separation;
  for (int d = 0; d < Dim; ++d)
    contact.normal[static_cast<std::size_t>(d)] = sign * static_cast<float>(geometry.normal[d]);
}

/// Includes the springs of pair e; of several pairs the one of the largest jump.
template <int Dim>
void include_springs(const PairColumns<Dim>& pairs, int e, float sign, NodeContact& contact) {
  const InterfaceSpring<Dim>& spring = pairs.spring[e];
  const Vec<Dim>& jump = spring.jump.value;
  double before = 0;
  for (float x : contact.jump) before += x * x;
  if (spring.acts && jump.squaredNorm() >= before)
    for (int d = 0; d < Dim; ++d)
      contact.jump[static_cast<std::size_t>(d)] = sign * static_cast<float>(jump[d]);
  if (pairs.bond.empty() || pairs.bond[e].damage_before < 0) return;  // no bond, at any time
  const auto damage = static_cast<float>(pairs.bond[e].damage);
  if (!(contact.damage > damage)) contact.damage = damage;
}

/// By slot.
template <int Dim>
std::vector<NodeContact> contact_by_slot(const Step<Dim>& step) {
  const ContactList<Dim>& list = step.contact_list();
  std::vector<NodeContact> out(static_cast<std::size_t>(step.state().tiling.slots()));
  for (const ContactNode<Dim>& node : list.nodes) {
    const auto contact = [&](int k) -> NodeContact& {
      return out[static_cast<std::size_t>(list.fields[node.field_begin + k].slot)];
    };
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const ContactPair& pair = list.pairs.pair[e];
      include_contact(list.pairs, e, 1, contact(pair.a));
      if (!pair.is_lumped()) include_contact(list.pairs, e, -1, contact(pair.b));
      if (list.pairs.spring.empty()) continue;
      include_springs(list.pairs, e, 1, contact(pair.a));
      if (!pair.is_lumped()) include_springs(list.pairs, e, -1, contact(pair.b));
    }
  }
  return out;
}

/// The columns of the file.
struct GridColumns {
  std::vector<double> points;
  std::vector<std::uint16_t> field;
  std::vector<double> mass;
  std::vector<float> velocity, normal, separation, impulse, temperature, jump, damage;
  std::vector<std::uint8_t> touching;
};

template <int Dim>
void add(const Step<Dim>& step, int slot, int field, const NodeIndex<Dim>& node, const NodeContact& contact,
         GridColumns& out) {
  const State<Dim>& state = step.state();
  const Vec<Dim> velocity = state.nodes.vector(Nodal::velocity, slot);
  for (int d = 0; d < 3; ++d) {
    const bool real = d < Dim;
    const int k = real ? d : 0;
    out.points.push_back(real ? state.grid.origin[k] + state.grid.cell * node[k] : 0);
    out.velocity.push_back(real ? static_cast<float>(velocity[k]) : 0);
    out.normal.push_back(contact.normal[static_cast<std::size_t>(d)]);
    out.impulse.push_back(contact.impulse[static_cast<std::size_t>(d)]);
    if (step.plan().interface_springs) out.jump.push_back(contact.jump[static_cast<std::size_t>(d)]);
  }
  out.field.push_back(static_cast<std::uint16_t>(field));
  out.mass.push_back(state.nodes.column(Nodal::mass)[slot]);
  out.separation.push_back(contact.separation);
  out.touching.push_back(contact.touching);
  if (step.plan().interface_springs) out.damage.push_back(contact.damage);
  if (step.heat().active())
    out.temperature.push_back(static_cast<float>(step.heat().temperature(state, slot)));
}

}  // namespace

template <int Dim>
void write_grid(const std::filesystem::path& vtu, const Step<Dim>& step, const Scene& scene) {
  const State<Dim>& state = step.state();
  const std::vector<NodeContact> contacts = contact_by_slot(step);
  const double* mass = state.nodes.column(Nodal::mass);
  GridColumns columns;
  for (const auto& block : state.tiling.node_blocks)
    for (int tile = block.begin; tile < block.end; ++tile)
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const int slot = tile * kTileNodes<Dim> + local;
        if (!(mass[slot] > 0)) continue;
        add(step, slot, state.tiling.node_tiles[static_cast<std::size_t>(tile)].field,
            state.tiling.node(block, local), contacts[static_cast<std::size_t>(slot)], columns);
      }
  VtuFile file(columns.points);
  file.add_point_data("field", columns.field);
  file.add_point_data("mass", columns.mass);
  file.add_point_data("velocity", columns.velocity, kAxes);
  file.add_point_data("touching", columns.touching);
  file.add_point_data("contact_normal", columns.normal, kAxes);
  file.add_point_data("separation", columns.separation);
  file.add_point_data("contact_impulse", columns.impulse, kAxes);
  if (step.plan().interface_springs) file.add_point_data("jump", columns.jump, kAxes);
  if (any_law(scene, [](const auto& law) { return std::is_same_v<std::decay_t<decltype(law)>, Cohesive>; }))
    file.add_point_data("damage", columns.damage);
  if (step.heat().active()) file.add_point_data("temperature", columns.temperature);
  file.write(vtu, state.time);
}

template void write_grid(const std::filesystem::path&, const Step<2>&, const Scene&);
template void write_grid(const std::filesystem::path&, const Step<3>&, const Scene&);

}  // namespace mpmfast
