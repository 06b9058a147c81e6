/// A pressure p on the surface of a body, from the volume gradients of its velocity field.
///
/// The traction −p n does the virtual work −∫ p n·w dS, so that node i gets f_i = −∫ p N_i n dS. For one p on
/// the whole surface the divergence theorem gives
///   f_i = −p ∫ ∇N_i dV = −p g_i,  g_i = Σ_p V_p G_pi (Nodal::volume_gradient):
/// the same sum as that of the internal force −Σ_p V_p σ_p·G_pi. A body with σ = −p I is in equilibrium to
/// round-off, on any grid and for any basis.
///
/// A part of the surface has weights w_i: f_i = −p w_i g_i, the load of the nodal field p w_i. g_i is small
/// where the material goes on, so that only weights of nodes near the surface count. With w_i = 1 at all of
/// them the resultant is that of the exact surface. w_i is the share of the cell around node i that lies in
/// the given shape: Σ_i w_i N_i is then the shape's own length along a straight surface. The shape is that of
/// the start, so the centre of this cell is x_i − u_i, u_i the mean displacement of the material at the node.
///
/// On an edge g_i is the sum over both faces. `along` a direction d keeps of it (g_i·d) d = d ∫ N_i n·d dS,
/// which a face parallel to d adds nothing to: the load on the flat end of a bar is exact up to its edges.
///
/// About an axis g_i is projected per section, V_p/(2π r_p). The surface of a turn at radius r is 2π r times
/// that of the section, so f_i = −2π r_i p w_i g_i; N_i is exact for linear functions, hence Σ_i r_i N_i = r.

#include <cmath>

#include "engine/constants.hpp"
#include "engine/loads/loads.hpp"
#include "engine/state/slots.hpp"

namespace mpmfast {

namespace {

/// The share of a cubic cell in a shape, by points at quarters of its edges.
template <int Dim>
double share_inside(const Shape& shape, const Vec<Dim>& centre, double cell) {
  int inside = 0;
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    Vec3 point{0, 0, 0};
    for (int d = 0; d < Dim; ++d)
      point[static_cast<std::size_t>(d)] = centre[d] + ((corner >> d & 1) ? 0.25 : -0.25) * cell;
    inside += contains(shape, point);
  }
  return static_cast<double>(inside) / kCorners<Dim>;
}

template <int Dim>
class Pressure final : public Load<Dim> {
 public:
  Pressure(const PressureSpec& spec, const Scene& scene, const Plan& plan)
      : spec_(spec), field_(plan.body_field[static_cast<std::size_t>(spec.body)]), cell_(scene.grid.cell) {
    for (int d = 0; d < Dim; ++d) {
      origin_[d] = scene.grid.origin[static_cast<std::size_t>(d)];
      if (spec.along) along_[d] = (*spec.along)[static_cast<std::size_t>(d)];
    }
  }

  void add_force(State<Dim>& state, double dt) override {
    pressure_ = mean_over(spec_.value, state.time, dt);
    if (pressure_ == 0) return;
    if (spec_.where) weight_.resize(static_cast<std::size_t>(state.tiling.slots()));
    const auto blocks = static_cast<std::int64_t>(state.tiling.node_blocks.size());
    for_each_of(blocks, state.threads, constants::threads::kFewBusyBlocks, [&](std::int64_t s) {
      for_each_loaded(state, static_cast<std::size_t>(s), [&](int slot, const Vec<Dim>& position) {
        if (spec_.where) weight_[static_cast<std::size_t>(slot)] = weight_at(state, slot, position);
        const Vec<Dim> force = force_on(state, slot, position);
        for (int d = 0; d < Dim; ++d) state.nodes.column(Nodal::force, d)[slot] += force[d];
      });
    });
  }

  double work(const State<Dim>& state, double dt) const override {
    double power = 0;
    for (std::size_t s = 0; pressure_ != 0 && s < state.tiling.node_blocks.size(); ++s)
      for_each_loaded(state, s, [&](int slot, const Vec<Dim>& position) {
        const Vec<Dim> velocity =
            state.nodes.vector(Nodal::velocity, slot) - 0.5 * state.nodes.vector(Nodal::force, slot);
        power += force_on(state, slot, position).dot(velocity);
      });
    return power * dt;
  }

 private:
  /// Calls f(slot, position of its node) for the nodes of the body's field on one block that have mass.
  template <class F>
  void for_each_loaded(const State<Dim>& state, std::size_t s, const F& f) const {
    const NodeBlock<Dim>& block = state.tiling.node_blocks[s];
    const double* mass = state.nodes.column(Nodal::mass);
    for (int t = block.begin; t < block.end; ++t) {
      if (state.tiling.node_tiles[static_cast<std::size_t>(t)].field != field_) continue;
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const int slot = t * kTileNodes<Dim> + local;
        if (!(mass[slot] > 0)) continue;
        const NodeIndex<Dim> node = state.tiling.node(block, local);
        Vec<Dim> position;
        for (int d = 0; d < Dim; ++d) position[d] = origin_[d] + node[d] * cell_;
        f(slot, position);
      }
    }
  }

  double weight_at(const State<Dim>& state, int slot, const Vec<Dim>& position) const {
    const Vec<Dim> displacement =
        state.nodes.vector(Nodal::mass_displacement, slot) / state.nodes.column(Nodal::mass)[slot];
    return share_inside<Dim>(*spec_.where, position - displacement, cell_);
  }

  Vec<Dim> force_on(const State<Dim>& state, int slot, const Vec<Dim>& position) const {
    Vec<Dim> area = state.nodes.vector(Nodal::volume_gradient, slot);
    if (spec_.along) area = area.dot(along_) * along_;
    if (spec_.where) area *= weight_[static_cast<std::size_t>(slot)];
    if (state.plane_kind == PlaneKind::axisymmetric) area *= kFullTurn * position[0];
    return -pressure_ * area;
  }

  PressureSpec spec_;
  int field_;
  double cell_;  ///< m
  Vec<Dim> origin_, along_ = Vec<Dim>::Zero();
  double pressure_ = 0;         ///< mean of this step, Pa
  std::vector<double> weight_;  ///< w_i by slot, where a part of the surface is loaded
};

}  // namespace

template <int Dim>
std::unique_ptr<Load<Dim>> make_load(const PressureSpec& spec, const Scene& scene, const Plan& plan) {
  return std::make_unique<Pressure<Dim>>(spec, scene, plan);
}

template std::unique_ptr<Load<2>> make_load<2>(const PressureSpec&, const Scene&, const Plan&);
template std::unique_ptr<Load<3>> make_load<3>(const PressureSpec&, const Scene&, const Plan&);

}  // namespace mpmfast
