#include "engine/run/contact_memory.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "engine/constants.hpp"
#include "engine/contact/geometry/fit_choice.hpp"
#include "engine/contact/geometry/fit_slabs.hpp"
#include "engine/contact/geometry/mean_normals.hpp"
#include "engine/contact/pairs/pair_memory.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

namespace {

/// Nodes on surfaces in a layer of tiles.
struct Surface {
  double deformable = 0, rigid = 0;

  /// A contact node takes a surface node of two fields, one of them deformable. Nine tenths of them meet
  /// where grains are pressed together (ellipses.yaml), few where disks touch.
  double contact_nodes() const {
    constexpr double kMeet = 0.4;
    return kMeet * std::min(deformable, 0.5 * (deformable + rigid));
  }
};

/// A node on the surface of a field has less mass than one inside it has.
template <int Dim>
std::map<int, Surface> surfaces(const State<Dim>& state) {
  constexpr double kInside = 0.99;
  const double* mass = state.nodes.column(Nodal::mass);
  const auto& tiling = state.tiling;
  std::vector<double> inside(static_cast<std::size_t>(state.fields()), 0.0);
  const auto for_each_slot = [&](const auto& f) {
    for (const auto& block : tiling.node_blocks)
      for (int t = block.begin; t < block.end; ++t)
        for (int local = 0; local < kTileNodes<Dim>; ++local)
          f(block, static_cast<std::size_t>(tiling.node_tiles[static_cast<std::size_t>(t)].field),
            mass[t * kTileNodes<Dim> + local]);
  };
  for_each_slot(
      [&](const auto&, std::size_t field, double m) { inside[field] = std::max(inside[field], m); });
  std::map<int, Surface> layers;
  for_each_slot([&](const auto& block, std::size_t field, double m) {
    if (!(m > 0 && m < kInside * inside[field])) return;
    Surface& layer = layers[block.first_node[Dim - 1] / kTileSide];
    ++(state.field_rigid[field] ? layer.rigid : layer.deformable);
  });
  return layers;
}

/// Particles that the functions of a node inside a body cover.
template <int Dim>
double particles_of_cloud(const Scene& scene) {
  const BasisFacts& basis = facts(scene.method.basis);
  double most = 0;
  for (const BodySpec& body : scene.bodies) {
    double count = 1;
    for (std::size_t d = 0; d < Dim; ++d) {
      const double per_cell = body.particles_per_cell[d];
      const double width = 2 * basis.grid_reach + (basis.over_domain ? 1 / per_cell : 0);
      count *= width * per_cell;
    }
    most = std::max(most, count);
  }
  return most;
}

}  // namespace

template <int Dim>
ContactNeed contact_need(const Step<Dim>& step, const Scene& scene) {
  ContactNeed need;
  if (!step.plan().contact) return need;
  const State<Dim>& state = step.state();
  const FitChoice choice(scene.contact);
  // Smoothed clouds are kept for a layer of tiles and what lies ahead of it (FitSlabs).
  double kept = 0;
  for (const auto& [layer, surface] : surfaces(state)) {
    const double nodes = surface.contact_nodes();
    need.nodes += nodes;
    kept = std::max(kept, nodes);
  }
  constexpr double kMore = 1.1;  // than meet at the start
  constexpr std::size_t kEnough = 200;
  const std::size_t now = step.contact_list().nodes.size();
  need.nodes = std::max(need.nodes, kMore * static_cast<double>(now));
  const double of_nodes = 4.0 * static_cast<double>(state.tiling.block_nodes());
  if (now >= kEnough) {  // what each takes is known
    const double taken = static_cast<double>(step.contact_bytes()) - of_nodes;
    need.bytes = of_nodes + taken * need.nodes / static_cast<double>(now);
    return need;
  }
  constexpr double kGrowth = 1.25;  // lists grow by doubling
  double of_node =
      sizeof(ContactNode<Dim>) + 2 * sizeof(ContactField) + kPairBytes<Dim> + PairMemory<Dim>::kPairBytes;
  const double ahead =
      static_cast<double>(constants::threads::kSlabNodesPerThread) * static_cast<double>(state.threads);
  if (scene.contact.refit > 0) of_node += 2 * sizeof(KeptFit<Dim>);
  if (choice.smooth) {
    of_node += sizeof(RawNormal<Dim>) + 4 * sizeof(double);
    const int shapes = choice.separate ? shape_size<Dim>(choice.extent) : 0;
    constexpr double kFilled = 0.9;  // of a support: surfaces that meet are round
    need.bytes +=
        std::min(need.nodes, kept + ahead) * kFilled * particles_of_cloud<Dim>(scene) * 8 * (Dim + shapes);
  }
  need.bytes += kGrowth * of_node * need.nodes + of_nodes;
  return need;
}

template ContactNeed contact_need(const Step<2>&, const Scene&);
template ContactNeed contact_need(const Step<3>&, const Scene&);

}  // namespace mpmfast
