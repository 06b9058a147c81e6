#include "engine/contact/surface/find_points.hpp"

#include <cmath>
#include <numeric>
#include <utility>

#include "engine/constants.hpp"
#include "engine/contact/pairs/neighbours.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast {

namespace {

/// The slot of a velocity field at a node near a contact node, or −1 where the field has no mass.
template <int Dim>
int slot_near(const State<Dim>& state, const ContactNode<Dim>& from, const NodeIndex<Dim>& node, int field) {
  NodeIndex<Dim> steps;
  for (int d = 0; d < Dim; ++d) steps[d] = node[d] - from.index[d];
  const NodePlace place = place_near(state.tiling, from, steps);
  if (place.block < 0) return -1;
  const auto& block = state.tiling.node_blocks[static_cast<std::size_t>(place.block)];
  for (int t = block.begin; t < block.end; ++t) {
    if (state.tiling.node_tiles[static_cast<std::size_t>(t)].field != field) continue;
    const int slot = t * kTileNodes<Dim> + place.local;
    return state.nodes.column(Nodal::mass)[slot] > 0 ? slot : -1;
  }
  return -1;
}

/// Scales the weights of a field to the sum 1. @return whether the field has enough of them
template <int Dim>
bool normalise(std::array<double, PointStencil<Dim>::kNodes>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum >= constants::contact::kLeastWeight)) return false;
  for (double& weight : weights) weight /= sum;
  return true;
}

/// The colour of a block of nodes: blocks of one colour are a block apart along some axis.
template <int Dim>
std::size_t colour_of(const NodeBlock<Dim>& block) {
  static_assert(2 * constants::contact::kFarOffset <= kTileSide);  // then they share no node
  std::size_t colour = 0;
  for (int d = 0; d < Dim; ++d)
    colour |= static_cast<std::size_t>(floor_div(block.first_node[d], kTileSide) & 1) << d;
  return colour;
}

}  // namespace

template <int Dim>
void PointFinder<Dim>::find(const State<Dim>& state, const PairLaws& laws, const FreeDirections<Dim>& free,
                            const ContactList<Dim>& contacts, const std::vector<SurfaceSample<Dim>>& samples,
                            const PointMemory<Dim>& memory, SurfaceList<Dim>& points) {
  using constants::contact::kInheritReach, constants::threads::kFewNodes;
  const auto n = static_cast<std::int64_t>(contacts.nodes.size());
  const int asked = n <= kFewNodes ? 1 : state.threads;
  listings_.resize(std::max(static_cast<std::size_t>(asked), listings_.size()));
  for (Listing& listing : listings_)
    listing.geometry.clear(), listing.stencil.clear(), listing.contact_node.clear();
  on_threads(asked, [&](const TeamThread& me) {
    Listing& mine = listings_[static_cast<std::size_t>(me.thread)];
    const auto begin = static_cast<int>(n * me.thread / me.threads),
               end = static_cast<int>(n * (me.thread + 1) / me.threads);
    for (int k = begin; k < end; ++k)
      for (int e = contacts.nodes[k].pair_begin; e < contacts.nodes[k].pair_end; ++e) {
        const SurfaceSample<Dim>& sample = samples[static_cast<std::size_t>(e)];
        for (int i = 0; i < sample.count; ++i)
          list_point(state, laws, contacts, k, e, sample.points[static_cast<std::size_t>(i)], mine);
      }
  });
  place_listings(state, contacts, points);
  number_nodes(state, free, points);
  for_each_of(static_cast<std::int64_t>(points.size()), state.threads, kFewNodes, [&](std::int64_t p) {
    const PointGeometry<Dim>& geometry = points.geometry[p];
    points.status[p] = {};
    points.impulse[p] = {};
    points.before[p] = {};
    const PointRecord<Dim>* record =
        memory.nearest(geometry.position, geometry.field_a, geometry.field_b, kInheritReach);
    if (record) points.before[p] = record->history;
    double inverse_mass = 0;
    points.for_each_node(static_cast<int>(p), [&](int node, double share) {
      inverse_mass += share * share * geometry.normal.cwiseAbs2().dot(points.responses[node].inverse_mass);
    });
    PointSolve<Dim>& solve = points.solve[p];
    solve.reduced_mass = inverse_mass > 0 ? 1 / inverse_mass : 0;
    solve.trial.setZero();
    solve.normal = geometry.normal;
    solve.law = geometry.law;
  });
}

/// Adds a sampled point with its stencil, unless one of its fields has hardly any node there.
template <int Dim>
void PointFinder<Dim>::list_point(const State<Dim>& state, const PairLaws& laws,
                                  const ContactList<Dim>& contacts, int k, int e,
                                  const SampledPoint<Dim>& sampled, Listing& out) const {
  const ContactNode<Dim>& node = contacts.nodes[k];
  const ContactPair& pair = contacts.pairs.pair[e];
  const NodeFields<Dim> fields(state, contacts, node);
  PointGeometry<Dim> geometry;
  geometry.normal = contacts.pairs.geometry[e].normal;
  geometry.separation = sampled.separation;
  geometry.field_a = fields.field(pair.a);
  geometry.field_b = fields.field(pair.b);
  geometry.law = laws.number_of(fields, node, pair);
  geometry.meets_rigid = fields.is_rigid(pair.b);
  geometry.forward = geometry.law < 0 || laws.is_first(fields, node, pair);
  NodeIndex<Dim> corner;
  Vec<Dim> within;  // the cell of the corner, cells
  for (int d = 0; d < Dim; ++d) {
    const double x = node.index[d] + sampled.offset[d];
    corner[d] = static_cast<int>(std::floor(x));
    within[d] = x - corner[d];
    geometry.position[d] = state.grid.origin[d] + x * state.grid.cell;
  }
  PointStencil<Dim> stencil;
  for (std::size_t c = 0; c < PointStencil<Dim>::kNodes; ++c) {
    NodeIndex<Dim> at = corner;
    double weight = 1;
    for (int d = 0; d < Dim; ++d) {
      const bool upper = c >> d & 1;
      at[d] += upper;
      weight *= upper ? within[d] : 1 - within[d];
    }
    for (int side = 0; side < 2; ++side) {
      const int field = side == 0 ? geometry.field_a : geometry.field_b;
      const int slot = weight > 0 ? slot_near(state, node, at, field) : -1;
      stencil.node[side][c] = slot;
      stencil.weight[side][c] = slot < 0 ? 0 : weight;
    }
  }
  if (!normalise<Dim>(stencil.weight[0]) || !normalise<Dim>(stencil.weight[1])) return;
  out.geometry.push_back(geometry);
  out.stencil.push_back(stencil);
  out.contact_node.push_back(k);
}

/// Joins the listings in the order of the threads, and notes where each block of nodes begins.
template <int Dim>
void PointFinder<Dim>::place_listings(const State<Dim>& state, const ContactList<Dim>& contacts,
                                      SurfaceList<Dim>& points) {
  std::size_t count = 0;
  for (Listing& listing : listings_) {
    listing.begin = count;
    count += listing.geometry.size();
  }
  points.resize(count);
  for (auto& blocks : points.blocks) blocks.clear();
  int block = -1;
  std::array<int, 2>* range = nullptr;
  for (const Listing& listing : listings_)
    for (std::size_t i = 0; i < listing.geometry.size(); ++i) {
      const auto p = static_cast<int>(listing.begin + i);
      points.geometry[p] = listing.geometry[i];
      points.stencil[p] = listing.stencil[i];
      if (const int of_node = contacts.nodes[listing.contact_node[i]].block; of_node != block) {
        block = of_node;
        auto& blocks = points.blocks[colour_of(state.tiling.node_blocks[static_cast<std::size_t>(block)])];
        range = &blocks.emplace_back(std::array<int, 2>{p, p});
      }
      (*range)[1] = p + 1;
    }
}

namespace {

/// Adds a node; what conditions prescribe of it stays.
template <int Dim>
void add_node(const State<Dim>& state, const FreeDirections<Dim>& free, int slot, bool rigid,
              SurfaceList<Dim>& points) {
  SurfaceNode<Dim>& node = points.nodes.emplace_back();
  NodeResponse<Dim>& response = points.responses.emplace_back();
  node.slot = slot;
  node.mass = state.nodes.column(Nodal::mass)[slot];
  response.velocity.setZero();
  response.inverse_mass.setConstant(rigid ? 0 : 1 / node.mass);
  if (rigid) return;
  node.constraint = free.conditions->constraint(slot);
  if (!node.constraint.any()) return;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> axis = Vec<Dim>::Unit(d);
    if (free.conditions->free_part(node.constraint, axis) != axis) response.inverse_mass[d] = 0;
  }
}

}  // namespace

/// Lists the nodes of all points, and puts their numbers in the stencils.
template <int Dim>
void PointFinder<Dim>::number_nodes(const State<Dim>& state, const FreeDirections<Dim>& free,
                                    SurfaceList<Dim>& points) {
  node_at_.assign(static_cast<std::size_t>(state.tiling.slots()), -1);
  points.nodes.clear();
  points.responses.clear();
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int side = 0; side < 2; ++side) {
      auto& nodes = points.stencil[p].node[side];
      int any = 0;
      for (int& node : nodes) {
        if (node < 0) continue;
        const int slot = std::exchange(node, node_at_[node]);
        if (node < 0) {
          node = node_at_[slot] = static_cast<int>(points.nodes.size());
          add_node(state, free, slot, side == 1 && points.geometry[p].meets_rigid, points);
        }
        any = node;
      }
      for (int& node : nodes)
        if (node < 0) node = any;  // its weight is 0
    }
}

template class PointFinder<2>;
template class PointFinder<3>;

}  // namespace mpmfast
