#pragma once

/// @file The contacts of kLanes nodes at once, all of as many fields: ActiveSetSolver with one node a SIMD
/// lane.

#include <limits>
#include <utility>

#include "kernels/constants.hpp"
#include "kernels/contact/active_set_rule.hpp"
#include "kernels/contact/active_set_solver.hpp"
#include "kernels/contact/friction_cone.hpp"
#include "kernels/contact/laws.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/lane_vector.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// The pairs of kFields fields, in the order of their fields.
template <int kFields>
struct FieldPairs {
  static constexpr int kCount = kFields * (kFields - 1) / 2;

  /// The pair of two fields.
  static constexpr int of(int a, int b) {
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * kFields - low * (low + 1) / 2 + high - low - 1;
  }
  static constexpr int first(int pair) {
    int a = 0;
    while (pair >= kFields - 1 - a) pair -= kFields - 1 - a++;
    return a;
  }
  static constexpr int second(int pair) {
    int a = 0;
    while (pair >= kFields - 1 - a) pair -= kFields - 1 - a++;
    return a + 1 + pair;
  }
  /// Calls f with the number of each pair as a constant.
  template <class F>
  static void for_each(const F& f) {
    [&]<int... K>(std::integer_sequence<int, K...>) { (f(std::integral_constant<int, K>()), ...); }
    (std::make_integer_sequence<int, kCount>());
  }
};

/// The fields and contacts of kLanes nodes, as ActiveSetSolver asks for them.
template <int Dim, int kFields>
class LaneContacts {
 public:
  static constexpr int kDim = Dim;
  using Number = Lanes;
  using Vector = LaneVector<Dim>;
  using Pairs = FieldPairs<kFields>;

  struct Field {
    Vector velocity;
    Lanes inverse_mass;
  };
  /// A contact of each node, with Coulomb's law (FieldContact, ActiveSetRule). Those that are not there never
  /// act.
  struct Contact {
    Vector normal, impulse, change;
    Lanes reduced_mass, target_approach, friction, static_friction;
    IntLanes status, acts, bilateral, must_stick;
  };

  Field fields[kFields];
  Contact contacts[Pairs::kCount];
  bool may_stick;  ///< else no contact has friction or must stick, and each has one equation

  static constexpr int contact_count() { return Pairs::kCount; }
  template <class F>
  static void for_each_contact(const F& f) {
    Pairs::for_each(f);
  }
  template <class F>
  void for_each_field(const F& f) const {
    for (const Field& field : fields) f(field);
  }
  Contact& contact(int k) { return contacts[k]; }
  const Contact& contact(int k) const { return contacts[k]; }
  Field& first(int k) { return fields[Pairs::first(k)]; }
  const Field& first(int k) const { return fields[Pairs::first(k)]; }
  Field& second(int k) { return fields[Pairs::second(k)]; }
  const Field& second(int k) const { return fields[Pairs::second(k)]; }

  /// ActiveSetRule::response with Coulomb's law.
  ResponseOf<Vector> response(int k, const Vector& trial) const {
    const Contact& c = contacts[k];
    const auto [along, tangential] = split(trial, c.normal);
    const Lanes end = along + c.reduced_mass * c.target_approach, presses = larger(Lanes(-end), Lanes{});
    const Lanes needed =
        larger(square_root(dot(tangential, tangential)), broadcast<Lanes>(constants::kLeastImpulse));
    const IntLanes holds = c.must_stick | (needed <= c.static_friction * presses);
    const Lanes limit =
        chosen(holds, broadcast<Lanes>(std::numeric_limits<double>::infinity()), c.friction * presses);
    const Friction<Vector> after = into_cone(tangential, needed, limit);
    const IntLanes acts = c.acts & ~((end > 0.0) & ~c.bilateral);  // a NaN presses, as in ActiveSetRule
    const IntLanes status =
        chosen(after.sticks, status_of<Lanes>(ContactStatus::stick), status_of<Lanes>(ContactStatus::slip));
    return {chosen(acts, end * c.normal + after.impulse, Vector{}),
            chosen(acts, status, status_of<Lanes>(ContactStatus::open))};
  }

  IntLanes find_changes(IntLanes going) {
    return may_stick ? find_changes<Dim>(going) : find_changes<1>(going);
  }

  /// Adds a share of the changes.
  IntLanes advance(IntLanes going, const Lanes& share) {
    for_each_contact([&](auto k) {
      const Vector step = chosen(going, share * contacts[k].change, Vector{});
      contacts[k].impulse += step;
      add_to_velocities(*this, k, step);
    });
    return going;
  }

 private:
  /// Solves the equations by Gauss–Jordan. A row that follows from those before gets none.
  /// @param matrix  [column][equation]; changed
  /// @param amount  the right side, then the solution
  template <int kCount>
  [[gnu::noinline]] static void eliminate(Lanes (&matrix)[kCount][kCount], Lanes (&amount)[kCount]) {
    const Lanes one = broadcast<Lanes>(1.0);
    Lanes inverse[kCount];
    for (int p = 0; p < kCount; ++p) {
      const Lanes pivot = matrix[p][p];
      const IntLanes needed = magnitude(pivot) > constants::kRedundantPivot;
      inverse[p] = chosen(needed, quotient(one, chosen(needed, pivot, one)), Lanes{});
      if (!any_of(needed)) continue;
      const Lanes* const factor = matrix[p];
      const auto take = [&](Lanes* from) {
        const Lanes own = from[p] * inverse[p];
        for (int i = 0; i < p; ++i) from[i] -= factor[i] * own;
        for (int i = p + 1; i < kCount; ++i) from[i] -= factor[i] * own;
      };
      for (int j = p + 1; j < kCount; ++j) take(matrix[j]);
      take(amount);
    }
    for (int i = 0; i < kCount; ++i) amount[i] *= inverse[i];
  }

  /// The changes of impulses that end all constrained relative motion (DelassusOperator), kRows rows for each
  /// contact; one that sticks has the first alone.
  /// @return where there is such motion, and the changes are finite
  template <int kRows>
  IntLanes find_changes(IntLanes going) {
    constexpr int kCount = Pairs::kCount * kRows;
    Vector motion[kCount], impulse[kCount];
    Lanes matrix[kCount][kCount], amount[kCount];  // [column][equation]
    IntLanes some{};
    for_each_contact([&](auto pair) {
      const Contact& c = contacts[pair];
      const IntLanes sticks = going & has(c.status, ContactStatus::stick),
                     slips = going & has(c.status, ContactStatus::slip);
      some |= sticks | slips;
      const Vector slip = slip_direction(c.impulse, c.normal);
      const Vector residual =
          c.reduced_mass * (relative_velocity(*this, pair) + c.target_approach * c.normal);
      for (int row = 0; row < kRows; ++row) {
        const int i = pair * kRows + row;
        const auto unit = Vector::of(
            [&](int d) { return chosen(sticks, broadcast<Lanes>(d == row ? 1.0 : 0.0), Lanes{}); });
        motion[i] = row == 0 ? chosen(slips, c.normal, unit) : unit;
        impulse[i] = row == 0 ? chosen(slips, slip, unit) : unit;
        amount[i] = dot(residual, motion[i]);
      }
    });
    for_each_contact([&](auto k) {
      const Lanes share_a = contacts[k].reduced_mass * first(k).inverse_mass,
                  share_b = contacts[k].reduced_mass * second(k).inverse_mass;
      for_each_contact([&](auto l) {
        constexpr int a = Pairs::first(k), b = Pairs::second(k), p = Pairs::first(l), q = Pairs::second(l);
        constexpr int sign_a = (a == p) - (a == q), sign_b = (b == q) - (b == p);
        for (int j = l * kRows; j < (l + 1) * kRows; ++j)
          for (int i = k * kRows; i < (k + 1) * kRows; ++i) {
            if constexpr (sign_a == 0 && sign_b == 0) {
              matrix[j][i] = Lanes{};
            } else {
              Lanes share{};
              if constexpr (sign_a != 0) share = sign_a > 0 ? share_a : -share_a;
              if constexpr (sign_b != 0) share = sign_b > 0 ? share + share_b : share - share_b;
              matrix[j][i] = share * dot(motion[i], impulse[j]);
            }
          }
      });
    });
    eliminate(matrix, amount);
    IntLanes finite = going & some;
    for_each_contact([&](auto pair) {
      Vector& change = contacts[pair].change;
      change = amount[pair * kRows] * impulse[pair * kRows];
      for (int row = 1; row < kRows; ++row)
        change += amount[pair * kRows + row] * impulse[pair * kRows + row];
      for (int d = 0; d < Dim; ++d) finite &= magnitude(change[d]) < std::numeric_limits<double>::infinity();
    });
    return finite;
  }
};

/// Nodes of kFields fields whose contacts belong to the active set of the step and have Coulomb friction or
/// none.
///
/// Contacts are swept in the order of their fields. A lane is left alone once its node has converged. A node
/// that does not converge within constants::kMostLaneSweeps is solved by NodeSolver from the start: about one
/// in a hundred of compressed grains in the plane, most random nodes of four and more fields in space.
template <int Dim, int kFields>
class LaneSolver {
 public:
  int count() const { return count_; }
  bool is_full() const { return count_ == kLanes; }
  bool is_empty() const { return count_ == 0; }

  /// Opens the next lane for a node, without contacts so far.
  int begin_node() {
    const int lane = count_++;
    for (ContactColumns& c : contacts_) c.acts[lane] = c.exists[lane] = 0;
    return lane;
  }
  void set_field(int lane, int k, const Vec<Dim>& velocity, double inverse_mass) {
    FieldColumns& f = fields_[k];
    for (int d = 0; d < Dim; ++d) f.velocity[d][lane] = velocity[d];
    f.inverse_mass[lane] = inverse_mass;
  }
  /// Adds a contact (FieldContact); no two contacts of a node have the same fields.
  void add_contact(int lane, int a, int b, const Vec<Dim>& normal, double reduced_mass,
                   double target_approach, const ActiveSetRule<Dim>& rule, const Coulomb& law) {
    ContactColumns& c = contacts_[Pairs::of(a, b)];
    for (int d = 0; d < Dim; ++d) c.normal[d][lane] = a < b ? normal[d] : -normal[d];
    c.reduced_mass[lane] = reduced_mass;
    c.target_approach[lane] = target_approach;
    c.friction[lane] = rule.friction ? law.friction : 0;
    c.static_friction[lane] = rule.friction ? law.static_friction : 0;
    c.exists[lane] = 1;
    c.acts[lane] = rule.acts;
    c.bilateral[lane] = rule.bilateral;
    c.must_stick[lane] = rule.must_stick;
  }
  bool has(int lane, int a, int b) const { return contacts_[Pairs::of(a, b)].exists[lane] != 0; }
  /// Result: Δp_a, N s.
  Vec<Dim> impulse(int lane, int a, int b) const {
    const auto& c = solving_.contacts[Pairs::of(a, b)];
    Vec<Dim> out;
    for (int d = 0; d < Dim; ++d) out[d] = a < b ? c.impulse[d][lane] : -c.impulse[d][lane];
    return out;
  }
  ContactStatus status(int lane, int a, int b) const {
    return static_cast<ContactStatus>(solving_.contacts[Pairs::of(a, b)].status[lane]);
  }

  /// Finds the impulses of all nodes from zero. They can be read until the next begin_node.
  /// @param may_stick  whether contacts may stick in this correction. (It belongs to the correction, so that
  ///                   the result of a lane does not depend on the others: sums of fewer terms round
  ///                   otherwise.)
  /// @return a bit for each lane whose node converged
  unsigned solve(bool may_stick) {
    if (is_empty()) return 0;
    fill_up();
    load();
    solving_.may_stick = may_stick;
    const auto law = [&](int k, const LaneVector<Dim>& trial) { return solving_.response(k, trial); };
    ActiveSetSolver<LaneContacts<Dim, kFields>, decltype(law)> solver(solving_, law);
    const IntLanes converged = solver.solve(constants::kMostLaneSweeps, lanes_before(count_));
    count_ = 0;
    return bits_of(converged & is_finite());
  }

 private:
  using Pairs = FieldPairs<kFields>;
  using Column = double[kLanes];

  /// Columns, to be filled lane by lane.
  struct FieldColumns {
    Column velocity[Dim], inverse_mass;
  };
  struct ContactColumns {
    Column normal[Dim], reduced_mass, target_approach, friction, static_friction, exists, acts, bilateral,
        must_stick;
  };

  /// Lanes without a node hold one that does nothing.
  void fill_up() {
    for (int lane = count_; lane < kLanes; ++lane) {
      for (FieldColumns& f : fields_) {
        for (int d = 0; d < Dim; ++d) f.velocity[d][lane] = 0;
        f.inverse_mass[lane] = 1;
      }
      for (ContactColumns& c : contacts_) c.acts[lane] = c.exists[lane] = 0;
    }
  }

  void load() {
    const auto is_set = [](const Column& x) { return load_lanes(x) != 0.0; };
    for (int k = 0; k < kFields; ++k) {
      auto& field = solving_.fields[k];
      for (int d = 0; d < Dim; ++d) field.velocity[d] = load_lanes(fields_[k].velocity[d]);
      field.inverse_mass = load_lanes(fields_[k].inverse_mass);
    }
    for (int k = 0; k < Pairs::kCount; ++k) {
      const ContactColumns& from = contacts_[k];
      auto& to = solving_.contacts[k];
      const IntLanes exists = is_set(from.exists);
      const auto there = [&](const Column& x) { return chosen(exists, load_lanes(x), Lanes{}); };
      for (int d = 0; d < Dim; ++d) to.normal[d] = there(from.normal[d]);
      to.impulse = {};
      to.reduced_mass = there(from.reduced_mass);
      to.target_approach = there(from.target_approach);
      to.friction = there(from.friction);
      to.static_friction = there(from.static_friction);
      to.acts = exists & is_set(from.acts);
      to.bilateral = exists & is_set(from.bilateral);
      to.must_stick = exists & is_set(from.must_stick);
      to.status = status_of<Lanes>(ContactStatus::open);
    }
  }

  /// Of a number and a NaN, `larger` may give the number: so NaN is looked for here.
  IntLanes is_finite() const {
    Lanes sum{};
    for (const auto& c : solving_.contacts) sum += dot(c.impulse, c.impulse);
    return sum < std::numeric_limits<double>::infinity();
  }

  int count_ = 0;
  FieldColumns fields_[kFields];
  ContactColumns contacts_[Pairs::kCount];
  LaneContacts<Dim, kFields> solving_;
};

}  // namespace mpmfast

#pragma GCC diagnostic pop
