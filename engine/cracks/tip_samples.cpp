#include "engine/cracks/tip_samples.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/constants.hpp"
#include "engine/cracks/supports.hpp"
#include "engine/plan/seed.hpp"

namespace mpmfast {

using namespace crack_constants;

namespace {

/// Slot of a node under the window of a tile; −1: outside of the window, or no slot.
template <int Dim>
int slot_under(const ParticleTile<Dim>& tile, const NodeIndex<Dim>& node) {
  int corner = 0, local = 0, window = 0;
  for (int d = Dim - 1; d >= 0; --d) {
    const int w = node[d] - tile.window[d];
    if (w < 0 || w >= kWindowSide) return -1;
    corner = 2 * corner + w / kTileSide;
    local = kTileSide * local + w % kTileSide;
    window = kWindowSide * window + w;
  }
  if (tile.node_slot) return tile.node_slot[window];
  return tile.slot[corner] < 0 ? -1 : tile.slot[corner] + local;
}

/// Adds acceleration and velocity gradient of the grid at a particle, by bilinear functions of its cell. A
/// node without mass moves with the particle and has the acceleration of the other nodes: the particle
/// entered its cell in the last step.
template <int Dim>
void add_grid_motion(const State<Dim>& state, const ParticleTile<Dim>& tile, const Vec<Dim>& x, double dt,
                     TipSample& out) {
  NodeIndex<Dim> low;
  Vec<Dim> share;
  double found = 0;
  for (int d = 0; d < Dim; ++d) {
    const double cells = (x[d] - state.grid.origin[d]) * state.grid.inverse_cell;
    low[d] = node_at(std::floor(cells));
    share[d] = cells - low[d];
  }
  for (int corner = 0; corner < kCorners<Dim>; ++corner) {
    NodeIndex<Dim> node = low;
    double weight = 1;
    Vec<2> slope = Vec<2>::Constant(state.grid.inverse_cell);
    for (int d = 0; d < Dim; ++d) {
      const bool up = corner >> d & 1;
      node[d] += up;
      weight *= up ? share[d] : 1 - share[d];
      for (int e = 0; e < 2; ++e) slope[e] *= e == d ? (up ? 1 : -1) : up ? share[d] : 1 - share[d];
    }
    const int slot = slot_under(tile, node);
    if (slot < 0 || !(state.nodes.column(Nodal::mass)[slot] > 0)) continue;
    const Vec<2> velocity = state.nodes.vector(Nodal::velocity, slot).template head<2>();
    found += weight;
    out.acceleration += weight / dt * state.nodes.vector(Nodal::force, slot).template head<2>();
    out.velocity_gradient += (velocity - out.velocity) * slope.transpose();
  }
  if (found > 0) out.acceleration /= found;
}

/// The state of a particle. Its displacement gradient is 1 − F0 F⁻¹, with the initial deformation F0.
template <int Dim>
TipSample particle_sample(State<Dim>& state, std::size_t p, double thickness) {
  const auto& particles = state.particles;
  const Mat<2> start = particles.initial_deformation(p).template topLeftCorner<2, 2>();
  TipSample out;
  out.gradient =
      Mat<2>::Identity() - start * particles.deformation_gradient(p).template topLeftCorner<2, 2>().inverse();
  const double ratio = particles.volume_ratio(p),
               volume = ratio * particles.column(Quantity::initial_volume)[p];
  const auto stress = [&](int k) { return particles.column(Quantity::kirchhoff_stress, k)[p] / ratio; };
  out.stress << stress(0), stress(3), stress(3), stress(1);
  out.displacement = Vec<2>::Zero();
  if (particles.has(Quantity::reference_position))
    out.displacement =
        (particles.vector(Quantity::position, p) - particles.vector(Quantity::reference_position, p))
            .template head<2>();
  out.velocity = particles.vector(Quantity::velocity, p).template head<2>();
  out.area = volume / thickness;
  out.energy = inner_energy(state, p) / volume;
  out.density = particles.column(Quantity::mass)[p] / volume;
  return out;
}

/// May a particle of the tile lie in the disk?
template <int Dim>
bool is_near(const GridView<Dim>& grid, const ParticleTile<Dim>& tile, const Disk& disk) {
  bool near = true;
  for (int d = 0; d < 2; ++d) {
    const double low = grid.origin[d] + tile.window[d] * grid.cell;
    near &=
        low - disk.radius < disk.centre[d] && disk.centre[d] < low + kWindowSide * grid.cell + disk.radius;
  }
  return near;
}

}  // namespace

template <int Dim>
void list_samples(State<Dim>& state, int field, const Disk& disk, double thickness, double dt,
                  const Vec<2>& gravity, TipSamples& samples) {
  samples.clear();
  for (const ParticleTile<Dim>& tile : state.tiling.tiles) {
    if (tile.field != field || !is_near(state.grid, tile, disk)) continue;
    for_each_particle(state.tiling.runs, tile, [&](std::uint32_t p) {
      const Vec<Dim> x = state.particles.vector(Quantity::position, p);
      if ((x.template head<2>() - disk.centre).squaredNorm() >= disk.radius * disk.radius) return;
      TipSample one = particle_sample(state, p, thickness);
      add_grid_motion(state, tile, x, dt, one);
      one.position = x.template head<2>();
      one.acceleration -= gravity;
      samples.push_back(one);
    });
  }
}

void subtract_mean_velocity(TipSamples& samples) {
  Vec<2> sum = Vec<2>::Zero();
  double area = 0;
  for (const TipSample& one : samples) {
    sum += one.area * one.velocity;
    area += one.area;
  }
  for (TipSample& one : samples) one.velocity -= sum / area;
}

void turn_to_axes(const Vec<2>& origin, const Mat<2>& axes, TipSamples& samples) {
  for (TipSample& one : samples) {
    one.position = axes * (one.position - origin);
    for (Vec<2>* v : {&one.displacement, &one.velocity, &one.acceleration}) *v = axes * *v;
    for (Mat<2>* m : {&one.gradient, &one.stress, &one.velocity_gradient}) *m = axes * *m * axes.transpose();
  }
}

double filled_length(const TipSamples& samples, double radius, double cell) {
  const double strip = kStrip * cell;
  const auto half_width = [&](double x) { return std::max(cell, kWedge * x); };
  const auto strips = std::max(kLeastStrips, static_cast<std::size_t>(radius / strip));
  std::vector<double> area(strips, 0.0);
  for (const TipSample& one : samples)
    if (one.position[0] >= 0 && std::abs(one.position[1]) < half_width(one.position[0]))
      if (const auto k = static_cast<std::size_t>(one.position[0] / strip); k < strips) area[k] += one.area;
  double sum = 0, whole = 0, filled = 0;
  for (std::size_t k = 0; k < strips; ++k) {
    const double x = strip * static_cast<double>(k + 1);
    sum += area[k];
    whole += 2 * strip * half_width(x - 0.5 * strip);
    if (k + 1 < kLeastStrips) continue;
    const bool first = k + 1 == kLeastStrips;
    if (first && sum < kEmpty * whole) return 0;
    if (first || sum >= kFilled * whole) filled = x;
  }
  return filled;
}

Vec<2> traction_behind(const TipSamples& samples, const Vec<2>& end, const Vec<2>& direction, double straight,
                       double cell) {
  Vec<2> sum = Vec<2>::Zero();
  double area = 0;
  for (const TipSample& one : samples) {
    const Vec<2> from = one.position - end;
    const double behind = -from.dot(direction), beside = direction[0] * from[1] - direction[1] * from[0];
    if (behind < 0 || behind > std::min(straight, kDirection * cell) ||
        std::abs(beside) > kTractionBand * cell)
      continue;
    const Vec<2> traction = one.stress * Vec<2>(-direction[1], direction[0]);
    area += one.area;
    sum +=
        one.area * Vec<2>(traction.dot(direction), direction[0] * traction[1] - direction[1] * traction[0]);
  }
  return area > 0 ? Vec<2>(sum / area) : sum;
}

template void list_samples(State<2>&, int, const Disk&, double, double, const Vec<2>&, TipSamples&);

}  // namespace mpmfast
