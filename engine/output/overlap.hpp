#pragma once

/// @file Interpenetration: how much of the plane two bodies both claim.

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/state/particles.hpp"
#include "engine/state/surfaces.hpp"
#include "kernels/views.hpp"

namespace mpmfast {

/// The domain of a particle: all centre + edges · u with |u_k| ≤ 1.
struct ParticleDomain {
  Vec<2> centre;  ///< m
  Mat<2> edges;   ///< m, columns: half-edge vectors F diag(R0)
  int owner{};    ///< who claims it: domains of one owner do not count as an overlap
  double area() const;
};

struct Overlap {
  /// m². Σ over pairs of particles of different owners of the area common to their domains. The domains of a
  /// body tile it, so this is what two bodies both claim; what three claim counts for each of three pairs.
  double area{};
  /// m². Area of the particles whose centre lies in a domain of another owner. Strained domains no longer
  /// tile exactly and common slivers add to `area`; here they do not show.
  double inside{};
  std::uint64_t particles_inside{};
  std::pair<int, int> owners{-1, -1};  ///< of such a particle, and of the domain that it lies in
};

/// Area common to two domains, m².
double common_area(const ParticleDomain& p, const ParticleDomain& q);

/// Bitwise the same for any number of threads; the order of the domains is that of the sums.
Overlap measure_overlap(const std::vector<ParticleDomain>& domains, int threads);
/// The same of the particle_domains() of particles, to the bit.
Overlap measure_overlap(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                        const std::vector<int>& owner, const Surfaces<2>& surfaces, int threads);
/// Σ of their areas, in the same order, m².
double area_of_domains(const Particles<2>& particles, const std::vector<BodyView<2>>& bodies,
                       const Surfaces<2>& surfaces);

/// The domains of all particles in the order of their ids, so that their sort does not show in the sums.
/// Boundary points of surfaces that are followed have none.
/// @param bodies   as Scene::bodies, for the undeformed sizes
/// @param owner    of the particles of each body
std::vector<ParticleDomain> particle_domains(const Particles<2>& particles,
                                             const std::vector<BodyView<2>>& bodies,
                                             const std::vector<int>& owner, const Surfaces<2>& surfaces = {});

}  // namespace mpmfast
