#pragma once

/// @file The passes that depend on the basis, as the step calls them: one virtual call a pass, none per
/// particle.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/contact/contact_basis.hpp"
#include "engine/cracks/supports.hpp"
#include "engine/heat/carrier.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"
#include "kernels/transfer/update_rule.hpp"

namespace mpmfast {

template <int Dim>
class Passes : public ContactBasis<Dim>, public HeatCarrier<Dim> {
 public:
  /// Of the workspaces of the threads that work.
  virtual std::size_t workspace_bytes(int threads) const = 0;
  /// Convected half-edge vectors from F, where the basis has them: called once, after seeding.
  virtual void shape_domains(State<Dim>& state) = 0;
  /// The same, of particles that were split.
  virtual void shape_domains(State<Dim>& state, std::span<const std::uint32_t> particles) = 0;
  /// First support node of every particle, and the sort that follows from it.
  virtual void sort(State<Dim>& state) = 0;
  /// The nodes that particles reach; valid until the next sort.
  virtual Supports<Dim> supports(const State<Dim>& state) const = 0;
  /// Is every particle, and would it be if it went so much further along each axis, m, within a node of where
  /// it was sorted to?
  virtual bool near_home(const State<Dim>& state, double way) const = 0;
  /// Mass and momentum of every slot (N20 Eq. 5), and the internal force from stresses as they are if it is
  /// wanted (not of particles with slopes, nor about an axis); the columns must be zero.
  /// @return false if a particle's support left its window: sort and start again
  virtual bool project(State<Dim>& state, bool with_force) = 0;
  /// The volume of particles in each cell of the basis (Nodal::occupied, which must be zero).
  virtual void occupy(State<Dim>& state) = 0;
  /// f_i += Σ_p S_pi F_p of the boundary points p.
  /// @param forces  F, by number of the point (Surfaces::number)
  virtual void push(State<Dim>& state, const std::vector<Vec<Dim>>& forces) = 0;
  /// The same, and V ← S v of the boundary points, v the nodal `velocity`: what they lose, P = M (V − S v),
  /// leaves the nodal momentum, Σ_p S_pi P_p, and acts as a force, Σ_p S_pi P_p/Δt.
  virtual void settle(State<Dim>& state, const std::vector<Vec<Dim>>& forces, double dt) = 0;
  /// Strain over dt_strain from the nodal velocities (none if 0), then the internal force.
  /// @return whether each J is a positive number
  virtual bool strain_and_force(State<Dim>& state, double dt_strain, int terms) = 0;
  /// One order of XPIC: next += Σ_p S_pi M_p S_p star. @param paired carries Δv* beside v*
  virtual void xpic(State<Dim>& state, bool paired) = 0;
  /// momentum += Σ_p S_pi M_p V_new with the velocities that `update` will give the particles, from aΔt
  /// (force), for XPIC m(v − v*) + aΔt (star), else v⁺ (velocity). Rigid bodies keep what they have.
  virtual void re_extrapolate(State<Dim>& state, ParticleUpdate update) = 0;
  /// New particle velocities, positions, (strain last) strains, domains.
  virtual TileReport update(State<Dim>& state, const UpdateRule& rule, const Vec<Dim>& lower,
                            const Vec<Dim>& upper) = 0;
};

/// The passes of a basis.
template <int Dim>
std::unique_ptr<Passes<Dim>> make_passes(BasisKind basis);

/// The same, of a basis that is known; each is compiled in a file of its own (passes_of.cpp.in).
template <int Dim, BasisKind kind>
std::unique_ptr<Passes<Dim>> make_passes_of();

}  // namespace mpmfast
