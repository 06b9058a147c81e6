#include "engine/plan/memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/constants.hpp"
#include "engine/geometry/shapes.hpp"
#include "engine/scene/text/diagnostic.hpp"
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

/// Slots that a body takes: of full tiles inside, and of the tiles around it, as far as its box reaches.
double slots_of(const BodySpec& body, double cell, int dimension) {
  const Bounds box = bounds(body.shape);
  double inner = 1, all = 1, slots_of_tile = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    const double tiles = (box.upper[d] - box.lower[d]) / (kTileSide * cell);
    inner *= tiles;
    all *= tiles + 1.75;  // it begins anywhere in a tile, and windows reach a tile further
    slots_of_tile *= kTileSide;
  }
  const double share = filled_share(body.shape, box, dimension);
  const double thin = 1.5 * share * inner;  // of what has holes, but tiles are not full
  return slots_of_tile * std::max(thin, share * inner + all - inner);
}

struct Bytes {
  double columns = 0;  ///< of the particles
  double later = 0;    ///< nodes, tiles and the sort
};

template <int Dim>
Bytes bytes_of(const Scene& scene, const Plan& plan, double particles) {
  double columns = 0, nodal = 0, slots = 0;
  for (const Quantity q : plan.particle_columns) columns += Particles<Dim>::components(q);
  for (const Nodal q : plan.nodal_columns) nodal += Nodes<Dim>::components(q);
  for (const BodySpec& body : scene.bodies) slots += slots_of(body, scene.grid.cell, Dim);
  constexpr double kIdentity = 6, kSort = 24, kTiles = 6;  // bytes a particle
  return {particles * (8 * columns + kIdentity), particles * (kSort + kTiles) + slots * 8 * nodal};
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

/// The share of the particles that the search for overlaps lists at the start (output/overlap.cpp): those in
/// the box around another body; of many bodies all.
double share_near_others(const Scene& scene) {
  if (scene.bodies.size() > constants::plan::kManyBodies) return 1;
  const auto dimension = static_cast<std::size_t>(scene.dimension());
  double all = 0, near = 0;
  for (const BodySpec& body : scene.bodies) {
    const Bounds own = bounds(body.shape);
    double volume = 1, shared = 0;
    for (std::size_t d = 0; d < dimension; ++d) volume *= own.upper[d] - own.lower[d];
    for (const BodySpec& other : scene.bodies) {
      if (&other == &body) continue;
      const Bounds box = bounds(other.shape);
      double common = 1;
      for (std::size_t d = 0; d < dimension; ++d)
        common *= std::max(0.0, std::min(own.upper[d], box.upper[d]) - std::max(own.lower[d], box.lower[d]));
      shared += common;
    }
    const double density = particles_per_cell(body, scene.dimension());
    all += density * volume;
    near += density * std::min(volume, shared);
  }
  return all > 0 ? near / all : 0;
}

std::string in_gibibytes(double bytes) { return fmt::format("{:.3g} GiB", bytes / 1073741824.0); }

/// Of a picture that shows the box around all particles. It is drawn by output/picture.cpp: 1000 pixels wide
/// or high, of which numbers, titles and the colour bar leave the plot kPlotX by kPlotY.
double pixels_of_picture(const Scene& scene) {
  constexpr double kSide = 1000, kPlotX = 766, kPlotY = 852, kLeastPlot = 260;
  if (scene.dimension() == 3) return kSide * kSide;
  const auto& size = scene.grid.size;
  Bounds box{{size[0], size[1], 0}, {}};
  for (const BodySpec& body : scene.bodies)
    for (std::size_t d = 0; d < 2; ++d) {
      const Bounds own = bounds(body.shape);
      const double origin = scene.grid.origin[d];
      box.lower[d] = std::min(box.lower[d], std::clamp(own.lower[d] - origin, 0.0, size[d]));
      box.upper[d] = std::max(box.upper[d], std::clamp(own.upper[d] - origin, 0.0, size[d]));
    }
  const auto width = [&](std::size_t d) { return std::max(box.upper[d] - box.lower[d], 0.01 * size[d]); };
  // Its sides may grow to those of the grid: of the shapes that it may come to have, that of most pixels.
  const double steepness = std::clamp(kPlotY / kPlotX, width(1) / size[0], size[1] / width(0));
  return (kSide - kPlotX + std::clamp(kPlotY / steepness, kLeastPlot, kPlotX)) *
         (kSide - kPlotY + std::clamp(kPlotX * steepness, kLeastPlot, kPlotY));
}

/// Of a picture without its particles. A pixel takes 9 samples of 4 bytes, to which come 7 when it is
/// written, or before that, in 3-D, whether each sample is covered. The rest are letters, and Cairo itself.
double canvas_bytes(const Scene& scene) {
  constexpr double kCairo = 3.5 * (1 << 20);
  return kCairo + (scene.dimension() == 3 ? 45 : 43) * pixels_of_picture(scene);
}

}  // namespace

PassingNeed passing_need(const Scene& scene, double particles, double later) {
  // Bytes a particle. The search lists the domains that may meet another body's, and sorts them. A frame is
  // what zlib makes of the columns of deformed particles, where zeros cost nothing. A row has a number of
  // each.
  const bool plane = scene.dimension() == 2;
  const double frame = plane ? 95 : 145, picture = plane ? 16 : 40;
  constexpr double kSearch = 100, kRow = 8;
  PassingNeed most{kRow * particles, "a row of the history"};
  const auto need = [&](double bytes, const char* reason) {
    if (bytes > most.bytes) most = {bytes, reason};
  };
  if (scene.output.picture != "none") need(picture * particles + canvas_bytes(scene), "a picture");
  if (plane && scene.bodies.size() > 1)
    need(kSearch * particles * share_near_others(scene) - later, "the search for bodies that overlap");
  if (plane && scene.output.overlap) need(kSearch * particles, "the search for bodies that overlap");
  if (scene.output.frames > 0) need(frame * particles, "a frame");
  return most;
}

double estimated_particles(const Scene& scene) { return particles_in_boxes(scene, true); }

double estimated_bytes(const Scene& scene, const Plan& plan, double particles) {
  if (plan.split_edge > 0) particles *= 1 + constants::plan::kSplitAllowance;
  const Bytes lasting =
      scene.dimension() == 3 ? bytes_of<3>(scene, plan, particles) : bytes_of<2>(scene, plan, particles);
  return lasting.columns + lasting.later + passing_need(scene, particles, lasting.later).bytes;
}

void check_memory(const Scene& scene, const Plan& plan, const MemoryLimit& available) {
  const auto most = static_cast<double>(available.bytes);
  if (available.bytes == 0 || estimated_bytes(scene, plan, particles_in_boxes(scene, false)) <= most) return;
  const double particles = estimated_particles(scene), bytes = estimated_bytes(scene, plan, particles);
  if (bytes <= most) return;
  throw SceneError(
      {Diagnostic{scene.file.string(), 0, 0, "grid.cell",
                  fmt::format("about {:.2g} particles would take {}, and there are {} {}", particles,
                              in_gibibytes(bytes), in_gibibytes(most), available.whose),
                  "Take larger cells, fewer particles_per_cell or smaller bodies"}});
}

}  // namespace mpmfast
