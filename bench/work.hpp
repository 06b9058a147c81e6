#pragma once

/// @file The least work of a pass on one particle, from which its bound on this machine follows: every column
/// that it needs crosses the memory bus once for reading and once for writing, every nodal column likewise
/// (shared among the particles), and only the flops of the formulas count (a multiply-add is two; lanes that
/// pad are none; values alone where no gradient is asked for). A pass that does more than that shows as a
/// smaller share of the bound.

#include <initializer_list>

#include "engine/plan/plan.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/nodes.hpp"
#include "engine/state/particles.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast::bench {

struct Work {
  double bytes, flops;
};

template <int Dim>
int doubles(std::initializer_list<Quantity> quantities) {
  int sum = 0;
  for (Quantity q : quantities) sum += Particles<Dim>::components(q);
  return sum;
}

template <int Dim>
class PassWork {
 public:
  /// @param slots_per_particle  nodal slots over particles
  PassWork(BasisKind basis, double slots_per_particle) : basis_(basis), slots_(slots_per_particle) {}

  Work project() const {
    return {bytes(where() + doubles<Dim>({Quantity::mass, Quantity::velocity}), 2 * (1 + Dim)),
            values() + Dim + scatter(1 + Dim)};
  }
  /// The internal force beside mass and momentum, from stresses as they are.
  Work project_force() const {
    const int rows = doubles<Dim>({Quantity::mass, Quantity::velocity, Quantity::initial_volume}) +
                     Dim * (Dim + 1) / 2;  // of a stress in the plane or in space
    return {bytes(where() + rows, 2 * (1 + 2 * Dim)),
            both() + Dim + scatter(1 + Dim) + scatter(Dim * Dim) + Dim * Dim};
  }
  /// APIC: slopes beside the velocity.
  Work project_affine() const {
    const Work plain = project();
    return {plain.bytes + 8.0 * Dim * Dim, plain.flops + Dim * (3.0 * Dim + nodes() * 2.0)};
  }
  Work strain_and_force() const {
    const int rows =
        2 * doubles<Dim>({Quantity::deformation_gradient}) +
        doubles<Dim>({Quantity::kirchhoff_stress, Quantity::wave_speed, Quantity::initial_volume});
    return {bytes(where() + rows, 3 * Dim),
            gradients() + 2 * scatter(Dim * Dim) + kStrain + kNeoHookean + Dim * Dim};
  }
  /// @param vectors  gathered from the nodes: 2 (FLIP) or 3 (XPIC)
  Work update(int vectors) const {
    const bool convected = is_convected();
    int rows = where() + doubles<Dim>({Quantity::position, Quantity::wave_speed}) +
               2 * doubles<Dim>({Quantity::velocity});
    if (convected) rows += doubles<Dim>({Quantity::domain_edges, Quantity::deformation_gradient});
    return {bytes(rows, vectors * Dim),
            values() + scatter(vectors * Dim) + 10 * Dim + (convected ? 4 * Dim * Dim : 0)};
  }
  /// With strain and stress after the velocities.
  Work update_strain(int vectors) const {
    const Work plain = update(vectors);
    const int rows = (is_convected() ? 1 : 2) * doubles<Dim>({Quantity::deformation_gradient}) +
                     doubles<Dim>({Quantity::kirchhoff_stress});
    return {plain.bytes + 8.0 * rows,
            plain.flops - values() + both() + scatter(Dim * Dim) + kStrain + kNeoHookean};
  }
  /// APIC: the moments of the velocity beside it.
  Work update_affine() const {
    const Work plain = update(2);
    return {plain.bytes + 8.0 * Dim * Dim, plain.flops + scatter(Dim * Dim) + 3.0 * Dim * Dim};
  }
  /// @param vectors  v* alone (1) or with Δv* (2)
  Work xpic(int vectors) const {
    return {bytes(where() + doubles<Dim>({Quantity::mass}), 3 * vectors * Dim),
            values() + 2 * scatter(vectors * Dim) + vectors * Dim};
  }
  /// Strains and stresses a second time in a step, where the update has placed the particle already.
  Work second_strain() const {
    const int rows = 2 * doubles<Dim>({Quantity::deformation_gradient}) +
                     doubles<Dim>({Quantity::kirchhoff_stress, Quantity::wave_speed});
    return {8.0 * rows, gradients() + scatter(Dim * Dim) + kStrain + kNeoHookean};
  }
  /// The passes of a whole step without contact, between which nothing stays in the caches; without the sort.
  Work step(const Plan& plan) const {
    const bool affine = plan.update == ParticleUpdate::apic;
    Work sum = affine ? project_affine() : project();
    const auto add = [&sum](const Work& work) {
      sum.bytes += work.bytes;
      sum.flops += work.flops;
    };
    add(strain_and_force());
    if (plan.strain_first > 0 && plan.strain_first < 1) add(second_strain());
    for (int k = 2; k <= plan.order; ++k) add(xpic(1));
    add(affine ? update_affine() : update(update_vectors(plan.update)));
    return sum;
  }
  /// Every column read and written once.
  Work sort(const std::vector<Quantity>& columns) const {
    int rows = 0;
    for (Quantity q : columns) rows += Particles<Dim>::components(q);
    return {16.0 * rows + 12, 0};
  }

 private:
  /// F ← exp(Δt L) F with two terms: Δt L, its square, their sum, the product.
  static constexpr int kStrain = Dim * Dim * (1 + (2 * Dim - 1) + 2 + 2 * Dim);
  /// Counted in kernels/materials/neo_hookean.hpp, with 70 for the logarithm and the exponential.
  static constexpr int kNeoHookean = Dim == 2 ? 125 : 185;

  bool is_convected() const { return facts(basis_).convected; }
  int support() const { return facts(basis_).usual_support; }
  int nodes() const { return power(support(), Dim); }
  double scatter(int components) const { return 2.0 * nodes() * components; }

  /// What places a particle on the grid.
  int where() const {
    return doubles<Dim>({Quantity::position}) + (is_convected() ? doubles<Dim>({Quantity::domain_edges}) : 0);
  }
  double bytes(int rows, int nodal_rows) const { return 8.0 * (rows + slots_ * nodal_rows); }

  /// Values of one-dimensional functions (with their derivatives), and their products.
  double one_dimensional() const {
    return Dim * (basis_ == BasisKind::linear     ? 4.0
                  : basis_ == BasisKind::ugimp    ? 26.0
                  : basis_ == BasisKind::bspline3 ? 27.0
                                                  : 14.0);
  }
  /// CPDI: hats or quadratic splines at the corners, their products, summed.
  double corners(int sums) const {
    const double each = basis_ == BasisKind::lcpdi ? 2.0 : 8.0;
    return kCorners<Dim> * (Dim * (Dim + each * support()) + nodes() * (Dim - 1.0 + sums));
  }
  double values() const {
    return is_convected() ? corners(1) + nodes() : one_dimensional() + nodes() * (Dim - 1.0);
  }
  double gradients() const {
    if (is_convected()) return corners(Dim) + nodes() * Dim * 2.0 * Dim;
    return one_dimensional() + nodes() * Dim * (Dim - 1.0);
  }
  /// Both from the same functions of one dimension, or at the same corners.
  double both() const {
    return is_convected() ? corners(1 + Dim) + nodes() * (1 + Dim * 2.0 * Dim)
                          : gradients() + nodes() * (Dim - 1.0);
  }

  BasisKind basis_;
  double slots_;
};

}  // namespace mpmfast::bench
