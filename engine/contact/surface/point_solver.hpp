#pragma once

/// @file Impulses at points such that each obeys its law with the velocities that all of them leave.

#include <vector>

#include "engine/contact/active_set/active_set.hpp"
#include "engine/contact/pairs/pair_laws.hpp"
#include "engine/contact/surface/surface_list.hpp"

namespace mpmfast {

/// What the points of a correction have in common.
struct PointPass {
  const PairLaws& laws;
  CorrectionRule rule;
  int threads;
};

/// Finds the impulses of all points (PairImpulses::now) and adds them to the nodes: velocities, and the sums
/// of impulses and of PairImpulses::as_force.
///
/// Projected Gauss–Seidel over the points, from no impulses. (Those of the last step would make energy: there
/// are more points than motions of the surface, and a few sweeps do not end what the surplus stores.) Blocks
/// of one colour are solved at the same time, and the colours follow each other: the order of the points does
/// not depend on the threads.
/// @pre PairStatus of all points, and the velocities of the nodes without impulses
/// @param sums_of  sums_of(p): called once after the last sweep, before the sums are taken
/// @return sweeps
template <int Dim, class SumsOf>
int solve_points(const PointPass& pass, SurfaceList<Dim>& points, const SumsOf& sums_of);

namespace detail {

/// Calls f(p) for all points, block after block of each colour; threads wait for each other between colours.
template <int Dim, class F>
void for_each_point_by_colour(const TeamThread& me, const SurfaceList<Dim>& points, const F& f) {
  for (const auto& blocks : points.blocks) {
    const std::size_t n = blocks.size(), threads = static_cast<std::size_t>(me.threads),
                      thread = static_cast<std::size_t>(me.thread);
    for (std::size_t b = n * thread / threads; b < n * (thread + 1) / threads; ++b)
      for (int p = blocks[b][0]; p < blocks[b][1]; ++p) f(p);
    me.wait_for_all();
  }
}

/// Squared impulses of one thread's points in a sweep, N² s².
struct alignas(64) SweepTally {
  double change = 0, largest = 0;
};

/// Gives a point the impulse of its law while the others stay.
template <int Dim, class Law>
void respond(const Law& law, int p, SurfaceList<Dim>& points, SweepTally& tally) {
  PointSolve<Dim>& point = points.solve[p];
  point.trial = point.impulse + point.reduced_mass * points.relative_velocity(p);
  const auto all_of_it = [](double normal_impulse) { return normal_impulse; };
  const Response<Dim> response = point.rule.response(point.normal, point.target_approach, point.trial,
                                                     point.reduced_mass, law, 0, all_of_it);
  point.status = response.status;
  const Vec<Dim> change = response.impulse - point.impulse;
  point.impulse = response.impulse;
  tally.largest = std::max(tally.largest, point.impulse.squaredNorm());
  if (change.isZero(0)) return;
  tally.change = std::max(tally.change, change.squaredNorm());
  points.for_each_node(p, [&](int k, double share) {
    NodeResponse<Dim>& node = points.responses[k];
    node.velocity += share * node.inverse_mass.cwiseProduct(change);
  });
}

/// Prepares a point for the sweeps of a correction, without an impulse.
template <int Dim>
void prepare(const CorrectionRule& rule, int p, SurfaceList<Dim>& points) {
  // Every point is a candidate: its approach velocity decides, since other points change it.
  constexpr double kCloses = -1;
  PointSolve<Dim>& point = points.solve[p];
  point.rule = pair_rule<Dim>(rule, points.status[p], points.before[p], kCloses).set;
  point.rule.acts &= point.reduced_mass > 0;
  point.target_approach = points.status[p].target_approach;
  point.impulse.setZero();
  point.status = ContactStatus::open;
}

/// Adds the impulses of a point to the sums of its nodes.
template <int Dim>
void add_to_sums(int p, SurfaceList<Dim>& points) {
  const PairImpulses<Dim>& impulse = points.impulse[p];
  points.for_each_node(p, [&](int k, double share) {
    SurfaceNode<Dim>& node = points.nodes[k];
    for (int d = 0; d < Dim; ++d) {
      if (!(points.responses[k].inverse_mass[d] > 0)) continue;
      node.impulse[d] += share * impulse.now[d];
      node.as_force[d] += share * impulse.as_force[d];
    }
  });
}

}  // namespace detail

template <int Dim, class SumsOf>
int solve_points(const PointPass& pass, SurfaceList<Dim>& points, const SumsOf& sums_of) {
  using constants::contact::kPointSweeps, constants::contact::kPointTolerance, constants::threads::kFewSolved;
  const int asked = static_cast<std::int64_t>(points.size()) <= kFewSolved ? 1 : pass.threads;
  std::vector<detail::SweepTally> tallies(static_cast<std::size_t>(asked));
  int sweeps = 0;
  pass.laws.dispatch([&](const auto& laws) {
    on_threads(asked, [&](const TeamThread& me) {
      const auto each_point = [&](const auto& f) { detail::for_each_point_by_colour(me, points, f); };
      each_point([&](int p) { detail::prepare(pass.rule, p, points); });
      detail::SweepTally& mine = tallies[static_cast<std::size_t>(me.thread)];
      for (int done = 0; done < kPointSweeps; ++done) {
        mine = {};
        each_point([&](int p) {
          if (!points.solve[p].rule.acts) return;
          laws.with(points.solve[p].law, [&]<class Law>(const Law& law) {
            if constexpr (Law::scope == LawScope::contact) detail::respond(law, p, points, mine);
          });
        });
        double change = 0, largest = 0;
        for (int t = 0; t < me.threads; ++t) {
          change = std::max(change, tallies[static_cast<std::size_t>(t)].change);
          largest = std::max(largest, tallies[static_cast<std::size_t>(t)].largest);
        }
        if (me.thread == 0) sweeps = done + 1;
        me.wait_for_all();  // before the tallies change
        if (change <= kPointTolerance * kPointTolerance * largest) break;
      }
      each_point([&](int p) {
        points.impulse[p].now = points.solve[p].impulse;
        points.status[p].now = points.solve[p].status;
        sums_of(p);
        detail::add_to_sums(p, points);
      });
    });
  });
  return sweeps;
}

}  // namespace mpmfast
