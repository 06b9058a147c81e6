#include "engine/scene/scene.hpp"

#include <variant>

namespace mpmfast {

namespace {

const MaterialModel& model_of(const Scene& scene, const BodySpec& body) {
  return scene.materials[static_cast<std::size_t>(body.material)].model;
}

}  // namespace

double cell_volume(const Scene& scene) {
  const double h = scene.grid.cell;
  return scene.dimension() == 3 ? h * h * h : h * h * scene.thickness;
}

double density_of(const MaterialSpec& material) {
  return std::visit([](const auto& law) { return law.density; }, material.model);
}

bool is_rigid(const Scene& scene, const BodySpec& body) {
  return std::holds_alternative<Rigid>(model_of(scene, body));
}

bool parts(const Scene& scene, const BodySpec& body) {
  return std::visit(
      []<class Law>(const Law&) {
        return requires { Law::kParts; };
      },
      model_of(scene, body));
}

bool is_halved(const Scene& scene, const BodySpec& body) {
  return scene.space == Space::axisymmetric && scene.grid.origin[0] == 0 &&
         !std::holds_alternative<BoxShape>(body.shape) && bounds(body.shape).upper[0] > 0;
}

Seeds fill(const BodySpec& body, const GridSpec& grid, int dimension) {
  const CellLattice lattice{grid.origin, grid.size, grid.cell, body.particles_per_cell};
  return fill(body.shape, body.seeding, lattice, dimension);
}

}  // namespace mpmfast
