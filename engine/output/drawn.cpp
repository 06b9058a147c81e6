#include "engine/output/drawn.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/basis/domain_limit.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {
namespace {

constexpr double kBeyondGrid = 2;  ///< cells: particles leave the grid a cell beyond it

template <int Dim>
Mat<Dim> stored_half_edges(const Particles<Dim>& particles, std::size_t p) {
  Mat<Dim> edges;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) edges(i, j) = particles.column(Quantity::domain_edges, Dim * i + j)[p];
  return edges;
}

template <int Dim>
const std::array<int, 3>& counts_of(const Particles<Dim>& particles, const Scene& scene, std::size_t p) {
  return scene.bodies[particles.body()[p]].particles_per_cell;
}

/// A particle's share of a cell.
template <int Dim>
Mat<Dim> seeded_half_edges(const Particles<Dim>& particles, const Scene& scene, std::size_t p) {
  const auto& per_cell = counts_of(particles, scene, p);
  Mat<Dim> edges = Mat<Dim>::Zero();
  for (int d = 0; d < Dim; ++d) edges(d, d) = 0.5 * scene.grid.cell / per_cell[static_cast<std::size_t>(d)];
  return edges;
}

/// F and the initial volume. The particle does not know its undeformed shape: as its share of a cell, or of
/// the width of a ring.
template <int Dim>
Mat<Dim> deformed_half_edges(const Particles<Dim>& particles, const Scene& scene, std::size_t p) {
  Mat<Dim> edges = Mat<Dim>::Identity();
  if (particles.has(Quantity::deformation_gradient)) edges = particles.deformation_gradient(p);
  double volume =
      particles.has(Quantity::initial_volume) ? particles.column(Quantity::initial_volume)[p] : 0.0;
  if (scene.space == Space::axisymmetric)  // of a ring, to the square that is turned
    volume *= particles.column(Quantity::out_of_plane_stretch)[p] /
              (kFullTurn * particles.column(Quantity::position, 0)[p]);
  const double size = 0.5 * (Dim == 2 ? std::sqrt(volume / scene.thickness) : std::cbrt(volume));
  const auto& per_cell = counts_of(particles, scene, p);
  double mean = 1;
  for (std::size_t d = 0; d < Dim; ++d) mean *= per_cell[d];
  mean = Dim == 2 ? std::sqrt(mean) : std::cbrt(mean);
  double share = 1;
  for (int d = 0; d < Dim; ++d) share *= particles.domain_share(p, d);
  const double whole = size / (Dim == 2 ? std::sqrt(share) : std::cbrt(share));
  for (int d = 0; d < Dim; ++d)
    edges.col(d) *= whole * particles.domain_share(p, d) * mean / per_cell[static_cast<std::size_t>(d)];
  return edges;
}

template <int Dim>
Mat<Dim> half_edges(const Particles<Dim>& particles, const Scene& scene, std::size_t p) {
  return particles.has(Quantity::domain_edges) ? stored_half_edges(particles, p)
                                               : deformed_half_edges(particles, scene, p);
}

template <int Dim>
bool has_finite_shape(const Particles<Dim>& particles, std::size_t p) {
  if (particles.has(Quantity::domain_edges)) return stored_half_edges(particles, p).allFinite();
  return !particles.has(Quantity::deformation_gradient) || particles.deformation_gradient(p).allFinite();
}

bool follows(const Scene& scene) { return facts(scene.method.basis).convected; }

}  // namespace

double largest_half_diagonal(const Scene& scene) { return kLargestHalfDiagonal * scene.grid.cell; }

Viewed::Viewed(const Scene& scene) : dimension(static_cast<std::size_t>(scene.dimension())) {
  const double beyond = kBeyondGrid * scene.grid.cell;
  for (std::size_t d = 0; d < dimension; ++d) {
    lower[d] = scene.grid.origin[d] - beyond;
    upper[d] = scene.grid.origin[d] + scene.grid.size[d] + beyond;
  }
}

bool Viewed::holds(const double* x) const {
  for (std::size_t d = 0; d < dimension; ++d)
    if (!(x[d] >= lower[d] && x[d] <= upper[d])) return false;
  return true;
}

Mat<2> with_diagonals_up_to(const Mat<2>& half_edges, double most) {
  double edge[4] = {half_edges(0, 0), half_edges(0, 1), half_edges(1, 0), half_edges(1, 1)};
  limit_domain<2>(most, edge);
  Mat<2> edges;
  edges << edge[0], edge[1], edge[2], edge[3];
  return edges;
}

Mat<2> drawn_half_edges(const Particles<2>& particles, const Scene& scene, std::size_t p) {
  const Mat<2> edges = half_edges(particles, scene, p);
  if (!has_finite_shape(particles, p)) return edges;
  const double most = largest_half_diagonal(scene);
  if (edges.allFinite() && follows(scene)) return with_diagonals_up_to(edges, most);
  const double longest = std::max((edges.col(0) + edges.col(1)).norm(), (edges.col(0) - edges.col(1)).norm());
  return longest <= most ? edges
                         : seeded_half_edges(particles, scene, p);  // seeded: also where J has no digit
}

double drawn_radius(const Particles<3>& particles, const Scene& scene, std::size_t p) {
  const double radius = std::cbrt(std::abs(half_edges(particles, scene, p).determinant()));
  if (!has_finite_shape(particles, p)) return radius;
  const double most = largest_half_diagonal(scene) / std::numbers::sqrt3;
  if (std::isfinite(radius) && follows(scene)) return std::min(radius, most);
  return radius <= most ? radius : std::cbrt(seeded_half_edges(particles, scene, p).determinant());
}

}  // namespace mpmfast
