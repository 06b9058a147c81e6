#pragma once

/// @file All contacts of a node where three or more fields meet, solved together: impulses such that each
/// contact obeys its law with the velocities that all impulses leave.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/constants.hpp"
#include "kernels/contact/contact_status.hpp"
#include "kernels/contact/delassus_operator.hpp"
#include "kernels/contact/friction_cone.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// A velocity field of the node; a rigid one has no inverse mass.
template <int Dim>
struct MovingField {
  Vec<Dim> velocity;    ///< m/s, with the impulses so far
  double inverse_mass;  ///< 1/kg
};

/// The impulse and status of one contact by its law while the others stay.
template <int Dim>
struct Response {
  Vec<Dim> impulse;  ///< Δp_a, N s
  ContactStatus status;
};

/// The response of a law that returns an impulse alone: one that is neither zero nor the trial impulse slips.
/// @param trial  Δp_a that sticking would need, N s
template <int Dim>
inline Response<Dim> response_of(const Vec<Dim>& impulse, const Vec<Dim>& trial) {
  return {impulse, impulse.isZero(0)  ? ContactStatus::open
                   : impulse == trial ? ContactStatus::stick
                                      : ContactStatus::slip};
}

/// A contact between the node's fields a and b.
template <int Dim>
struct FieldContact {
  int a, b;
  Vec<Dim> normal;           ///< unit, from a to b
  double reduced_mass;       ///< m_red = 1/(1/m_a + 1/m_b), kg
  double target_approach{};  ///< approach velocity that closes the gap by the end of the step, m/s
  bool bilateral = false;    ///< it pulls as well as it presses
  ContactStatus status = ContactStatus::open;  ///< result
  Vec<Dim> impulse = Vec<Dim>::Zero();         ///< result: Δp_a, N s; b takes −Δp_a
  Vec<Dim> friction = Vec<Dim>::Zero();        ///< prescribed tangential part while friction lags, N s
};

/// The contacts of one node, with the memory to solve them.
///
/// Gauss–Seidel gives each contact in turn the impulse of its law while the others stay. A few sweeps find
/// the statuses; then convergence is slow, the more so the lighter a field between heavy ones. So a Newton
/// step on the active set follows each sweep: the impulses that end all constrained relative motion if no
/// status changes. For Coulomb's law in 2-D, where no slip turns, that is the solution. Each impulse has its
/// reaction, so every iterate conserves momentum.
template <int Dim>
class NodeSolver {
 public:
  std::vector<MovingField<Dim>> fields;
  std::vector<FieldContact<Dim>> contacts;

  /// Finds the impulses, starting from the present ones. If they do not converge, friction is prescribed and
  /// the normal impulses are solved for it, by turns; friction that would do positive work is removed.
  /// Converged or not, impulses do no positive work.
  /// @param law  law(k, trial): the Response of contact k to the impulse that sticking would need
  /// @return whether they converged (constants::kSweepTolerance) and obey their laws
  template <class Law>
  bool solve(const Law& law) {
    find_scales();
    for (int done = 0; done < constants::kMostSweeps; ++done) {
      const bool converged = sweep(law);
      if (contacts.size() == 1) return true;
      if (!is_bounded()) break;
      if (converged) return true;
      if (done < constants::kEarlyNewtonSteps || done % constants::kEarlyNewtonSteps == 0) newton_step(law);
    }
    return solve_with_lagged_friction(law);
  }

 private:
  MovingField<Dim>& field(int k) { return fields[static_cast<std::size_t>(k)]; }
  /// v_b − v_a, m/s.
  Vec<Dim> relative_velocity(const FieldContact<Dim>& c) { return field(c.b).velocity - field(c.a).velocity; }

  void add(FieldContact<Dim>& c, const Vec<Dim>& impulse) {
    field(c.a).velocity += field(c.a).inverse_mass * impulse;
    field(c.b).velocity -= field(c.b).inverse_mass * impulse;
  }

  /// By turns, friction is set from the last normal impulses and the normal impulses are solved for it. Both
  /// begin at zero. Fields that jam may have no impulses that obey both laws; normal impulses for given
  /// friction always exist, and do no work.
  /// @return whether the friction converged too
  template <class Law>
  bool solve_with_lagged_friction(const Law& law) {
    lags_ = true;
    bool converged = false;
    double last = std::numeric_limits<double>::infinity();
    bool normal_converged = restart(law);
    for (int round = 0; round < constants::kFrictionRounds && !converged; ++round) {
      double largest = 0, change = 0;
      changes_.resize(contacts.size());
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        FieldContact<Dim>& c = contacts[k];
        const Vec<Dim> impulse = law(k, c.impulse + c.reduced_mass * relative_velocity(c)).impulse;
        changes_[k] = split(impulse, c.normal).tangential - c.friction;
        largest = std::max(largest, impulse.squaredNorm());
        change = std::max(change, changes_[k].squaredNorm());
      }
      converged = normal_converged && is_converged(change, largest);
      if (!(change < last)) break;
      for (std::size_t k = 0; k < contacts.size(); ++k) contacts[k].friction += 0.5 * changes_[k];
      last = change;
      normal_converged = solve_normal_impulses(law);
    }
    for (int round = 0; round < constants::kFrictionRounds && !converged && cut_friction(law); ++round)
      solve_normal_impulses(law);
    converged &= is_bounded();
    if (!is_bounded()) restart(law);
    lags_ = false;
    if (!converged) remove_work();
    return converged;
  }

  bool is_bounded() const {
    constexpr double kMost = constants::kMostImpulse * constants::kMostImpulse;
    return largest_ <= kMost * momentum_ * momentum_;
  }

  /// Normal impulses without friction, from zero.
  template <class Law>
  bool restart(const Law& law) {
    for (std::size_t k = 0; k < fields.size(); ++k) fields[k].velocity = start_[k];
    for (FieldContact<Dim>& c : contacts) {
      c.impulse.setZero();
      c.friction.setZero();
    }
    return solve_normal_impulses(law);
  }

  /// Normal impulses for given friction. @return whether they converged
  template <class Law>
  bool solve_normal_impulses(const Law& law) {
    for (int done = 0; done < constants::kMostSweeps; ++done) {
      if (sweep(law)) return true;
      newton_step(law);
    }
    return false;
  }

  /// Removes friction that drives its surfaces, and cuts friction beyond its law. @return whether any was cut
  template <class Law>
  bool cut_friction(const Law& law) {
    bool cut = false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      const Vec<Dim> impulse = law(k, c.impulse + c.reduced_mass * relative_velocity(c)).impulse;
      const double allowed = split(impulse, c.normal).tangential.norm(), now = c.friction.norm();
      const double share = c.friction.dot(relative_velocity(c)) < 0    ? 0
                           : now > constants::kSpareFriction * allowed ? allowed / now
                                                                       : 1;
      c.friction *= share;
      cut |= share < 1;
    }
    return cut;
  }

  bool is_converged(double change, double largest) const {
    constexpr double kSquared = constants::kSweepTolerance * constants::kSweepTolerance;
    return change <= std::max(kSquared * largest, noise_ * noise_);
  }

  /// The impulse that round-off of the velocities makes, and the momentum against the heaviest field.
  void find_scales() {
    double fastest = 0, heaviest = 0;
    const MovingField<Dim>* ground = fields.data();
    for (const MovingField<Dim>& f : fields) {
      fastest = std::max(fastest, f.velocity.squaredNorm());
      if (f.inverse_mass < ground->inverse_mass) ground = &f;
    }
    for (const FieldContact<Dim>& c : contacts) heaviest = std::max(heaviest, c.reduced_mass);
    noise_ = constants::kVelocityRoundOff * heaviest * std::sqrt(fastest);
    momentum_ = 0;
    start_.clear();
    for (const MovingField<Dim>& f : fields) start_.push_back(f.velocity);
    for (const MovingField<Dim>& f : fields)
      if (f.inverse_mass > 0) momentum_ += (f.velocity - ground->velocity).norm() / f.inverse_mass;
  }

  /// One Gauss–Seidel sweep. @return whether the impulses have converged
  template <class Law>
  bool sweep(const Law& law) {
    double change = 0;
    largest_ = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      const Vec<Dim> trial = c.impulse + c.reduced_mass * relative_velocity(c);
      const Response<Dim> response = lags_ ? normal_response(law, k, trial) : law(k, trial);
      const Vec<Dim> step = response.impulse - c.impulse;
      add(c, step);
      c.impulse = response.impulse;
      c.status = response.status;
      largest_ = std::max(largest_, c.impulse.squaredNorm());
      change = std::max(change, step.squaredNorm());
    }
    return is_converged(change, largest_);
  }

  /// Scales the impulses so that contact only dissipates, Σ J·w ≥ 0 with the relative velocities w that it
  /// leaves. Impulses that have not converged may drive fields apart that jam in a ring. The work is
  /// s J·w_0 − ½ s² Σ |Δp|²/m with a factor s and w_0 before any impulse; s maximises it.
  void remove_work() {
    double dissipated = 0, squares = 0;  // Σ J·w; Σ |Δp|²/m; their sum is Σ J·w_0
    for (const FieldContact<Dim>& c : contacts) dissipated += c.impulse.dot(relative_velocity(c));
    if (dissipated >= 0) return;
    changes_.assign(fields.size(), Vec<Dim>::Zero());
    for (const FieldContact<Dim>& c : contacts) {
      changes_[static_cast<std::size_t>(c.a)] += c.impulse;
      changes_[static_cast<std::size_t>(c.b)] -= c.impulse;
    }
    for (std::size_t k = 0; k < fields.size(); ++k)
      squares += fields[k].inverse_mass * changes_[k].squaredNorm();
    const double share = std::clamp((dissipated + squares) / squares, 0.0, 1.0);
    for (FieldContact<Dim>& c : contacts) {
      add(c, (share - 1) * c.impulse);
      c.impulse *= share;
    }
  }

  /// The response of a contact whose friction is prescribed.
  template <class Law>
  Response<Dim> normal_response(const Law& law, std::size_t k, const Vec<Dim>& trial) {
    const FieldContact<Dim>& c = contacts[k];
    const Response<Dim> response = law(k, trial.dot(c.normal) * c.normal);
    return {response.impulse.dot(c.normal) * c.normal + c.friction,
            response.status == ContactStatus::open ? ContactStatus::open : ContactStatus::slip};
  }

  /// Assembles the constraints of each contact by its present status. A contact that sticks constrains its
  /// whole relative velocity; one that slips its approach, with an impulse J = J_n (n + s) of constant s.
  /// @return false if nothing is constrained, or more than the operator has space for
  bool assemble_operator() {
    operator_.clear();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.status == ContactStatus::open) continue;
      if (operator_.is_full()) return false;
      const Vec<Dim> residual = c.reduced_mass * (relative_velocity(c) + c.target_approach * c.normal);
      const auto push = [&](const Vec<Dim>& impulse, const Vec<Dim>& motion) {
        operator_.push({static_cast<int>(k), c.a, c.b, c.reduced_mass * field(c.a).inverse_mass,
                        c.reduced_mass * field(c.b).inverse_mass, impulse, motion, residual.dot(motion)});
      };
      const double normal_impulse = c.impulse.dot(c.normal);
      if (c.status == ContactStatus::stick)
        for (int d = 0; d < Dim; ++d) push(Vec<Dim>::Unit(d), Vec<Dim>::Unit(d));
      else
        push(lags_ || normal_impulse == 0 ? c.normal : Vec<Dim>(c.impulse / normal_impulse), c.normal);
    }
    return operator_.count() > 0;
  }

  /// The active-set Newton step. A contact that opens on the way leaves the set, and the step begins anew.
  template <class Law>
  void newton_step(const Law& law) {
    while (newton_step_until_one_opens(law)) {
    }
  }

  /// @return whether a contact opened
  template <class Law>
  bool newton_step_until_one_opens(const Law& law) {
    if (!assemble_operator()) return false;
    if (!operator_.solve()) return false;
    changes_.assign(contacts.size(), Vec<Dim>::Zero());
    operator_.for_each_change(
        [&](int contact, const Vec<Dim>& change) { changes_[static_cast<std::size_t>(contact)] += change; });
    FieldContact<Dim>* opens = nullptr;
    const double share = step_length(law, opens), before = lags_ ? objective() : 0;
    advance(share);
    if (lags_ && !(objective() <= before)) {
      advance(-share);
      return false;
    }
    if (opens) opens->status = ContactStatus::open;
    return opens;
  }

  /// Adds a share of the Newton step.
  void advance(double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      contacts[k].impulse += share * changes_[k];
      add(contacts[k], share * changes_[k]);
    }
  }

  /// The function that the impulses of frictionless contacts minimise: Σ ½ m v² − Σ (target approach) J·n, J.
  double objective() {
    double sum = 0;
    for (const MovingField<Dim>& f : fields)
      if (f.inverse_mass > 0) sum += 0.5 * f.velocity.squaredNorm() / f.inverse_mass;
    for (const FieldContact<Dim>& c : contacts) sum -= c.target_approach * c.impulse.dot(c.normal);
    return sum;
  }

  /// Does every sticking contact stick over this share of the step?
  template <class Law>
  bool all_stick(const Law& law, double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.status != ContactStatus::stick) continue;
      const Vec<Dim> impulse = c.impulse + share * changes_[k];  // the law adds the target approach
      if (law(k, impulse - c.reduced_mass * c.target_approach * c.normal).status != ContactStatus::stick)
        return false;
    }
    return true;
  }

  /// The share of the step up to the first change of a status, at most 1. Beyond it, the step may be far from
  /// any solution.
  /// @param opens  result: the contact that ends the step by opening
  template <class Law>
  double step_length(const Law& law, FieldContact<Dim>*& opens) {
    double most = 1;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      if (c.status != ContactStatus::slip || c.bilateral) continue;
      const double now = c.impulse.dot(c.normal), change = changes_[k].dot(c.normal), end = now + change;
      if (now > 0 ? !(end < 0) : !(end > 0)) continue;  // the normal impulse keeps its sign
      const double share = std::max(0.0, -now / change);
      if (share < most) most = share, opens = &c;
    }
    if (all_stick(law, most)) return most;
    opens = nullptr;
    double share = 0, step = 0.5 * most;
    for (int halved = 0; halved < constants::kStepHalvings; ++halved, step *= 0.5)
      if (all_stick(law, share + step)) share += step;
    return share;
  }

  DelassusOperator<Dim> operator_;
  double noise_{}, momentum_{};    ///< N s (find_scales)
  double largest_{};               ///< largest |J|² of the last sweep, N² s²
  bool lags_ = false;              ///< friction is prescribed
  std::vector<Vec<Dim>> start_;    ///< velocities before any impulse, m/s
  std::vector<Vec<Dim>> changes_;  ///< of the contacts' impulses, or of the fields' momenta
};

}  // namespace mpmfast
