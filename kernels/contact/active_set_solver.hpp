#pragma once

/// @file Impulses such that each contact of a node obeys its law with the velocities that all of them leave:
/// the algorithm of NodeSolver, over numbers, and of LaneSolver, over lanes.

#include <limits>
#include <type_traits>

#include "kernels/constants.hpp"
#include "kernels/contact/contact_status.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/lane_vector.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// v_b − v_a of contact k, m/s.
template <class Node, class Contact>
inline auto relative_velocity(const Node& node, Contact k) {
  return VectorOf<Node::kDim, typename Node::Number>(node.second(k).velocity - node.first(k).velocity);
}

/// Changes the velocities of a contact's fields by an impulse on the first.
template <class Node, class Contact, class Vector>
inline void add_to_velocities(Node& node, Contact k, const Vector& impulse) {
  auto &a = node.first(k), &b = node.second(k);
  a.velocity += a.inverse_mass * impulse;
  b.velocity -= b.inverse_mass * impulse;
}

/// The impulse of a slipping contact for a unit of its normal impulse J·n; along n where there is none.
template <class Vector>
inline Vector slip_direction(const Vector& impulse, const Vector& normal) {
  using Number = NumberOf<Vector>;
  const Number along = dot(impulse, normal);
  const MaskOf<Number> loaded = magnitude(along) > constants::kLeastImpulse;
  const Number inverse = quotient(broadcast<Number>(1.0), chosen(loaded, along, broadcast<Number>(1.0)));
  return chosen(loaded, Vector(inverse * impulse), normal);
}

/// Gauss–Seidel gives each contact in turn the impulse of its law while the others stay. A few sweeps find
/// the statuses; then convergence is slow, the more so the lighter a field between heavy ones. So a Newton
/// step on the active set follows each of the first sweeps, and some of the later ones. It finds the impulses
/// that end all constrained relative motion if no status changes. For Coulomb's law in 2-D, where no slip
/// turns, that is the solution once the statuses are right. Each impulse has its reaction, so every iterate
/// conserves momentum.
///
/// A mask says for which nodes a call acts: one condition for a number, one a lane for lanes. A lane computes
/// the same whatever the others hold.
///
/// @tparam Node  the fields and contacts of a node, or of kLanes nodes:
///   - `kDim`, `Number` (double or Lanes);
///   - `contact_count()`, `for_each_contact(f)`: f(k) in the order of a sweep, `for_each_field(f)`: f(field)
///     with its `velocity` and `inverse_mass`;
///   - `contact(k)` with `normal`, `reduced_mass`, `target_approach`, `bilateral`, `status`, `impulse`,
///     `change`; its fields `first(k)` and `second(k)`;
///   - `find_changes(mask)`: sets the changes of impulses that end all constrained relative motion, and
///   returns
///     where there are any and they are finite;
///   - `advance(mask, share)`: adds that share of the changes, and returns where it kept them.
/// @tparam Law  law(k, trial): the response of contact k to Δp_a that sticking would need, N s
template <class Node, class Law>
class ActiveSetSolver {
 public:
  using Number = typename Node::Number;
  using Mask = MaskOf<Number>;
  using Vector = VectorOf<Node::kDim, Number>;

  /// The scales of convergence are those of the velocities without impulses.
  ActiveSetSolver(Node& node, const Law& law) : node_(node), law_(law) { find_scales(); }

  /// Sweeps and Newton steps, starting from the present impulses.
  /// @return where the impulses have converged (constants::kSweepTolerance)
  Mask solve(int most_sweeps, Mask active) {
    constexpr int kEarly = constants::kEarlyNewtonSteps;
    Mask converged{};
    for (int done = 0; done < most_sweeps; ++done) {
      const Mask ends = sweep(active) & is_bounded();
      converged = converged | (active & ends);
      active = active & opposite(ends) & is_bounded();
      if (!any_of(active) || done + 1 == most_sweeps) break;
      if (done < kEarly || done % kEarly == 0) newton_step(active);
    }
    return converged;
  }

  /// One Gauss–Seidel sweep. @return where the impulses have converged
  [[gnu::flatten]] Mask sweep(Mask active) {
    Number change{}, largest{};
    node_.for_each_contact([&](auto k) {
      auto& c = node_.contact(k);
      const Vector trial = c.impulse + c.reduced_mass * relative_velocity(node_, k);
      const ResponseOf<Vector> response = law_(k, trial);
      const Vector& now = updated(active, response.impulse, c.impulse);
      const Vector step = now - c.impulse;
      add_to_velocities(node_, k, step);
      c.impulse = now;
      c.status = updated(active, response.status, c.status);
      largest = larger(dot(now, now), largest);  // the maximum outlasts a NaN
      change = larger(dot(step, step), change);
    });
    largest_ = largest;
    return is_converged(change, largest);
  }

  /// The active-set Newton step. A contact that opens on the way leaves the set, and the step begins anew.
  void newton_step(Mask going) {
    for (int opened = 0; opened <= node_.contact_count(); ++opened) {
      going = going & node_.find_changes(going);
      if (!any_of(going)) return;
      const NewtonShare step = share_of_step(going);
      going = going & node_.advance(going, step.share) & (step.opens >= 0.0);
      if (!any_of(going)) return;
      double number = 0;
      node_.for_each_contact([&](auto k) {
        auto& c = node_.contact(k);
        c.status = chosen(going & (step.opens == number++), status_of<Number>(ContactStatus::open), c.status);
      });
    }
  }

  /// @param change, largest  squared impulses, N² s²
  Mask is_converged(const Number& change, const Number& largest) const {
    constexpr double kSquared = constants::kSweepTolerance * constants::kSweepTolerance;
    return change <= larger(Number(kSquared * largest), noise_);
  }
  /// Is the largest impulse of the last sweep below the one that only wedging by friction makes
  /// (constants::kMostImpulse)?
  Mask is_bounded() const { return largest_ <= most_; }

 private:
  /// How far a Newton step goes, and the contact that ends it by opening; negative: none.
  struct NewtonShare {
    Number share, opens;
  };

  /// `now` where the mask holds, else `before`. (A single node is only swept while it is active; a copy of
  /// its impulse would take longer than the arithmetic.)
  template <class T>
  static decltype(auto) updated(Mask mask, const T& now, const T& before) {
    if constexpr (std::is_same_v<Number, double>)
      return (now);
    else
      return chosen(mask, now, before);
  }
  static Number one() { return broadcast<Number>(1.0); }
  static Vector zero() {
    Vector out;
    for (int d = 0; d < Node::kDim; ++d) out[d] = Number{};
    return out;
  }

  /// The impulse that round-off of the velocities makes, and the largest one that counts, from the momentum
  /// against the heaviest field. Both squared.
  void find_scales() {
    constexpr double kRoundOff = constants::kVelocityRoundOff, kMost = constants::kMostImpulse;
    Number fastest{}, heaviest{}, momentum{}, least = broadcast<Number>(std::numeric_limits<double>::max());
    Vector ground = zero();
    node_.for_each_field([&](const auto& f) {
      fastest = larger(fastest, dot(f.velocity, f.velocity));
      const Mask heavier = f.inverse_mass < least;
      least = chosen(heavier, f.inverse_mass, least);
      ground = chosen(heavier, f.velocity, ground);
    });
    node_.for_each_field([&](const auto& f) {
      const Vector apart = f.velocity - ground;
      const Mask moves = f.inverse_mass > 0.0;
      const Number inverse_mass = chosen(moves, f.inverse_mass, one());
      momentum += chosen(moves, quotient(square_root(dot(apart, apart)), inverse_mass), Number{});
    });
    node_.for_each_contact([&](auto k) { heaviest = larger(heaviest, node_.contact(k).reduced_mass); });
    noise_ = kRoundOff * kRoundOff * heaviest * heaviest * fastest;
    most_ = kMost * kMost * momentum * momentum;
  }

  /// Where, among those asked, every sticking contact sticks over this share of the step.
  [[gnu::flatten]] Mask all_stick(const Number& share, Mask all) const {
    node_.for_each_contact([&](auto k) {
      const auto& c = node_.contact(k);
      const Mask sticks = has(c.status, ContactStatus::stick);
      if (!any_of(sticks & all)) return;
      const Vector trial = c.impulse + share * c.change -
                           c.reduced_mass * c.target_approach * c.normal;  // the law adds the target approach
      all = all & (opposite(sticks) | has(law_(k, trial).status, ContactStatus::stick));
    });
    return all;
  }

  /// The share of the step up to the first change of a status, at most 1. Beyond it, the step may be far from
  /// any solution.
  NewtonShare share_of_step(Mask going) const {
    NewtonShare step{one(), broadcast<Number>(-1.0)};
    double number = 0;
    node_.for_each_contact([&](auto k) {
      const auto& c = node_.contact(k);
      const double own = number++;
      const Mask may_open = has(c.status, ContactStatus::slip) & opposite(c.bilateral);
      if (std::is_same_v<Number, double> && !any_of(may_open)) return;  // in lanes, a branch costs more
      const Number now = dot(c.impulse, c.normal), change = dot(c.change, c.normal), end = now + change;
      const Mask turns = may_open & (((now > 0.0) & (end < 0.0)) | (opposite(now > 0.0) & (end > 0.0)));
      const Number share = larger(quotient(Number(-now), chosen(turns, change, one())), Number{});
      const Mask first = turns & (share < step.share);
      step.share = chosen(first, share, step.share);
      step.opens = chosen(first, broadcast<Number>(own), step.opens);
    });
    const Mask shorter = going & opposite(all_stick(step.share, going));
    if (!any_of(shorter)) return step;
    Number share{}, half = 0.5 * step.share;
    for (int halved = 0; halved < constants::kStepHalvings; ++halved, half *= 0.5)
      share = chosen(all_stick(share + half, shorter), Number(share + half), share);
    return {chosen(shorter, share, step.share), chosen(shorter, broadcast<Number>(-1.0), step.opens)};
  }

  Node& node_;
  const Law law_;
  Number largest_{}, noise_{}, most_{};  ///< N² s²: the largest |J|², that of round-off, the bound on |J|²
};

}  // namespace mpmfast

#pragma GCC diagnostic pop
