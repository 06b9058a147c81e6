#include "engine/contact/penalty/ledger.hpp"

#include "engine/contact/penalty/moment.hpp"

namespace mpmfast::penalty {

template <int Dim>
void record_contacts(const Surfaces<Dim>& surfaces, const BodyPairs& pairs,
                     const std::vector<ThreadContacts<Dim>>& contacts, double dt, ContactLedger<Dim>& out) {
  for (const auto& of_thread : contacts)
    for (std::size_t t = 0; t < of_thread.contacts.size(); ++t) {
      const PointContact<Dim>& contact = of_thread.contacts[t];
      const ContactForce<Dim>& force = of_thread.forces[t];
      out.friction_work += force.dissipated;
      const auto& own = surfaces.facet(contact.own_facet);
      const auto pair = pairs.named(own.body, surfaces.facet(contact.facet).body);
      if (!pair) continue;
      out.pair_impulse[pair->number] += (pair->forward ? dt : -dt) * force.force;
      out.pair_friction_work[pair->number] += force.dissipated;
      if (contact.energy > 0)  // the first contact of the point with the body
        out.pair_area[pair->number] += 0.5 / kFacetPoints<Dim> * own.area;
    }
}

template <int Dim>
void record_rigid_bodies(const SurfaceGeometry<Dim>& current, const SurfaceGeometry<Dim>& previous,
                         const BodyPairs& pairs, const std::vector<Vec<Dim>>& forces,
                         const std::vector<Vec<Dim>>& pivots, double dt, ContactLedger<Dim>& out) {
  const auto& bodies = current.surfaces().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!pairs.rigid[b]) continue;
    const auto field = static_cast<std::size_t>(pairs.field[b]);
    for (int p = bodies[b].first; p < bodies[b].first + bodies[b].count; ++p) {
      const Vec<Dim>& force = item(forces, p);
      if (force == Vec<Dim>::Zero()) continue;
      out.rigid_impulse[field] += dt * force;
      const Vec<Dim> arm = current.position(p) - pivots[field];
      if constexpr (Dim == 2)
        out.rigid_moment[field][2] += dt * moment<2>(arm, force);
      else
        out.rigid_moment[field] += dt * moment<3>(arm, force);
      out.rigid_work -= force.dot(current.position(p) - previous.position(p));
    }
  }
}

template void record_contacts<2>(const Surfaces<2>&, const BodyPairs&, const std::vector<ThreadContacts<2>>&,
                                 double, ContactLedger<2>&);
template void record_contacts<3>(const Surfaces<3>&, const BodyPairs&, const std::vector<ThreadContacts<3>>&,
                                 double, ContactLedger<3>&);
template void record_rigid_bodies<2>(const SurfaceGeometry<2>&, const SurfaceGeometry<2>&, const BodyPairs&,
                                     const std::vector<Vec<2>>&, const std::vector<Vec<2>>&, double,
                                     ContactLedger<2>&);
template void record_rigid_bodies<3>(const SurfaceGeometry<3>&, const SurfaceGeometry<3>&, const BodyPairs&,
                                     const std::vector<Vec<3>>&, const std::vector<Vec<3>>&, double,
                                     ContactLedger<3>&);

}  // namespace mpmfast::penalty
