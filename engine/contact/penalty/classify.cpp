#include "engine/contact/penalty/classify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "engine/contact/penalty/penetration.hpp"
#include "engine/state/thread_team.hpp"

namespace mpmfast::penalty {

namespace {

/// Reads the inputs of a step, and classifies one facet at a time.
template <int Dim>
class Classifier {
 public:
  Classifier(const SurfaceGeometry<Dim>& geometry, const std::vector<FacetBounds<Dim>>& bounds,
             const std::vector<Vec<Dim>>& vertex_normals, const BodyPairs& pairs,
             const CandidateLists<Dim>& lists)
      : geometry_(geometry), bounds_(bounds), vertex_normals_(vertex_normals), pairs_(pairs), lists_(lists) {}

  /// Appends the contacts of a facet. @return are its points outside of all candidates' bodies?
  bool classify_facet(const FacetCandidates& list, ClassifyWorkspace<Dim>& workspace,
                      std::vector<PointContact<Dim>>& out) const;

  /// No point of a facet is nearer to its candidates, m.
  double clearance(const FacetCandidates& list) const;

 private:
  static constexpr int kPoints = kFacetPoints<Dim>;

  /// A point of integration.
  struct Point {
    int facet, number;
    Vec<Dim> x;  ///< m
  };
  /// Projections of a point on the patches of a body, by rising number of the patch.
  struct Projections {
    std::array<PatchProjection<Dim>, kMaxPatches> patch;
    int count = 0;
  };

  void group_by_body(const FacetCandidates& list, const Vec<Dim> (&x)[kPoints],
                     ClassifyWorkspace<Dim>& workspace) const;
  bool classify_point(const Point& point, const BodyCandidates<Dim>& body, const double* squared,
                      std::vector<PointContact<Dim>>& out) const;
  void project(const Point& point, int f, double squared, Projections& found) const;
  std::optional<ClosestPoint<Dim>> project_onto(const Vec<Dim>& x, int f, double reach) const;
  double spring_stiffness(const Point& point, const Penetration<Dim>& penetration) const;
  void append_contacts(const Point& point, std::span<const PatchProjection<Dim>> patches,
                       const Penetration<Dim>& penetration, double stiffness,
                       std::vector<PointContact<Dim>>& out) const;

  const SurfaceGeometry<Dim>& geometry_;
  const std::vector<FacetBounds<Dim>>& bounds_;
  const std::vector<Vec<Dim>>& vertex_normals_;
  const BodyPairs& pairs_;
  const CandidateLists<Dim>& lists_;
};

template <int Dim>
double Classifier<Dim>::clearance(const FacetCandidates& list) const {
  double least = kInfinity;
  for (int k = 0; k < kPoints; ++k) {
    const Vec<Dim> x = geometry_.integration_point(list.facet, k);
    for (int f : lists_.candidates(list)) {
      const FacetBounds<Dim>& other = item(bounds_, f);
      const Vec<Dim> from = x - other.centre;
      least = std::min(least, std::max(from.norm() - other.radius, std::abs(other.normal.dot(from))));
    }
  }
  return least;
}

/// Groups the candidates by body, and finds those with the nearest centres.
template <int Dim>
void Classifier<Dim>::group_by_body(const FacetCandidates& list, const Vec<Dim> (&x)[kPoints],
                                    ClassifyWorkspace<Dim>& workspace) const {
  const auto count = static_cast<std::size_t>(list.end - list.begin);
  if (workspace.squared.size() < kPoints * count) workspace.squared.resize(kPoints * count);
  workspace.bodies.clear();
  double least[kPoints]{};
  for (std::size_t j = 0; j < count; ++j) {
    const int at = list.begin + static_cast<int>(j);
    const FacetBounds<Dim>& other = item(bounds_, item(lists_.facets, at));
    if (workspace.bodies.empty() || workspace.bodies.back().body != other.body) {
      workspace.bodies.push_back({other.body, at, at, {}, 0});
      std::fill_n(workspace.bodies.back().nearest, kPoints, at);
      std::fill(least, least + kPoints, kInfinity);
    }
    BodyCandidates<Dim>& body = workspace.bodies.back();
    body.end = at + 1;
    body.largest_radius = std::max(body.largest_radius, other.radius);
    for (std::size_t k = 0; k < kPoints; ++k) {
      const double squared = (x[k] - other.centre).squaredNorm();
      workspace.squared[k * count + j] = squared;
      if (!(squared < least[k])) continue;
      least[k] = squared;
      body.nearest[k] = at;
    }
  }
}

template <int Dim>
bool Classifier<Dim>::classify_facet(const FacetCandidates& list, ClassifyWorkspace<Dim>& workspace,
                                     std::vector<PointContact<Dim>>& out) const {
  Vec<Dim> x[kPoints];
  for (int k = 0; k < kPoints; ++k) x[k] = geometry_.integration_point(list.facet, k);
  group_by_body(list, x, workspace);
  const int count = list.end - list.begin;
  bool outside = true;
  for (int k = 0; k < kPoints; ++k)
    for (const BodyCandidates<Dim>& body : workspace.bodies) {
      // Most points are well outside: farther above the nearest candidate than any candidate is wide.
      const FacetBounds<Dim>& nearest = item(bounds_, item(lists_.facets, body.nearest[k]));
      if (nearest.normal.dot(x[k] - nearest.centre) > 2 * body.largest_radius) continue;
      const double* squared = workspace.squared.data() + (k * count + body.begin - list.begin);
      outside &= classify_point({list.facet, k, x[k]}, body, squared, out);
    }
  return outside;
}

/// Projects a point on the patches of a body, and appends its contacts with them.
/// @param squared  from the point to the centres of the body's candidates, m²
/// @return is the point outside of the body?
template <int Dim>
bool Classifier<Dim>::classify_point(const Point& point, const BodyCandidates<Dim>& body,
                                     const double* squared, std::vector<PointContact<Dim>>& out) const {
  Projections found;
  const auto project_candidate = [&](int at) {
    project(point, item(lists_.facets, at), squared[at - body.begin], found);
  };
  // The nearest first: few of the others can be nearer.
  const int nearest = body.nearest[point.number];
  project_candidate(nearest);
  for (int at = body.begin; at < body.end; ++at)
    if (at != nearest) project_candidate(at);
  if (found.count == 0) return false;
  const std::span<const PatchProjection<Dim>> patches(found.patch.data(),
                                                      static_cast<std::size_t>(found.count));
  const Penetration<Dim> penetration = find_penetration(patches, pairs_.cell);
  if (penetration.status != PointStatus::inside) return penetration.status == PointStatus::outside;
  const double stiffness = spring_stiffness(point, penetration);
  if (stiffness > 0) append_contacts(point, patches, penetration, stiffness, out);
  return false;
}

/// Enters the projection on a facet if it is the closest on its patch.
template <int Dim>
[[gnu::always_inline]] inline void Classifier<Dim>::project(const Point& point, int f, double squared,
                                                            Projections& found) const {
  const auto& facet = geometry_.facet(f);
  int index = 0;
  while (index < found.count && item(found.patch, index).patch < facet.patch) ++index;
  const bool known = index < found.count && item(found.patch, index).patch == facet.patch;
  const double reach = known ? item(found.patch, index).closest.distance : pairs_.cell;
  const double most = item(bounds_, f).radius + reach;
  if (squared > most * most) return;
  const auto closest = project_onto(point.x, f, reach);
  if (!closest) return;
  const PatchProjection<Dim> projection{facet.body, facet.patch, f, *closest};
  if (known) {
    if (projection.precedes(item(found.patch, index))) item(found.patch, index) = projection;
  } else if (found.count < kMaxPatches) {
    for (int m = found.count++; m > index; --m) item(found.patch, m) = item(found.patch, m - 1);
    item(found.patch, index) = projection;
  }
}

template <int Dim>
[[gnu::always_inline]] inline std::optional<ClosestPoint<Dim>> Classifier<Dim>::project_onto(
    const Vec<Dim>& x, int f, double reach) const {
  const auto& facet = geometry_.facet(f);
  std::array<Vec<Dim>, Dim> corner, normal;
  std::array<bool, Dim> patch_ends;
  for (std::size_t k = 0; k < Dim; ++k) {
    corner[k] = geometry_.position(facet.point[k]);
    normal[k] = item(vertex_normals_, facet.normal_cone[k]);
    patch_ends[k] = facet.joint[k] != Joint::smooth;
  }
  auto closest = project_onto_facet(x, corner, normal, patch_ends, reach);
  if (closest && closest->at_crease) closest->convex = facet.joint[crease_of(*closest)] == Joint::convex;
  return closest;
}

/// Stiffness of a point's normal spring, N/m; 0 where none acts. Both bodies' facets are asked, so that each
/// side has half of it. The area is the undeformed one, so that the springs conserve energy. It counts as far
/// as the facet's normal is opposed to the exit direction: a facet round an edge does not press.
template <int Dim>
double Classifier<Dim>::spring_stiffness(const Point& point, const Penetration<Dim>& penetration) const {
  const auto& own = geometry_.facet(point.facet);
  const int other_body = penetration.nearest->body;
  if (std::holds_alternative<Ignore>(pairs_.law(own.body, other_body))) return 0;
  const double facing = std::max(0.0, -item(bounds_, point.facet).normal.dot(penetration.exit_direction));
  return 0.5 * pairs_.stiffness(own.body, other_body) * facing * own.area / kPoints;
}

template <int Dim>
void Classifier<Dim>::append_contacts(const Point& point, std::span<const PatchProjection<Dim>> patches,
                                      const Penetration<Dim>& penetration, double stiffness,
                                      std::vector<PointContact<Dim>>& out) const {
  double energy = 0.5 * stiffness * penetration.depth * penetration.depth;
  for (std::size_t j = 0; j < patches.size(); ++j) {
    const double share = penetration.share[j];
    if (!(share > 0)) continue;
    const ClosestPoint<Dim>& closest = patches[j].closest;
    PointContact<Dim> contact{point.facet,
                              point.number,
                              patches[j].facet,
                              stiffness,
                              share * penetration.depth,
                              energy,
                              closest.exit_direction,
                              {},
                              {}};
    const auto& corner = geometry_.facet(patches[j].facet).point;
    contact.to_surface = -point.x;
    for (std::size_t k = 0; k < Dim; ++k) {
      contact.weight[k] = closest.weight[k];
      contact.to_surface += contact.weight[k] * geometry_.position(corner[k]);
    }
    out.push_back(contact);
    energy = 0;
  }
}

}  // namespace

template <int Dim>
void classify(const SurfaceGeometry<Dim>& geometry, const std::vector<FacetBounds<Dim>>& bounds,
              const std::vector<Vec<Dim>>& vertex_normals, const BodyPairs& pairs, int threads,
              CandidateLists<Dim>& lists, std::vector<ClassifyWorkspace<Dim>>& workspaces,
              std::vector<ThreadContacts<Dim>>& out) {
  const Classifier<Dim> classifier(geometry, bounds, vertex_normals, pairs, lists);
  for (auto& of_thread : out) of_thread.contacts.clear();
  // Threads take stretches in order of the facets, so that the contacts of all threads are in order.
  for_each_of(static_cast<std::int64_t>(lists.of_facet.size()), threads, kSerialFacets, [&](std::int64_t k) {
    FacetCandidates& list = item(lists.of_facet, k);
    if (2 * lists.displacement < list.clearance) return;  // both sides may have moved by the displacement
    const int thread = thread_index();
    const bool outside =
        classifier.classify_facet(list, item(workspaces, thread), item(out, thread).contacts);
    if (outside && lists.displacement == 0) list.clearance = classifier.clearance(list);
  });
}

template <int Dim>
double add_normal_energy(double sum, const std::vector<ThreadContacts<Dim>>& found) {
  for (const auto& of_thread : found)
    for (const auto& contact : of_thread.contacts) sum += contact.energy;
  return sum;
}

template void classify<2>(const SurfaceGeometry<2>&, const std::vector<FacetBounds<2>>&,
                          const std::vector<Vec<2>>&, const BodyPairs&, int, CandidateLists<2>&,
                          std::vector<ClassifyWorkspace<2>>&, std::vector<ThreadContacts<2>>&);
template void classify<3>(const SurfaceGeometry<3>&, const std::vector<FacetBounds<3>>&,
                          const std::vector<Vec<3>>&, const BodyPairs&, int, CandidateLists<3>&,
                          std::vector<ClassifyWorkspace<3>>&, std::vector<ThreadContacts<3>>&);
template double add_normal_energy<2>(double, const std::vector<ThreadContacts<2>>&);
template double add_normal_energy<3>(double, const std::vector<ThreadContacts<3>>&);

}  // namespace mpmfast::penalty
