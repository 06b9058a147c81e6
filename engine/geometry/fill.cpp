#include "engine/geometry/fill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/geometry/conforming.hpp"
#include "engine/geometry/outline.hpp"
#include "engine/geometry/surface.hpp"

namespace mpmfast {

namespace {

/// Points along one axis: some, from `begin` on, of first, first + spacing …
struct Row {
  double first = 0, spacing = 0;
  long count = 1, begin = 0;

  double at(long i) const { return first + spacing * static_cast<double>(begin + i); }
};
using Lattice = std::array<Row, 3>;

/// A lattice that ends on the faces of a box.
Lattice lattice_of(const Bounds& box, const CellLattice& grid, int dimension) {
  Lattice lattice;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const double edge = box.upper[k] - box.lower[k];
    const double wanted = grid.cell / grid.particles_per_cell[k];
    const long count = std::max(std::lround(edge / wanted), 1L);
    const double spacing = edge / static_cast<double>(count);
    lattice[k] = {box.lower[k] + 0.5 * spacing, spacing, count};
  }
  return lattice;
}

/// The grid's lattice where the shape can be, with a point to spare on each side against round-off. All
/// bodies count from the grid's corner: to the last bit a point is the same for each, so that two grey levels
/// of a picture never both have it.
Lattice grid_lattice(const Bounds& box, const CellLattice& grid, int dimension) {
  Lattice lattice;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    const double spacing = grid.cell / grid.particles_per_cell[k];
    const long all = std::lround(grid.size[k] / spacing);
    const auto index = [&](double x) {
      return std::clamp((x - grid.origin[k]) / spacing, 0.0, static_cast<double>(all));
    };
    const long begin = std::max(static_cast<long>(std::floor(index(box.lower[k]))) - 1, 0L);
    const long end = std::min(static_cast<long>(std::ceil(index(box.upper[k]))) + 1, all);
    lattice[k] = {grid.origin[k] + 0.5 * spacing, spacing, std::max(end - begin, 0L), begin};
  }
  return lattice;
}

/// Hands over every point of the lattice, x fastest.
template <class Visit>
void each_point(const Lattice& lattice, const Visit& visit) {
  for (long k = 0; k < lattice[2].count; ++k) {
    for (long j = 0; j < lattice[1].count; ++j) {
      for (long i = 0; i < lattice[0].count; ++i)
        visit(Vec3{lattice[0].at(i), lattice[1].at(j), lattice[2].at(k)});
    }
  }
}

/// Hands over every point of the lattice that lies inside the shape. A surface is asked once a row.
template <class Visit>
void each_point_inside(const Lattice& lattice, const Shape& shape, const Visit& visit) {
  const auto* stl = std::get_if<StlShape>(&shape);
  if (!stl) {
    return each_point(lattice, [&](const Vec3& point) {
      if (contains(shape, point)) visit(point);
    });
  }
  std::vector<Crossing> crossings;
  for (long k = 0; k < lattice[2].count; ++k) {
    for (long j = 0; j < lattice[1].count; ++j) {
      const double y = lattice[1].at(j), z = lattice[2].at(k);
      stl->surface->crossings(y, z, crossings);
      std::size_t passed = 0;
      int winding = 0;
      for (long i = 0; i < lattice[0].count; ++i) {
        const double x = lattice[0].at(i);
        for (; passed < crossings.size() && crossings[passed].x <= x; ++passed)
          winding += crossings[passed].winding;
        if (winding != 0) visit(Vec3{x, y, z});
      }
    }
  }
}

/// The half-edges of the domains of a lattice's points.
Vec3 half_size_of(const Lattice& lattice) {
  return {0.5 * lattice[0].spacing, 0.5 * lattice[1].spacing, 0.5 * lattice[2].spacing};
}

Seeds fill_straight(const Shape& shape, const CellLattice& grid, int dimension) {
  const bool box = std::holds_alternative<BoxShape>(shape);
  const Bounds around = bounds(shape);
  const Lattice lattice = box ? lattice_of(around, grid, dimension) : grid_lattice(around, grid, dimension);
  Seeds seeds;
  seeds.half_size = half_size_of(lattice);
  const auto keep = [&](const Vec3& point) { seeds.position.push_back(point); };
  if (box)
    each_point(lattice, keep);
  else
    each_point_inside(lattice, shape, keep);
  return seeds;
}

/// The point turned by an angle about the z axis.
Vec3 turned(const Vec3& point, double angle) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  return {cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1], point[2]};
}

/// A shape turned about the z axis.
struct Turn {
  double angle;

  Shape operator()(const BoxShape& box) const {
    const Vec3 &a = box.lower, &b = box.upper;
    return (*this)(PolygonShape{{{a[0], a[1]}, {b[0], a[1]}, {b[0], b[1]}, {a[0], b[1]}}, a[2], b[2]});
  }
  Shape operator()(EllipsoidShape shape) const {
    shape.centre = turned(shape.centre, angle);
    shape.angle += angle;
    return shape;
  }
  Shape operator()(RingShape ring) const {
    ring.centre = turned(ring.centre, angle);
    return ring;
  }
  Shape operator()(PolygonShape polygon) const {
    for (auto& point : polygon.points) {
      const Vec3 there = turned({point[0], point[1], 0}, angle);
      point = {there[0], there[1]};
    }
    return polygon;
  }
  Shape operator()(const BitmapShape& bitmap) const { return bitmap; }  // its levels share the grid's lattice
  Shape operator()(StlShape stl) const {                                // of which only the surface counts
    stl.surface = std::make_shared<Surface>(stl.surface->placed(1, {0, 0, 1}, angle, {0, 0, 0}));
    return stl;
  }
};

/// Seen along the lattice's axes, the lattice ends on the faces of the box around the shape.
Seeds fill_turned(const Shape& shape, double angle, const CellLattice& grid, int dimension) {
  const Shape straight = std::visit(Turn{-angle}, shape);
  const Lattice lattice = lattice_of(bounds(straight), grid, dimension);
  Seeds seeds;
  seeds.half_size = half_size_of(lattice);
  each_point_inside(lattice, straight,
                    [&](const Vec3& point) { seeds.position.push_back(turned(point, angle)); });
  seeds.angle.assign(seeds.position.size(), angle);
  return seeds;
}

struct Annulus {
  Vec3 centre;
  double inner, outer;  ///< m
};

Annulus annulus_of(const Shape& shape) {
  if (const auto* ring = std::get_if<RingShape>(&shape)) return {ring->centre, ring->inner, ring->outer};
  const auto& disk = std::get<EllipsoidShape>(shape);
  return {disk.centre, 0, disk.radii[0]};
}

/// Rings of particles about the centre, as many on each as its length has space for, mirrored at the x axis.
Seeds fill_rings(const Shape& shape, const CellLattice& grid) {
  const Annulus annulus = annulus_of(shape);
  const double thickness = annulus.outer - annulus.inner;
  const auto per_cell = grid.particles_per_cell;
  const long rings = std::max(std::lround(thickness / (grid.cell / per_cell[0])), 1L);
  const double depth = thickness / static_cast<double>(rings), length = depth * per_cell[0] / per_cell[1];
  Seeds seeds;
  seeds.half_size = {0.5 * depth, 0.5 * length, 0};
  for (long k = 0; k < rings; ++k) {
    const double radius = annulus.inner + depth * (static_cast<double>(k) + 0.5);
    const double around = 2 * std::numbers::pi * radius;
    const long count = std::max(std::lround(around / length), 3L);
    for (long j = 0; j < count; ++j) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(count);
      const Vec3 arm = turned({radius, 0, 0}, angle);
      seeds.position.push_back({annulus.centre[0] + arm[0], annulus.centre[1] + arm[1], 0});
      seeds.angle.push_back(angle);
      seeds.share.push_back(around / static_cast<double>(count) / length);
    }
  }
  return seeds;
}

/// The angle about z of a polygon that is a rectangle, rad, −π/4 to π/4.
std::optional<double> angle_of_rectangle(const Shape& shape) {
  constexpr double kRoundOff = 1e-9;
  const auto* polygon = std::get_if<PolygonShape>(&shape);
  if (!polygon || polygon->points.size() != 4) return {};
  const auto& p = polygon->points;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto &a = p[k], &b = p[(k + 1) % 4], &c = p[(k + 2) % 4];
    const double u = b[0] - a[0], v = b[1] - a[1], x = c[0] - b[0], y = c[1] - b[1];
    if (!(std::abs(u * x + v * y) <= kRoundOff * std::hypot(u, v) * std::hypot(x, y))) return {};
  }
  return std::remainder(std::atan2(p[1][1] - p[0][1], p[1][0] - p[0][0]), std::numbers::pi / 2);
}

/// Particles along the outline of a plane shape that is no box. Where no layer of them fits, the grid's
/// lattice, with the area of the shape.
Seeds fill_outlined(const Shape& shape, const CellLattice& grid) {
  if (const auto angle = angle_of_rectangle(shape)) return fill_turned(shape, *angle, grid, 2);
  const double spacing = grid.cell / std::max(grid.particles_per_cell[0], grid.particles_per_cell[1]);
  const Outline around = outline(shape, spacing / kConformingPoints, 2);
  if (auto seeds = fill_conforming(around, grid)) return *std::move(seeds);
  Seeds seeds = fill_straight(shape, grid, 2);
  const double domain = 4 * seeds.half_size[0] * seeds.half_size[1];
  const auto count = static_cast<double>(seeds.position.size());
  if (count > 0) seeds.share.assign(seeds.position.size(), plane_area(around) / (domain * count));
  return seeds;
}

}  // namespace

Seeds fill(const Shape& shape, const Seeding& seeding, const CellLattice& grid, int dimension) {
  const bool box = std::holds_alternative<BoxShape>(shape);
  if (seeding.kind == SeedingKind::rings) return fill_rings(shape, grid);
  if (seeding.kind == SeedingKind::conforming && !box) return fill_outlined(shape, grid);
  if (seeding.angle != 0) return fill_turned(shape, seeding.angle, grid, dimension);
  return fill_straight(shape, grid, dimension);
}

}  // namespace mpmfast
