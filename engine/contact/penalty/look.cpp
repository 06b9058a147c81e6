/// Which boundary points lie below which facets.

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "engine/contact/penalty/penalty.hpp"
#include "engine/state/team.hpp"
#include "kernels/contact/facet_feet.hpp"

namespace mpmfast {

namespace {

/// A smooth corner whose facets' unit normals add up to less is folded.
constexpr double kFolded = 0.1;

}  // namespace

/// The foot of a point on the nearest facet of a piece.
template <int Dim>
struct Penalty<Dim>::Candidate {
  int body, piece, facet;
  Foot<Dim> foot;

  /// Of two as near, as on a corner of both, the first of the surface: whatever is asked first.
  bool before(const Candidate& other) const {
    return foot.distance < other.foot.distance ||
           (foot.distance == other.foot.distance && facet < other.facet);
  }
};

template <int Dim>
std::optional<Fold> Penalty<Dim>::look(const State<Dim>& state) {
  gather(state);
  const bool more = stale_ && find_near(state);
  find_balls(state.threads);
  double moved = more ? kInfinity : moved_since_listed();
  const bool fresh = !(moved <= 0.5 * kSkin * cell_);
  if (fresh) {
    list_all(state.threads);
    moved = 0;
  }
  stale_ = false;
  const int fold = find_normals(state.threads);
  if (fold >= 0) {
    const int body = surfaces_->point_body[static_cast<std::size_t>(fold)];
    const auto& own = surfaces_->bodies[static_cast<std::size_t>(body)];
    return Fold{body, own.first_id + static_cast<std::uint32_t>(fold - own.first)};
  }
  for (auto& room : rooms_) room.touches.clear();
  const auto n = static_cast<std::int64_t>(listing_.size());
  // Even stretches in order of the threads: the touches of all rooms are in order of the facets.
  for_each_of(n, state.threads, 256, [&](std::int64_t k) {
    Listing& listing = listing_[static_cast<std::size_t>(k)];
    if (2 * moved < listing.clear) return;  // both sides may have gone as far
    const bool outside = look_around(listing, rooms_[static_cast<std::size_t>(own_number())]);
    if (fresh && outside) listing.clear = clearance(listing);
  });
  return std::nullopt;
}

template <int Dim>
void Penalty<Dim>::gather(const State<Dim>& state) {
  const auto& particles = state.particles;
  const double* x[Dim];
  for (int d = 0; d < Dim; ++d) x[d] = particles.column(Quantity::position, d);
  const auto runs = static_cast<std::int64_t>(state.tiling.runs.size());
  for_each_of(runs, state.threads, 1, [&](std::int64_t r) {
    const auto& run = state.tiling.runs[static_cast<std::size_t>(r)];
    if (!run.on_surface) return;
    for (std::uint32_t p = run.begin; p < run.end; ++p) {
      Vec<Dim>& out = now_[static_cast<std::size_t>(surfaces_->number(run.body, particles.id()[p]))];
      for (int d = 0; d < Dim; ++d) out[d] = x[d][p];
    }
  });
}

/// Unit, out of the body.
template <int Dim>
Vec<Dim> Penalty<Dim>::facet_normal(int f) const {
  const auto& facet = surfaces_->facets[static_cast<std::size_t>(f)];
  const Vec<Dim> edge = at(facet.point[1]) - at(facet.point[0]);
  if constexpr (Dim == 2)
    return Vec<2>(edge[1], -edge[0]).normalized();
  else
    return edge.cross(at(facet.point[2]) - at(facet.point[0])).normalized();
}

/// @return  a point where the surface folds; −1: none
template <int Dim>
int Penalty<Dim>::find_normals(int threads) {
  for (auto& room : rooms_) room.fold = -1;
  const auto n = static_cast<std::int64_t>(listed_wedges_.size());
  for_each_of(n, threads, 256, [&](std::int64_t k) {
    const auto w = static_cast<std::size_t>(listed_wedges_[static_cast<std::size_t>(k)]);
    const auto& wedge = surfaces_->wedges[w];
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int k = wedge.begin; k < wedge.end; ++k) {
      const int f = surfaces_->wedge_facets[static_cast<std::size_t>(k)];
      sum += ball(f).body >= 0 ? ball(f).normal : facet_normal(f);
    }
    const double length = sum.norm();
    if (!(length > kFolded)) {
      int& fold = rooms_[static_cast<std::size_t>(own_number())].fold;
      if (fold < 0) fold = wedge.point;
    }
    wedge_normal_[w] = sum / length;
  });
  for (const auto& room : rooms_)
    if (room.fold >= 0) return room.fold;
  return -1;
}

template <int Dim>
[[gnu::always_inline]] inline std::optional<Foot<Dim>> Penalty<Dim>::foot_of(
    const Vec<Dim>& x, const typename Surfaces<Dim>::Facet& facet, double reach) const {
  std::array<Vec<Dim>, Dim> corner, normal;
  std::array<bool, Dim> ends;
  for (std::size_t k = 0; k < Dim; ++k) {
    corner[k] = at(facet.point[k]);
    normal[k] = wedge_normal_[static_cast<std::size_t>(facet.wedge[k])];
    ends[k] = facet.joint[k] != Joint::smooth;
  }
  auto foot = foot_on(x, corner, normal, ends, reach);
  if (foot && foot->clipped) {
    // 2-D: the end with all of the foot; 3-D: the edge opposite the corner with none.
    std::size_t at = 0;
    while (at + 1 < Dim && (Dim == 2 ? !(foot->share[at] > 0) : foot->share[at] != 0)) ++at;
    foot->convex = facet.joint[at] == Joint::convex;
  }
  return foot;
}

/// What the points of a facet touch, of the facets listed with it.
/// @return  are they outside of all of the bodies?
template <int Dim>
bool Penalty<Dim>::look_around(const Listing& listing, Room& room) const {
  const auto count = static_cast<std::size_t>(listing.end - listing.begin);
  Vec<Dim> x[kPoints];
  for (int k = 0; k < kPoints; ++k) x[k] = mean(listing.facet, k, now_);
  if (room.squared.size() < kPoints * count) room.squared.resize(kPoints * count);
  room.around.clear();
  double least[kPoints]{};
  for (std::size_t j = 0; j < count; ++j) {
    const int at = listing.begin + static_cast<int>(j);
    const Ball& other = ball(listed(at));
    if (room.around.empty() || room.around.back().body != other.body) {  // those of a body follow each other
      room.around.push_back({other.body, at, at, {}, 0});
      std::fill_n(room.around.back().nearest, kPoints, at);
      std::fill(least, least + kPoints, kInfinity);
    }
    Around& around = room.around.back();
    around.end = at + 1;
    around.widest = std::max(around.widest, other.radius);
    for (std::size_t k = 0; k < kPoints; ++k) {
      const double squared = (x[k] - other.middle).squaredNorm();
      room.squared[k * count + j] = squared;
      if (!(squared < least[k])) continue;
      least[k] = squared;
      around.nearest[k] = at;
    }
  }
  bool outside = true;
  for (std::size_t k = 0; k < kPoints; ++k)
    for (const Around& around : room.around) {
      // Most points lie well outside of whatever is near: over the facet whose middle is the nearest.
      const int nearest = around.nearest[k];
      const Ball& under = ball(listed(nearest));
      if (under.normal.dot(x[k] - under.middle) > 2 * around.widest) continue;
      const double* squared =
          room.squared.data() + k * count + static_cast<std::size_t>(around.begin - listing.begin);
      outside &= look_at_body(listing.facet, static_cast<int>(k), x[k],
                              {around.begin, around.end, nearest, squared}, room);
    }
  return outside;
}

/// The nearest foot on each piece of a body.
/// @return  is the point outside of it?
template <int Dim>
bool Penalty<Dim>::look_at_body(int own, int k_th, const Vec<Dim>& x, const Neighbours& neighbours,
                                Room& room) const {
  Candidate found[kNear];
  int count = 0;
  const auto try_foot = [&](int k) {
    const int f = listed(k), piece = facet(f).piece;
    int place = 0;
    while (place < count && found[place].piece < piece) ++place;
    const bool known = place < count && found[place].piece == piece;
    const double reach = known ? found[place].foot.distance : cell_, most = ball(f).radius + reach;
    if (neighbours.squared[k - neighbours.begin] > most * most) return;
    const std::optional<Foot<Dim>> foot = foot_of(x, facet(f), reach);
    if (!foot) return;
    const Candidate candidate{facet(f).body, piece, f, *foot};
    if (known) {
      if (candidate.before(found[place])) found[place] = candidate;
    } else if (count < kNear) {
      for (int m = count++; m > place; --m) found[m] = found[m - 1];
      found[place] = candidate;
    }
  };
  // The nearest first: few of the others can be nearer.
  try_foot(neighbours.nearest);
  for (int k = neighbours.begin; k < neighbours.end; ++k)
    if (k != neighbours.nearest) try_foot(k);
  return count > 0 && touch_body(own, k_th, x, found, found + count, room.touches);
}

/// Of a body that holds the point: how deep, and which of its pieces push. About an edge that sticks out the
/// depth is 1/d² = Σ 1/d_j² over the pieces j there, so that it is zero on both and their forces, −½ k
/// ∂d²/∂x, never jump; about one that is sunk in, and inside a piece, it is the least.
/// @return  is it outside?
template <int Dim>
bool Penalty<Dim>::touch_body(int own, int k_th, const Vec<Dim>& x, const Candidate* begin,
                              const Candidate* end, std::vector<Touch>& out) const {
  const Candidate* nearest = std::min_element(
      begin, end, [](const Candidate& a, const Candidate& b) { return a.foot.distance < b.foot.distance; });
  const Foot<Dim>& first = nearest->foot;
  if (!(first.distance > 0)) return false;
  if (first.clipped ? first.convex : !first.below) return true;
  const bool alone = end - begin == 1;
  const double reach = 1 / (cell_ * cell_);
  const auto weight = [&](const Candidate& c) {  // 1/d_j²
    const double d = c.foot.distance;
    if (&c == nearest) return 1 / (d * d);
    const bool counts = c.foot.clipped ? c.foot.convex : c.foot.below;
    return counts && d > 0 && !first.clipped ? std::max(0.0, 1 / (d * d) - reach) : 0.0;
  };
  double depth = first.distance;
  Vec<Dim> way = first.exit;
  const auto part = [&](const Candidate& c) {  // (d/d_j)³ of ∂d/∂x
    if (alone) return 1.0;
    const double ratio = depth / c.foot.distance;
    return weight(c) > 0 ? ratio * ratio * ratio : 0.0;
  };
  if (!alone) {
    double sum = 0;
    for (const Candidate* c = begin; c != end; ++c) sum += weight(*c);
    depth = 1 / std::sqrt(sum);
    way.setZero();
    for (const Candidate* c = begin; c != end; ++c) way += part(*c) * c->foot.exit;
    const double length = way.norm();
    if (!(length > 0)) return false;
    way /= length;
  }
  const int body = facet(own).body;
  if (std::holds_alternative<Ignore>(law_between(field_of(body), field_of(nearest->body)))) return false;
  // What lies round an edge does not press. The area is the undeformed one, so that springs keep energy.
  const double facing = std::max(0.0, -ball(own).normal.dot(way));
  const double stiffness = 0.5 * stiffness_between(body, nearest->body) * facing * facet(own).area / kPoints;
  if (!(stiffness > 0)) return false;
  double energy = 0.5 * stiffness * depth * depth;
  for (const Candidate* c = begin; c != end; ++c) {
    const double share = part(*c);
    if (!(share > 0)) continue;
    Touch touch{own, k_th, c->facet, stiffness, share * depth, energy, c->foot.exit, {}, {}};
    const auto& other = facet(c->facet);
    touch.to_foot = -x;
    for (int k = 0; k < Dim; ++k) {
      touch.share[k] = c->foot.share[k];
      touch.to_foot += touch.share[k] * at(other.point[static_cast<std::size_t>(k)]);
    }
    out.push_back(touch);
    energy = 0;
  }
  return false;
}

// Here: the members that this file defines.
template std::optional<Fold> Penalty<2>::look(const State<2>&);
template void Penalty<2>::gather(const State<2>&);
template Vec<2> Penalty<2>::facet_normal(int) const;
template int Penalty<2>::find_normals(int);
template std::optional<Foot<2>> Penalty<2>::foot_of(const Vec<2>&, const Surfaces<2>::Facet&, double) const;
template bool Penalty<2>::look_around(const Listing&, Room&) const;
template bool Penalty<2>::look_at_body(int, int, const Vec<2>&, const Neighbours&, Room&) const;
template bool Penalty<2>::touch_body(int, int, const Vec<2>&, const Candidate*, const Candidate*,
                                     std::vector<Touch>&) const;
template std::optional<Fold> Penalty<3>::look(const State<3>&);
template void Penalty<3>::gather(const State<3>&);
template Vec<3> Penalty<3>::facet_normal(int) const;
template int Penalty<3>::find_normals(int);
template std::optional<Foot<3>> Penalty<3>::foot_of(const Vec<3>&, const Surfaces<3>::Facet&, double) const;
template bool Penalty<3>::look_around(const Listing&, Room&) const;
template bool Penalty<3>::look_at_body(int, int, const Vec<3>&, const Neighbours&, Room&) const;
template bool Penalty<3>::touch_body(int, int, const Vec<3>&, const Candidate*, const Candidate*,
                                     std::vector<Touch>&) const;

}  // namespace mpmfast
