#include "engine/plan/memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "engine/scene/diagnostic.hpp"
#include "engine/scene/geometry.hpp"
#include "engine/state/nodes.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

namespace {

/// The share of a shape in the box around it.
double filled_share(const Shape& shape, const Bounds& box, int dimension) {
  const int side = dimension == 3 ? 20 : 60;
  long inside = 0, all = 0;
  for (int k = 0; k < (dimension == 3 ? side : 1); ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i, ++all) {
        const int at[3] = {i, j, k};
        Vec3 x{};
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
          x[d] = box.lower[d] + (box.upper[d] - box.lower[d]) * (at[d] + 0.5) / side;
        inside += contains(shape, x);
      }
  return static_cast<double>(inside) / static_cast<double>(all);
}

double particles_per_cell(const BodySpec& body, int dimension) {
  double product = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) product *= body.particles_per_cell[d];
  return product;
}

template <int Dim>
double bytes_of(const Scene& scene, const Plan& plan, double particles) {
  double columns = 0, nodal = 0, most = 1;
  for (const Quantity q : plan.particle_columns) columns += Particles<Dim>::components(q);
  for (const Nodal q : plan.nodal_columns) nodal += Nodes<Dim>::components(q);
  for (const BodySpec& body : scene.bodies) most = std::max(most, particles_per_cell(body, Dim));
  constexpr double kSort = 40;    // bytes a particle: keys, identity, a column at a time
  constexpr double kNodes = 1.5;  // slots a cell: tiles are not full
  return particles * (8 * columns + kSort + kNodes * 8 * nodal / most);
}

/// Of the boxes around all bodies, or of what the bodies fill of them.
double particles_in_boxes(const Scene& scene, bool filled) {
  double sum = 0;
  const int dimension = scene.dimension();
  for (const BodySpec& body : scene.bodies) {
    const Bounds box = bounds(body.shape);
    double count = particles_per_cell(body, dimension);
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
      count *= (box.upper[d] - box.lower[d]) / scene.grid.cell;
    sum += filled ? count * filled_share(body.shape, box, dimension) : count;
  }
  return sum;
}

std::string in_gibibytes(double bytes) { return fmt::format("{:.3g} GiB", bytes / 1073741824.0); }

}  // namespace

double passing_bytes(const Scene& scene, double particles) {
  // The search lists where the domain of each particle is; what lies in the box of another body it sorts. At
  // the start there are no nodes yet, and nothing is sorted. What of a frame is compressed is about half as
  // large, and one column is there as it was.
  constexpr double kSearch = 145, kSearchAtStart = 80, kFrame = 185, kPicture = 30;  // a particle
  constexpr double kCanvas = 40 << 20;
  const bool plane = scene.dimension() == 2;
  double most = 0;
  if (scene.output.picture != "none") most = kPicture * particles + kCanvas;
  if (plane && scene.bodies.size() > 1) most = std::max(most, kSearchAtStart * particles);
  if (plane && scene.output.overlap) most = std::max(most, kSearch * particles);
  if (scene.output.frames > 0) most = std::max(most, kFrame * particles);
  return most;
}

double estimated_particles(const Scene& scene) { return particles_in_boxes(scene, true); }

double estimated_bytes(const Scene& scene, const Plan& plan, double particles) {
  return passing_bytes(scene, particles) +
         (scene.dimension() == 3 ? bytes_of<3>(scene, plan, particles) : bytes_of<2>(scene, plan, particles));
}

std::uint64_t machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

void check_memory(const Scene& scene, const Plan& plan, std::uint64_t available) {
  const auto most = static_cast<double>(available);
  if (available == 0 || estimated_bytes(scene, plan, particles_in_boxes(scene, false)) <= most) return;
  const double particles = estimated_particles(scene), bytes = estimated_bytes(scene, plan, particles);
  if (bytes <= most) return;
  throw SceneError({Diagnostic{scene.file.string(), 0, 0, "grid.cell",
                               fmt::format("about {:.2g} particles would take {}, and there are {}",
                                           particles, in_gibibytes(bytes), in_gibibytes(most)),
                               "Take larger cells, fewer particles_per_cell or smaller bodies"}});
}

}  // namespace mpmfast
