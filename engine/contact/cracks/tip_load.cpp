#include "engine/contact/cracks/tip_load.hpp"

#include <Eigen/LU>

#include <optional>
#include <utility>
#include <variant>

#include "engine/plan/seed.hpp"
#include "kernels/fracture/tip_integrals.hpp"

namespace mpmfast {

namespace {

/// Out of the crack at one of its ends: from a point some cells before it, where there is one.
template <int Dim>
Vec<2> direction(const CrackLine<Dim>& line, bool end, double cell) {
  constexpr double kBack = 2;  // cells
  const auto& points = line.points;
  const std::size_t n = points.size();
  const auto at = [&](std::size_t k) -> Vec<2> { return points[end ? n - 1 - k : k].template head<2>(); };
  std::size_t back = 1;
  while (back + 1 < n && (at(0) - at(back)).norm() < kBack * cell) ++back;
  return (at(0) - at(back)).normalized();
}

/// E′ of the plane at rest, Pa; 0 where a law has no shear modulus.
double plane_modulus(const Material& material, Depth depth) {
  return std::visit(
      [&](const auto& law) {
        double shear = 0;
        if constexpr (requires { law.shear(); })
          shear = law.shear();
        else if constexpr (requires { law.shear + 1.0; })
          shear = law.shear;
        if (shear == 0) return 0.0;
        const double lambda = law.modulus() - 2 * shear;
        const double held = 4 * shear * (lambda + shear) / (lambda + 2 * shear);
        return depth == Depth::relaxed ? shear * (3 * lambda + 2 * shear) / (lambda + shear) : held;
      },
      material);
}

}  // namespace

template <int Dim>
TipLoad tip_load(State<Dim>& state, const CrackLine<Dim>& line, bool end, double radius, double thickness) {
  const auto& particles = state.particles;
  TipLoad load;
  load.place = (end ? line.points.back() : line.points.front()).template head<2>();
  const Vec<2> ahead = direction(line, end, state.grid.cell);
  Mat<2> axes;  // rows
  axes << ahead[0], ahead[1], -ahead[1], ahead[0];
  std::optional<TipIntegrals> integrals;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const int body = particles.body()[p];
    if (state.body_field[static_cast<std::size_t>(body)] != line.field) continue;
    const Vec<2> from = particles.vector(Quantity::position, p).template head<2>() - load.place;
    if (from.squaredNorm() >= radius * radius) continue;
    if (!integrals) {
      const int material = state.bodies[static_cast<std::size_t>(body)].material;
      integrals.emplace(radius,
                        plane_modulus(state.materials[static_cast<std::size_t>(material)], state.depth));
    }
    Mat<2> start = Mat<2>::Identity();
    if (particles.has(Quantity::initial_deformation))
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          start(i, j) = particles.column(Quantity::initial_deformation, Dim * i + j)[p];
    const Mat<2> slope = Mat<2>::Identity() -
                         start * particles.deformation_gradient(p).template topLeftCorner<2, 2>().inverse();
    const double ratio = particles.volume_ratio(p),
                 volume = ratio * particles.column(Quantity::initial_volume)[p];
    const auto stress = [&](int k) { return particles.column(Quantity::kirchhoff_stress, k)[p] / ratio; };
    Mat<2> sigma;
    sigma << stress(0), stress(3), stress(3), stress(1);
    Vec<2> moved = Vec<2>::Zero();
    if (particles.has(Quantity::reference_position))
      moved = (particles.vector(Quantity::position, p) - particles.vector(Quantity::reference_position, p))
                  .template head<2>();
    integrals->add({axes * from, volume / thickness, axes * moved, axes * slope * axes.transpose(),
                    axes * sigma * axes.transpose(), inner_energy(state, p) / volume});
  }
  if (!integrals) return load;
  load.release = integrals->release();
  load.sliding = integrals->intensities()[0];
  load.opening = integrals->intensities()[1];
  return load;
}

template TipLoad tip_load(State<2>&, const CrackLine<2>&, bool, double, double);

}  // namespace mpmfast
