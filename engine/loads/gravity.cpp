/// Gravity and the accelerations of single bodies: f_i = m_i g(t), g ramped from zero.

#include <algorithm>

#include "engine/loads/loads.hpp"
#include "engine/state/slots.hpp"

namespace mpmfast {

namespace {

template <int Dim>
class Gravity final : public Load<Dim> {
 public:
  Gravity(const Scene& scene, const Plan& plan)
      : ramp_(scene.gravity.ramp), acceleration_(plan.field_acceleration) {}

  void add_force(State<Dim>& state, double dt) override {
    const double middle = state.time + 0.5 * dt;
    share_ = ramp_ > 0 ? std::min(1.0, middle / ramp_) : 1.0;
    const double* mass = state.nodes.column(Nodal::mass);
    for (std::size_t d = 0; d < Dim; ++d) {
      double* f = state.nodes.column(Nodal::force, static_cast<int>(d));
      for_each_slot(state, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t tile = begin; tile < end; tile += kTileNodes<Dim>) {
          const double g = share_ * full(state, tile)[d];
          if (g == 0) continue;
          for (std::int64_t i = tile; i < tile + kTileNodes<Dim>; ++i) f[i] += mass[i] * g;
        }
      });
    }
  }

  double work(const State<Dim>& state, double dt) const override {
    double work = 0;
    const double* mass = state.nodes.column(Nodal::mass);
    for (std::size_t d = 0; d < Dim; ++d) {
      const double *v = state.nodes.column(Nodal::velocity, static_cast<int>(d)),
                   *change = state.nodes.column(Nodal::force, static_cast<int>(d));
      double power = 0;
      for (std::int64_t tile = 0; tile < state.tiling.slots(); tile += kTileNodes<Dim>) {
        const double g = full(state, tile)[d];
        if (g == 0) continue;
        double momentum = 0;
        for (std::int64_t i = tile; i < tile + kTileNodes<Dim>; ++i)
          momentum += mass[i] * (v[i] - 0.5 * change[i]);
        power += g * momentum;
      }
      work += share_ * power * dt;
    }
    return work;
  }

  Vec<Dim> acceleration(int field) const override {
    Vec<Dim> out;
    for (int d = 0; d < Dim; ++d)
      out[d] = share_ * acceleration_[static_cast<std::size_t>(field)][static_cast<std::size_t>(d)];
    return out;
  }

 private:
  /// The acceleration, past the ramp, of the field that the tile with this first slot belongs to; zero of
  /// rigid bodies.
  const Vec3& full(const State<Dim>& state, std::int64_t slot) const {
    const auto tile = static_cast<std::size_t>(slot / kTileNodes<Dim>);
    return acceleration_[static_cast<std::size_t>(state.tiling.node_tiles[tile].field)];
  }

  double ramp_;                     ///< s
  std::vector<Vec3> acceleration_;  ///< by velocity field, m/s²
  double share_ = 1;                ///< of the accelerations in this step
};

}  // namespace

template <int Dim>
std::unique_ptr<Load<Dim>> make_gravity(const Scene& scene, const Plan& plan) {
  return std::make_unique<Gravity<Dim>>(scene, plan);
}

template std::unique_ptr<Load<2>> make_gravity<2>(const Scene&, const Plan&);
template std::unique_ptr<Load<3>> make_gravity<3>(const Scene&, const Plan&);

}  // namespace mpmfast
