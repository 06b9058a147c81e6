#include "engine/contact/penalty/forces.hpp"

#include <algorithm>
#include <array>
#include <variant>

#include "engine/contact/penalty/moment.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

namespace {

/// Tangential slip of a point of integration over the closest point since the last step, m.
template <int Dim>
Vec<Dim> slip_of(const PointContact<Dim>& contact, const SurfaceMotion<Dim>& motion) {
  Vec<Dim> slip = motion.current.integration_point(contact.own_facet, contact.own_point) -
                  motion.previous.integration_point(contact.own_facet, contact.own_point);
  const auto& corner = motion.current.facet(contact.facet).point;
  for (std::size_t k = 0; k < Dim; ++k)
    slip -= contact.weight[k] * (motion.current.position(corner[k]) - motion.previous.position(corner[k]));
  return slip - slip.dot(contact.exit_direction) * contact.exit_direction;
}

/// Drag of a viscous film, half of it for each side. @param area  of the film, m²
template <int Dim>
TangentialForce<Dim> film_drag(const Viscous& law, double area, const Vec<Dim>& slip, double elapsed) {
  if (!(elapsed > 0)) return {Vec<Dim>::Zero(), 0, 0};
  const Vec<Dim> force = -0.5 * law.viscosity / law.film * area / elapsed * slip;
  return {force, -force.dot(slip), 0};
}

/// Force along the surface: of a film, or of the spring, which is restored at its last stretch.
template <int Dim>
TangentialForce<Dim> tangential_force(const PointContact<Dim>& contact, const SurfaceMotion<Dim>& motion,
                                      const BodyPairs& pairs, TangentialSpring<Dim>& spring) {
  const auto& other = motion.current.facet(contact.facet);
  const int body = motion.current.facet(contact.own_facet).body;
  const AnyLaw& law = pairs.law(body, other.body);
  const Vec<Dim> slip = slip_of(contact, motion);
  if (const auto* film = std::get_if<Viscous>(&law)) {
    const double area = contact.stiffness / (0.5 * pairs.stiffness(body, other.body));
    return film_drag(*film, area, slip, motion.elapsed);
  }
  if (spring.patch == other.patch)
    stretch_spring(spring, slip, contact.exit_direction);
  else
    spring = {other.patch, false, Vec<Dim>::Zero()};
  const double normal = contact.stiffness * contact.compression;
  const double speed = motion.elapsed > 0 ? slip.norm() / motion.elapsed : 0;
  return return_to_limit(spring, pairs.springs.tangential * contact.stiffness,
                         friction_limit(law, normal, speed, spring.slides));
}

template <int Dim>
ContactForce<Dim> contact_force(const PointContact<Dim>& contact, const SurfaceMotion<Dim>& motion,
                                const BodyPairs& pairs, TangentialSpring<Dim>& spring) {
  const TangentialForce<Dim> tangential = tangential_force(contact, motion, pairs, spring);
  ContactForce<Dim> out;
  out.force = contact.stiffness * contact.compression * contact.exit_direction + tangential.force;
  out.dissipated = tangential.dissipated;
  out.stored = tangential.stored;
  std::array<Vec<Dim>, Dim> corner;
  for (std::size_t k = 0; k < Dim; ++k)
    corner[k] = motion.current.position(motion.current.facet(contact.facet).point[k]);
  distribute_reaction<Dim>(contact, corner, out.force, out.reaction);
  return out;
}

/// Forces of the contacts of one thread. A point of integration belongs to one thread.
template <int Dim>
void compute_forces(const SurfaceMotion<Dim>& motion, const BodyPairs& pairs, FrictionHistory<Dim>& history,
                    ThreadContacts<Dim>& out) {
  out.forces.clear();
  out.points = 0;
  for (std::size_t begin = 0, end = 0; begin < out.contacts.size(); begin = end) {
    const PointContact<Dim>& first = out.contacts[begin];
    PointSprings<Dim>& known =
        history[static_cast<std::size_t>(kFacetPoints<Dim> * first.own_facet + first.own_point)];
    PointSprings<Dim> stored{motion.step, {}};
    for (; end < out.contacts.size(); ++end) {
      const PointContact<Dim>& contact = out.contacts[end];
      if (contact.own_facet != first.own_facet || contact.own_point != first.own_point) break;
      TangentialSpring<Dim> spring = known.restore(motion.current.facet(contact.facet).patch, motion.step);
      out.forces.push_back(contact_force(contact, motion, pairs, spring));
      if (end - begin < kMaxSprings) stored.springs[end - begin] = spring;
    }
    known = stored;
    ++out.points;
  }
}

}  // namespace

template <int Dim>
void distribute_reaction(const PointContact<Dim>& contact, const std::array<Vec<Dim>, Dim>& corner,
                         const Vec<Dim>& force, Vec<Dim> (&out)[Dim]) {
  for (int k = 0; k < Dim; ++k) out[k] = -contact.weight[k] * force;
  const auto wanted = moment<Dim>(contact.to_surface, force);
  // Moments of a unit force on corner k and its opposite on the first.
  std::array<decltype(moment<Dim>(force, force)), Dim - 1> arm;
  for (std::size_t k = 1; k < Dim; ++k)
    arm[k - 1] = moment<Dim>(corner[k] - corner[0], contact.exit_direction);
  std::array<double, Dim - 1> size;
  if constexpr (Dim == 2) {
    size[0] = wanted / arm[0];
  } else {
    // Least squares: normal forces have no moment about the normal.
    const double aa = arm[0].squaredNorm(), bb = arm[1].squaredNorm(), ab = arm[0].dot(arm[1]);
    const double a = wanted.dot(arm[0]), b = wanted.dot(arm[1]), determinant = aa * bb - ab * ab;
    size = {(a * bb - b * ab) / determinant, (b * aa - a * ab) / determinant};
  }
  for (std::size_t k = 1; k < Dim; ++k) {
    out[k] += size[k - 1] * contact.exit_direction;
    out[0] -= size[k - 1] * contact.exit_direction;
  }
}

template <int Dim>
void compute_contact_forces(const SurfaceMotion<Dim>& motion, const BodyPairs& pairs, int threads,
                            std::vector<ThreadContacts<Dim>>& contacts, FrictionHistory<Dim>& history) {
  share_out(static_cast<std::int64_t>(contacts.size()), threads, 1,
            [&](std::int64_t t) { compute_forces(motion, pairs, history, item(contacts, t)); });
}

template <int Dim>
void assemble_point_forces(const Surfaces<Dim>& surfaces, const std::vector<ThreadContacts<Dim>>& contacts,
                           std::vector<Vec<Dim>>& out) {
  std::fill(out.begin(), out.end(), Vec<Dim>::Zero());
  for (const auto& of_thread : contacts)
    for (std::size_t t = 0; t < of_thread.contacts.size(); ++t) {
      const PointContact<Dim>& contact = of_thread.contacts[t];
      const ContactForce<Dim>& force = of_thread.forces[t];
      const auto &own = surfaces.facet(contact.own_facet).point, &other = surfaces.facet(contact.facet).point;
      for (int k = 0; k < Dim; ++k) {
        item(out, item(own, k)) += corner_weight<Dim>(contact.own_point, k) * force.force;
        item(out, item(other, k)) += force.reaction[k];
      }
    }
}

template <int Dim>
double tangential_energy(const std::vector<ThreadContacts<Dim>>& contacts) {
  double sum = 0;
  for (const auto& of_thread : contacts)
    for (const auto& force : of_thread.forces) sum += force.stored;
  return sum;
}

template void distribute_reaction<2>(const PointContact<2>&, const std::array<Vec<2>, 2>&, const Vec<2>&,
                                     Vec<2> (&)[2]);
template void distribute_reaction<3>(const PointContact<3>&, const std::array<Vec<3>, 3>&, const Vec<3>&,
                                     Vec<3> (&)[3]);
template void compute_contact_forces<2>(const SurfaceMotion<2>&, const BodyPairs&, int,
                                        std::vector<ThreadContacts<2>>&, FrictionHistory<2>&);
template void compute_contact_forces<3>(const SurfaceMotion<3>&, const BodyPairs&, int,
                                        std::vector<ThreadContacts<3>>&, FrictionHistory<3>&);
template void assemble_point_forces<2>(const Surfaces<2>&, const std::vector<ThreadContacts<2>>&,
                                       std::vector<Vec<2>>&);
template void assemble_point_forces<3>(const Surfaces<3>&, const std::vector<ThreadContacts<3>>&,
                                       std::vector<Vec<3>>&);
template double tangential_energy<2>(const std::vector<ThreadContacts<2>>&);
template double tangential_energy<3>(const std::vector<ThreadContacts<3>>&);

}  // namespace mpmfast::penalty
