#pragma once

/// @file All contacts of a node where three or more fields meet, at once: impulses such that each contact
/// obeys its law with the velocities that all of them leave.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/contact/hindrances.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A field of the node; a rigid one has no inverse mass.
template <int Dim>
struct MovingField {
  Vec<Dim> velocity;    ///< m/s, with the impulses so far
  double inverse_mass;  ///< 1/kg
};

/// What motion of two surfaces a contact hinders by its present kind: parted; sliding; stuck.
enum class Hinders { nothing, approach, slip };

/// What a law demands of one contact while the others stay.
template <int Dim>
struct Demand {
  Vec<Dim> impulse;  ///< Δp_a, N s
  Hinders hinders;
};

/// The demand of a law that returns impulses alone: one that is neither none nor all of `stick` slides.
template <int Dim>
inline Demand<Dim> demand_of(const Vec<Dim>& impulse, const Vec<Dim>& stick) {
  return {impulse, impulse.isZero(0)  ? Hinders::nothing
                   : impulse == stick ? Hinders::slip
                                      : Hinders::approach};
}

/// A contact between the node's fields a and b that may have an impulse.
template <int Dim>
struct FieldContact {
  int a, b;
  Vec<Dim> normal;                       ///< unit, from a to b
  double reduced;                        ///< 1/(1/m_a + 1/m_b), kg
  double closing{};                      ///< the approach that closes a gap within the step, and is left, m/s
  bool both_ways = false;                ///< it pulls as it presses
  Hinders hinders = Hinders::nothing;    ///< found, as the law says
  Vec<Dim> impulse = Vec<Dim>::Zero();   ///< found: Δp_a, N s; b takes −Δp_a
  Vec<Dim> friction = Vec<Dim>::Zero();  ///< its tangential part while friction lags, N s
};

/// The contacts of one node and the room to solve them in, which later nodes use again.
///
/// Gauss–Seidel gives each contact in turn the impulse that its law demands while the others stay. It finds
/// soon which contacts stick, slide and part, and then creeps: the more slowly, the lighter a field between
/// heavy ones. So between sweeps it leaps to the impulses that end all motion which the contacts hinder if
/// none changes its kind; for Coulomb's law in 2-D, where no slip turns, that is the solution. Every impulse
/// has its counter-impulse, so momentum is conserved at any stage.
template <int Dim>
class ContactsTogether {
 public:
  std::vector<MovingField<Dim>> fields;
  std::vector<FieldContact<Dim>> contacts;

  /// Finds the impulses, from the present ones. Where all at once do not settle, friction follows the normal
  /// impulses, and what of it would drive is left out; no impulses do work, settled or not.
  /// @param law  law(k, d): the Demand of contact k where sticking would need d
  /// @return whether they settled to 1e-9 of the largest and obey their laws
  template <class Law>
  bool solve(const Law& law) {
    find_scales();
    for (int done = 0; done < kSweeps; ++done) {
      const bool settled = sweep(law);
      if (contacts.size() == 1) return true;
      if (!is_bounded()) break;
      if (settled) return true;
      if (done < kLeaps || done % kLeaps == 0) leap(law);
    }
    return lag(law);
  }

 private:
  static constexpr int kSweeps = 100, kLeaps = 10;  ///< where kinds still change then, leaps seldom help

  MovingField<Dim>& field(int k) { return fields[static_cast<std::size_t>(k)]; }
  Vec<Dim> slip(const FieldContact<Dim>& c) { return field(c.b).velocity - field(c.a).velocity; }

  void add(FieldContact<Dim>& c, const Vec<Dim>& impulse) {
    field(c.a).velocity += field(c.a).inverse_mass * impulse;
    field(c.b).velocity -= field(c.b).inverse_mass * impulse;
  }

  /// Friction that follows the last normal impulses, from none, which then settle for it: fields that jam may
  /// have no impulses that obey both, but normal impulses for given friction always exist, and do no work.
  /// @return whether the friction settled too
  template <class Law>
  bool lag(const Law& law) {
    constexpr int kRounds = 8;
    lags_ = true;
    bool settled = false;
    double last = kUnbounded;
    bool pressed = restart(law);
    for (int round = 0; round < kRounds && !settled; ++round) {
      double largest = 0, change = 0;
      changes_.resize(contacts.size());
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        FieldContact<Dim>& c = contacts[k];
        const Vec<Dim> impulse = law(k, c.impulse + c.reduced * slip(c)).impulse;
        changes_[k] = impulse - impulse.dot(c.normal) * c.normal - c.friction;
        largest = std::max(largest, impulse.squaredNorm());
        change = std::max(change, changes_[k].squaredNorm());
      }
      settled = pressed && is_settled(change, largest);
      if (!(change < last)) break;
      for (std::size_t k = 0; k < contacts.size(); ++k) contacts[k].friction += 0.5 * changes_[k];
      last = change;
      pressed = press(law);
    }
    for (int round = 0; round < kRounds && !settled && drop(law); ++round) press(law);
    settled &= is_bounded();
    if (!is_bounded()) restart(law);
    lags_ = false;
    if (!settled) take_back_work();
    return settled;
  }

  /// Friction may wedge fields with any stress of their own; what it cannot have got from their motion is
  /// none.
  bool is_bounded() const {
    constexpr double kShare = 30;
    return largest_ <= kShare * kShare * motion_ * motion_;
  }

  /// Normal impulses without friction, from none.
  template <class Law>
  bool restart(const Law& law) {
    for (std::size_t k = 0; k < fields.size(); ++k) fields[k].velocity = start_[k];
    for (FieldContact<Dim>& c : contacts) {
      c.impulse.setZero();
      c.friction.setZero();
    }
    return press(law);
  }

  /// Normal impulses for given friction. @return whether they settled
  template <class Law>
  bool press(const Law& law) {
    for (int done = 0; done < kSweeps; ++done) {
      if (sweep(law)) return true;
      leap(law);
    }
    return false;
  }

  /// Friction only takes energy, and no more than its law allows. @return whether some was dropped
  template <class Law>
  bool drop(const Law& law) {
    constexpr double kSpare = 1.001;
    bool dropped = false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      const Vec<Dim> impulse = law(k, c.impulse + c.reduced * slip(c)).impulse;
      const double allowed = (impulse - impulse.dot(c.normal) * c.normal).norm(), now = c.friction.norm();
      const double share = c.friction.dot(slip(c)) < 0 ? 0 : now > kSpare * allowed ? allowed / now : 1;
      c.friction *= share;
      dropped |= share < 1;
    }
    return dropped;
  }

  bool is_settled(double change, double largest) const {
    return change <= std::max(1e-18 * largest, noise_ * noise_);
  }

  /// What round-off of the velocities makes of impulses, and all that there is to move.
  void find_scales() {
    constexpr double kRoundOff = 1e-14;
    double fastest = 0, heaviest = 0;
    const MovingField<Dim>* ground = fields.data();
    for (const MovingField<Dim>& f : fields) {
      fastest = std::max(fastest, f.velocity.squaredNorm());
      if (f.inverse_mass < ground->inverse_mass) ground = &f;
    }
    for (const FieldContact<Dim>& c : contacts) heaviest = std::max(heaviest, c.reduced);
    noise_ = kRoundOff * heaviest * std::sqrt(fastest);
    motion_ = 0;
    start_.clear();
    for (const MovingField<Dim>& f : fields) start_.push_back(f.velocity);
    for (const MovingField<Dim>& f : fields)
      if (f.inverse_mass > 0) motion_ += (f.velocity - ground->velocity).norm() / f.inverse_mass;
  }

  /// @return whether no impulse changed by more than 1e-9 of the largest, or by round-off alone
  template <class Law>
  bool sweep(const Law& law) {
    double change = 0;
    largest_ = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      const Vec<Dim> stick = c.impulse + c.reduced * slip(c);
      const Demand<Dim> demand = lags_ ? pressing(law, k, stick) : law(k, stick);
      const Vec<Dim> step = demand.impulse - c.impulse;
      add(c, step);
      c.impulse = demand.impulse;
      c.hinders = demand.hinders;
      largest_ = std::max(largest_, c.impulse.squaredNorm());
      change = std::max(change, step.squaredNorm());
    }
    return is_settled(change, largest_);
  }

  /// Contact only takes energy: Σ J · slip ≥ 0 over the slips that it leaves. Impulses that have not settled
  /// may wedge fields apart that jam in a ring; they are cut to where they take the most.
  void take_back_work() {
    double taken = 0, squares = 0;  // Σ J · slip after, Σ |Δp|²/m: their sum is that over the slips before
    for (const FieldContact<Dim>& c : contacts) taken += c.impulse.dot(slip(c));
    if (taken >= 0) return;
    changes_.assign(fields.size(), Vec<Dim>::Zero());
    for (const FieldContact<Dim>& c : contacts) {
      changes_[static_cast<std::size_t>(c.a)] += c.impulse;
      changes_[static_cast<std::size_t>(c.b)] -= c.impulse;
    }
    for (std::size_t k = 0; k < fields.size(); ++k)
      squares += fields[k].inverse_mass * changes_[k].squaredNorm();
    const double share = std::clamp((taken + squares) / squares, 0.0, 1.0);
    for (FieldContact<Dim>& c : contacts) {
      add(c, (share - 1) * c.impulse);
      c.impulse *= share;
    }
  }

  /// The demand of a contact whose friction is given.
  template <class Law>
  Demand<Dim> pressing(const Law& law, std::size_t k, const Vec<Dim>& stick) {
    const FieldContact<Dim>& c = contacts[k];
    const Demand<Dim> demand = law(k, stick.dot(c.normal) * c.normal);
    return {demand.impulse.dot(c.normal) * c.normal + c.friction,
            demand.hinders == Hinders::nothing ? Hinders::nothing : Hinders::approach};
  }

  /// What each contact hinders by its present kind: stuck, all slip; sliding, with J = J_n (n + s) and s to
  /// stay, the approach.
  /// @return false if that is nothing at all or too much
  bool find_hindrances() {
    hindrances_.clear();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.hinders == Hinders::nothing) continue;
      if (hindrances_.is_full()) return false;
      const Vec<Dim> left = c.reduced * (slip(c) + c.closing * c.normal);
      const auto push = [&](const Vec<Dim>& impulse, const Vec<Dim>& motion) {
        hindrances_.push({static_cast<int>(k), c.a, c.b, c.reduced * field(c.a).inverse_mass,
                          c.reduced * field(c.b).inverse_mass, impulse, motion, left.dot(motion)});
      };
      const double along = c.impulse.dot(c.normal);
      if (c.hinders == Hinders::slip)
        for (int d = 0; d < Dim; ++d) push(Vec<Dim>::Unit(d), Vec<Dim>::Unit(d));
      else
        push(lags_ || along == 0 ? c.normal : Vec<Dim>(c.impulse / along), c.normal);
    }
    return hindrances_.count() > 0;
  }

  /// Goes where no hindered motion is left; contacts that part on the way are left behind.
  template <class Law>
  void leap(const Law& law) {
    while (leap_until_one_parts(law)) {
    }
  }

  /// @return whether a contact parted
  template <class Law>
  bool leap_until_one_parts(const Law& law) {
    if (!find_hindrances()) return false;
    if (!hindrances_.solve()) return false;
    changes_.assign(contacts.size(), Vec<Dim>::Zero());
    hindrances_.for_each_change(
        [&](int contact, const Vec<Dim>& change) { changes_[static_cast<std::size_t>(contact)] += change; });
    FieldContact<Dim>* parts = nullptr;
    const double share = share_of_leap(law, parts), before = lags_ ? excess() : 0;
    go(share);
    if (lags_ && !(excess() <= before)) {
      go(-share);
      return false;
    }
    if (parts) parts->hinders = Hinders::nothing;
    return parts;
  }

  /// Adds a share of the leap.
  void go(double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      contacts[k].impulse += share * changes_[k];
      add(contacts[k], share * changes_[k]);
    }
  }

  /// What impulses of contacts without friction make least: Σ ½ m v² − Σ closing J·n, J.
  double excess() {
    double sum = 0;
    for (const MovingField<Dim>& f : fields)
      if (f.inverse_mass > 0) sum += 0.5 * f.velocity.squaredNorm() / f.inverse_mass;
    for (const FieldContact<Dim>& c : contacts) sum -= c.closing * c.impulse.dot(c.normal);
    return sum;
  }

  /// Does every stuck contact remain so over this share of the leap?
  template <class Law>
  bool all_stick(const Law& law, double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.hinders != Hinders::slip) continue;
      const Vec<Dim> impulse = c.impulse + share * changes_[k];
      if (law(k, impulse - c.reduced * c.closing * c.normal).hinders != Hinders::slip) return false;
    }
    return true;
  }

  /// All of the leap, or as far as no contact changes its kind: what lies beyond may be far from any
  /// solution.
  /// @param parts the contact that stops it by parting
  template <class Law>
  double share_of_leap(const Law& law, FieldContact<Dim>*& parts) {
    double most = 1;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      if (c.hinders != Hinders::approach || c.both_ways) continue;
      const double now = c.impulse.dot(c.normal), change = changes_[k].dot(c.normal), end = now + change;
      if (now > 0 ? !(end < 0) : !(end > 0)) continue;
      const double share = std::max(0.0, -now / change);
      if (share < most) most = share, parts = &c;
    }
    if (all_stick(law, most)) return most;
    parts = nullptr;
    double share = 0;
    for (double step = 0.5 * most; step > 0.01 * most; step *= 0.5)
      if (all_stick(law, share + step)) share += step;
    return share;
  }

  Hindrances<Dim> hindrances_;
  double noise_{}, motion_{};      ///< N s
  double largest_{};               ///< |J|², N² s²
  bool lags_ = false;              ///< friction is given
  std::vector<Vec<Dim>> start_;    ///< velocities, m/s
  std::vector<Vec<Dim>> changes_;  ///< of the contacts' impulses, or the fields' momenta
};

}  // namespace mpmfast
