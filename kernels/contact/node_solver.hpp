#pragma once

/// @file All contacts of a node where three or more fields meet, solved together: impulses such that each
/// contact obeys its law with the velocities that all impulses leave.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/constants.hpp"
#include "kernels/contact/active_set_solver.hpp"
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
  Vec<Dim> change = Vec<Dim>::Zero();          ///< of the impulse in a Newton step, or of the friction, N s
};

/// The fields and contacts of one node, as ActiveSetSolver asks for them.
template <int Dim>
class NodeContacts {
 public:
  static constexpr int kDim = Dim;
  using Number = double;

  std::vector<MovingField<Dim>> fields;
  std::vector<FieldContact<Dim>> contacts;

  int contact_count() const { return static_cast<int>(contacts.size()); }
  template <class F>
  void for_each_contact(const F& f) const {
    for (std::size_t k = 0; k < contacts.size(); ++k) f(k);
  }
  template <class F>
  void for_each_field(const F& f) const {
    for (const MovingField<Dim>& field : fields) f(field);
  }
  FieldContact<Dim>& contact(std::size_t k) { return contacts[k]; }
  const FieldContact<Dim>& contact(std::size_t k) const { return contacts[k]; }
  MovingField<Dim>& first(std::size_t k) { return fields[static_cast<std::size_t>(contacts[k].a)]; }
  const MovingField<Dim>& first(std::size_t k) const {
    return fields[static_cast<std::size_t>(contacts[k].a)];
  }
  MovingField<Dim>& second(std::size_t k) { return fields[static_cast<std::size_t>(contacts[k].b)]; }
  const MovingField<Dim>& second(std::size_t k) const {
    return fields[static_cast<std::size_t>(contacts[k].b)];
  }

  /// From the constraints of each contact by its present status. A contact that sticks constrains its whole
  /// relative velocity; one that slips its approach, with an impulse J = J_n (n + s) of constant s.
  /// @return false if nothing is constrained, or more than the operator has space for, or a change is
  /// infinite
  bool find_changes(bool going) {
    if (!going || !assemble_operator() || !operator_.solve()) return false;
    for (FieldContact<Dim>& c : contacts) c.change.setZero();
    operator_.for_each_change([&](int contact, const Vec<Dim>& change) {
      contacts[static_cast<std::size_t>(contact)].change += change;
    });
    return true;
  }

  /// Adds a share of the changes; while friction lags, only if that lowers the objective. @return whether
  /// added
  bool advance(bool going, double share) {
    if (!going) return false;
    const double before = friction_lags_ ? objective() : 0;
    add_share(share);
    if (!friction_lags_ || objective() <= before) return true;
    add_share(-share);
    return false;
  }

 protected:
  bool friction_lags_ = false;  ///< friction is prescribed: impulses change along the normal

 private:
  void add_share(double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const Vec<Dim> step = share * contacts[k].change;
      contacts[k].impulse += step;
      add_to_velocities(*this, k, step);
    }
  }

  bool assemble_operator() {
    operator_.clear();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.status == ContactStatus::open) continue;
      if (operator_.is_full()) return false;
      const Vec<Dim> residual = c.reduced_mass * (relative_velocity(*this, k) + c.target_approach * c.normal);
      const auto push = [&](const Vec<Dim>& impulse, const Vec<Dim>& motion) {
        operator_.push({static_cast<int>(k), c.a, c.b, c.reduced_mass * first(k).inverse_mass,
                        c.reduced_mass * second(k).inverse_mass, impulse, motion, residual.dot(motion)});
      };
      if (c.status == ContactStatus::stick)
        for (int d = 0; d < Dim; ++d) push(Vec<Dim>::Unit(d), Vec<Dim>::Unit(d));
      else
        push(friction_lags_ ? c.normal : slip_direction(c.impulse, c.normal), c.normal);
    }
    return operator_.count() > 0;
  }

  /// The function that the impulses of frictionless contacts minimise: Σ ½ m v² − Σ (target approach) J·n, J.
  double objective() const {
    double sum = 0;
    for (const MovingField<Dim>& f : fields)
      if (f.inverse_mass > 0) sum += 0.5 * f.velocity.squaredNorm() / f.inverse_mass;
    for (const FieldContact<Dim>& c : contacts) sum -= c.target_approach * c.impulse.dot(c.normal);
    return sum;
  }

  DelassusOperator<Dim> operator_;
};

/// The contacts of one node, with the memory to solve them (ActiveSetSolver).
template <int Dim>
class NodeSolver : public NodeContacts<Dim> {
 public:
  using NodeContacts<Dim>::contacts, NodeContacts<Dim>::fields;

  /// Finds the impulses. If they do not converge, friction is prescribed and
  /// the normal impulses are solved for it, by turns; friction that would do positive work is removed.
  /// Converged or not, impulses do no positive work.
  /// @pre the impulses are zero
  /// @param law  law(k, trial): the Response of contact k to the impulse that sticking would need
  /// @return whether they converged (constants::kSweepTolerance) and obey their laws
  template <class Law>
  bool solve(const Law& law) {
    start_.clear();
    for (const MovingField<Dim>& f : fields) start_.push_back(f.velocity);
    ActiveSetSolver<NodeContacts<Dim>, Law> solver(*this, law);
    if (contacts.size() == 1) {
      solver.sweep(true);
      return true;
    }
    return solver.solve(constants::kMostSweeps, true) || solve_with_lagged_friction(law);
  }

 private:
  using NodeContacts<Dim>::friction_lags_;

  /// By turns, friction is set from the last normal impulses and the normal impulses are solved for it. Both
  /// begin at zero. Fields that jam may have no impulses that obey both laws; normal impulses for given
  /// friction always exist, and do no work.
  /// @return whether the friction converged too
  template <class Law>
  bool solve_with_lagged_friction(const Law& law) {
    friction_lags_ = true;
    restart();
    const auto lagged_law = [&](std::size_t k, const Vec<Dim>& trial) {
      return normal_response(law, k, trial);
    };
    ActiveSetSolver<NodeContacts<Dim>, decltype(lagged_law)> solver(*this, lagged_law);
    bool converged = false;
    double last = std::numeric_limits<double>::infinity();
    bool normal_converged = solve_normal_impulses(solver);
    for (int round = 0; round < constants::kFrictionRounds && !converged; ++round) {
      double largest = 0, change = 0;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        FieldContact<Dim>& c = contacts[k];
        const Vec<Dim> impulse = law_impulse(law, k);
        c.change = split(impulse, c.normal).tangential - c.friction;
        largest = std::max(largest, impulse.squaredNorm());
        change = std::max(change, c.change.squaredNorm());
      }
      converged = normal_converged && solver.is_converged(change, largest);
      if (!(change < last)) break;
      for (FieldContact<Dim>& c : contacts) c.friction += 0.5 * c.change;
      last = change;
      normal_converged = solve_normal_impulses(solver);
    }
    for (int round = 0; round < constants::kFrictionRounds && !converged && cut_friction(law); ++round)
      solve_normal_impulses(solver);
    if (!solver.is_bounded()) {
      converged = false;
      restart();
      solve_normal_impulses(solver);
    }
    friction_lags_ = false;
    if (!converged) remove_work();
    return converged;
  }

  /// The velocities before any impulse; no impulses, no friction.
  void restart() {
    for (std::size_t k = 0; k < fields.size(); ++k) fields[k].velocity = start_[k];
    for (FieldContact<Dim>& c : contacts) {
      c.impulse.setZero();
      c.friction.setZero();
    }
  }

  /// Normal impulses for given friction. @return whether they converged
  template <class Solver>
  static bool solve_normal_impulses(Solver& solver) {
    for (int done = 0; done < constants::kMostSweeps; ++done) {
      if (solver.sweep(true)) return true;
      solver.newton_step(true);
    }
    return false;
  }

  /// What the law of a contact gives it at the present velocities, N s.
  template <class Law>
  Vec<Dim> law_impulse(const Law& law, std::size_t k) const {
    const FieldContact<Dim>& c = contacts[k];
    return law(k, c.impulse + c.reduced_mass * relative_velocity(*this, k)).impulse;
  }

  /// Removes friction that drives its surfaces, and cuts friction beyond its law. @return whether any was cut
  template <class Law>
  bool cut_friction(const Law& law) {
    bool cut = false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      const double allowed = split(law_impulse(law, k), c.normal).tangential.norm(), now = c.friction.norm();
      const double share = c.friction.dot(relative_velocity(*this, k)) < 0 ? 0
                           : now > constants::kSpareFriction * allowed     ? allowed / now
                                                                           : 1;
      c.friction *= share;
      cut |= share < 1;
    }
    return cut;
  }

  /// Scales the impulses so that contact only dissipates, Σ J·w ≥ 0 with the relative velocities w that it
  /// leaves. Impulses that have not converged may drive fields apart that jam in a ring. The work is
  /// s J·w_0 − ½ s² Σ |Δp|²/m with a factor s and w_0 before any impulse; s maximises it.
  void remove_work() {
    double dissipated = 0, squares = 0;  // Σ J·w; Σ |Δp|²/m; their sum is Σ J·w_0
    for (std::size_t k = 0; k < contacts.size(); ++k)
      dissipated += contacts[k].impulse.dot(relative_velocity(*this, k));
    if (dissipated >= 0) return;
    momenta_.assign(fields.size(), Vec<Dim>::Zero());
    for (const FieldContact<Dim>& c : contacts) {
      momenta_[static_cast<std::size_t>(c.a)] += c.impulse;
      momenta_[static_cast<std::size_t>(c.b)] -= c.impulse;
    }
    for (std::size_t k = 0; k < fields.size(); ++k)
      squares += fields[k].inverse_mass * momenta_[k].squaredNorm();
    const double share = std::clamp((dissipated + squares) / squares, 0.0, 1.0);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      add_to_velocities(*this, k, Vec<Dim>((share - 1) * contacts[k].impulse));
      contacts[k].impulse *= share;
    }
  }

  /// The response of a contact whose friction is prescribed.
  template <class Law>
  Response<Dim> normal_response(const Law& law, std::size_t k, const Vec<Dim>& trial) const {
    const FieldContact<Dim>& c = contacts[k];
    const Response<Dim> response = law(k, trial.dot(c.normal) * c.normal);
    return {response.impulse.dot(c.normal) * c.normal + c.friction,
            response.status == ContactStatus::open ? ContactStatus::open : ContactStatus::slip};
  }

  std::vector<Vec<Dim>> start_;    ///< velocities before any impulse, m/s
  std::vector<Vec<Dim>> momenta_;  ///< what the impulses change, by field, N s
};

}  // namespace mpmfast
