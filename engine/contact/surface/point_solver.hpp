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

template <int Dim>
void add_to_velocities(SurfaceList<Dim>& points, int p, const Vec<Dim>& impulse) {
  points.for_each_node(p, [&](SurfaceNode<Dim>& node, double share) {
    node.velocity += share * node.inverse_mass.cwiseProduct(impulse);
  });
}

/// Squared impulses of one thread's points in a sweep, N² s².
struct alignas(64) SweepTally {
  double change = 0, largest = 0;
};

/// Gives a point the impulse of its law while the others stay.
template <int Dim, class Law>
void respond(const PointPass& pass, const Law& law, int p, SurfaceList<Dim>& points, SweepTally& tally) {
  constexpr bool kActs = Law::scope == LawScope::contact;
  PairStatus& status = points.status[p];
  PointSolve<Dim>& solve = points.solve[p];
  PairImpulses<Dim>& impulse = points.impulse[p];
  if (!kActs || !(solve.reduced_mass > 0)) return;
  // Every point is a candidate: its approach velocity decides, since other points change it.
  constexpr double kCloses = -1;
  PairRule<Dim> rule = pair_rule<Dim>(pass.rule, status, points.before[p], kCloses);
  solve.trial = impulse.now + solve.reduced_mass * points.relative_velocity(p);
  const auto all_of_it = [](double normal_impulse) { return normal_impulse; };
  const Response<Dim> response = rule.set.response(points.geometry[p].normal, status.target_approach,
                                                   solve.trial, solve.reduced_mass, law, 0, all_of_it);
  status.now = response.status;
  const Vec<Dim> change = response.impulse - impulse.now;
  if (!change.isZero(0)) add_to_velocities(points, p, change);
  impulse.now = response.impulse;
  tally.change = std::max(tally.change, change.squaredNorm());
  tally.largest = std::max(tally.largest, impulse.now.squaredNorm());
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
      each_point([&](int p) {
        points.impulse[p].now.setZero();
        points.status[p].now = ContactStatus::open;
      });
      detail::SweepTally& mine = tallies[static_cast<std::size_t>(me.thread)];
      for (int done = 0; done < kPointSweeps; ++done) {
        mine = {};
        each_point([&](int p) {
          laws.with(points.geometry[p].law,
                    [&](const auto& law) { detail::respond(pass, law, p, points, mine); });
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
        sums_of(p);
        const PairImpulses<Dim>& impulse = points.impulse[p];
        points.for_each_node(p, [&](SurfaceNode<Dim>& node, double share) {
          for (int d = 0; d < Dim; ++d) {
            if (!(node.inverse_mass[d] > 0)) continue;
            node.impulse[d] += share * impulse.now[d];
            node.as_force[d] += share * impulse.as_force[d];
          }
        });
      });
    });
  });
  return sweeps;
}

}  // namespace mpmfast
