#pragma once

/// @file Two contacts on one node at once (N20 §3.4): a field between two others, or two separate pairs.

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/friction_cone.hpp"
#include "kernels/contact/resolve_pair.hpp"

namespace mpmfast {

/// One of the two contacts, between the node's fields a and b.
template <int Dim>
struct PairContact {
  Vec<Dim> normal;                      ///< unit, from a to b
  Vec<Dim> jump;                        ///< v_b − v_a before, m/s
  double inverse_mass;                  ///< 1/m_a + 1/m_b, 1/kg
  double area_time{};                   ///< A_c Δt, m² s
  Vec<Dim> impulse = Vec<Dim>::Zero();  ///< found: Δp_a, N s; b takes −Δp_a
  Vec<Dim> slip = Vec<Dim>::Zero();     ///< found: v_b − v_a after, m/s
};

namespace detail {

enum class Surfaces { open, stuck, sliding };

template <int Dim>
struct Status {
  Surfaces surfaces = Surfaces::stuck;
  Vec<Dim> slope = Vec<Dim>::Zero();  ///< tangential impulse for each unit of N while sliding
};

/// The impulses J for given statuses. v_b − v_a after is w_k − W_k J_k − c J_other, with c = ±1/m of a field
/// that both pairs share. Stuck: that is zero. Sliding: its normal part is zero, and the tangential part of J
/// is slope × N, N = −J·n. Open: J = 0.
template <int Dim>
void solve_statuses(PairContact<Dim> (&pair)[2], const Status<Dim> (&status)[2], double coupling) {
  Eigen::Matrix<double, 2 * Dim, 2 * Dim> matrix = Eigen::Matrix<double, 2 * Dim, 2 * Dim>::Zero();
  Eigen::Matrix<double, 2 * Dim, 1> right = Eigen::Matrix<double, 2 * Dim, 1>::Zero();
  const Mat<Dim> one = Mat<Dim>::Identity();
  for (int k = 0; k < 2; ++k) {
    const PairContact<Dim>& p = pair[k];
    auto own = matrix.template block<Dim, Dim>(k * Dim, k * Dim);
    auto other = matrix.template block<Dim, Dim>(k * Dim, (1 - k) * Dim);
    auto value = right.template segment<Dim>(k * Dim);
    const Mat<Dim> along = p.normal * p.normal.transpose();
    if (status[k].surfaces == Surfaces::open) {
      own = p.inverse_mass * one;
    } else if (status[k].surfaces == Surfaces::stuck) {
      own = p.inverse_mass * one;
      other = coupling * one;
      value = p.jump;
    } else {
      own = p.inverse_mass * (one + status[k].slope * p.normal.transpose());
      other = coupling * along;
      value = along * p.jump;
    }
  }
  const Eigen::Matrix<double, 2 * Dim, 1> solution = matrix.partialPivLu().solve(right);
  for (int k = 0; k < 2; ++k) pair[k].impulse = solution.template segment<Dim>(k * Dim);
  for (int k = 0; k < 2; ++k)
    pair[k].slip = pair[k].jump - pair[k].inverse_mass * pair[k].impulse - coupling * pair[1 - k].impulse;
}

/// The law of one of the two: in compression what AnyLaw says, or tied in any case.
struct PairLaw {
  const AnyLaw& law;
  bool tied() const {
    return std::visit([](const auto& l) { return l.scope == LawScope::everywhere; }, law);
  }
  double operator()(const Sliding& s) const {
    return std::visit([&](const auto& l) { return l(s); }, law);
  }
};

/// The status of one pair by its law while the other pair stays. The trial impulse is Δp(0) = J + m_red w.
template <int Dim>
Status<Dim> status_by_law(const PairContact<Dim>& p, const Status<Dim>& now, const PairLaw& law,
                          double noise) {
  Status<Dim> next;
  if (law.tied()) return next;
  const double reduced_mass = 1 / p.inverse_mass;
  const Vec<Dim> trial = p.impulse + reduced_mass * p.slip;
  const auto [normal_impulse, tangential] = split(trial, p.normal);
  if (normal_impulse > (now.surfaces == Surfaces::open ? -noise : noise)) {
    next.surfaces = Surfaces::open;
    return next;
  }
  const double needed = tangential.norm(), limit = law({-normal_impulse, needed, reduced_mass, p.area_time});
  if (!(needed > limit)) return next;
  next.surfaces = Surfaces::sliding;
  next.slope = limit / (needed * std::max(-normal_impulse, noise)) * tangential;
  return next;
}

}  // namespace detail

/// Finds impulses that satisfy both laws together: no approach, no attraction, each shear as its law says.
/// The laws act in compression or tie everywhere; the impulses conserve momentum in any case.
/// @param coupling  of the field that both share: 1/m where it has the same side in both, −1/m where not, 0:
///                  the pairs share none
/// @return false when the statuses do not settle (the caller lumps then)
template <int Dim>
bool solve_two_pairs(PairContact<Dim> (&pair)[2], double coupling, const AnyLaw& law_one,
                     const AnyLaw& law_two) {
  using namespace detail;
  Status<Dim> status[2];
  for (int k = 0; k < constants::kTwoPairRounds; ++k) {
    solve_statuses(pair, status, coupling);
    double scale = 0;  // a light field between heavy ones passes on far more than it can take
    for (const auto& p : pair) scale = std::max({scale, p.jump.norm() / p.inverse_mass, p.impulse.norm()});
    const double noise = constants::kTwoPairRoundOff * scale;
    const Status<Dim> next[2] = {status_by_law(pair[0], status[0], {law_one}, noise),
                                 status_by_law(pair[1], status[1], {law_two}, noise)};
    bool changed[2], same = true;
    for (int i = 0; i < 2; ++i) {
      changed[i] = next[i].surfaces != status[i].surfaces;
      const double shift = (next[i].slope - status[i].slope).norm() * -pair[i].impulse.dot(pair[i].normal);
      same &= !changed[i] && !(std::abs(shift) > constants::kTwoPairTolerance * scale);
    }
    if (same) return pair[0].impulse.allFinite() && pair[1].impulse.allFinite();
    // Of two changes of kind, one at a time and in turn: both at once can chase each other.
    for (int i = 0; i < 2; ++i)
      if (!(changed[0] && changed[1]) || i == k % 2) status[i] = next[i];
  }
  return false;
}

}  // namespace mpmfast
