#pragma once

/// @file The contacts of kLanes nodes at once, all of as many fields: the algorithm of node_solver.hpp with
/// one node a SIMD lane.

#include <limits>
#include <type_traits>
#include <utility>

#include "kernels/constants.hpp"
#include "kernels/contact/active_set_rule.hpp"
#include "kernels/contact/laws.hpp"
#include "kernels/contact/node_solver.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// Nodes of kFields fields whose contacts belong to the active set of the step and have Coulomb friction or
/// none.
///
/// The steps are those of NodeSolver with the contacts in the order of their fields. A lane computes the same
/// whatever the other lanes hold, and is left alone once its node has converged. A node that does not
/// converge within constants::kMostLaneSweeps is solved by NodeSolver from the start: about one in a hundred
/// of compressed grains in the plane, most random nodes of four and more fields in space.
template <int Dim, int kFields>
class LaneSolver {
 public:
  static constexpr int kContacts = kFields * (kFields - 1) / 2;

  int count() const { return count_; }
  bool is_full() const { return count_ == kLanes; }
  bool is_empty() const { return count_ == 0; }
  /// Index of the contact between two fields.
  static constexpr int pair_index(int a, int b) {
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * kFields - low * (low + 1) / 2 + high - low - 1;
  }

  /// Opens the next lane for a node, without contacts so far.
  int begin_node() {
    const int lane = count_++;
    for (Contact& c : contacts_) c.acts[lane] = c.exists[lane] = 0;
    return lane;
  }
  void set_field(int lane, int k, const Vec<Dim>& velocity, double inverse_mass) {
    Field& f = fields_[k];
    for (int d = 0; d < Dim; ++d) f.velocity[d][lane] = velocity[d];
    f.inverse_mass[lane] = inverse_mass;
  }
  /// Adds a contact (FieldContact); no two contacts of a node have the same fields.
  void add_contact(int lane, int a, int b, const Vec<Dim>& normal, double reduced_mass,
                   double target_approach, const ActiveSetRule<Dim>& rule, const Coulomb& law) {
    Contact& c = contacts_[pair_index(a, b)];
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
  bool has(int lane, int a, int b) const { return contacts_[pair_index(a, b)].exists[lane] != 0; }
  /// Result: Δp_a, N s.
  Vec<Dim> impulse(int lane, int a, int b) const {
    const Contact& c = contacts_[pair_index(a, b)];
    Vec<Dim> out;
    for (int d = 0; d < Dim; ++d) out[d] = a < b ? c.impulse[d][lane] : -c.impulse[d][lane];
    return out;
  }
  ContactStatus status(int lane, int a, int b) const {
    return static_cast<ContactStatus>(contacts_[pair_index(a, b)].status[lane]);
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
    find_scales();
    IntLanes active = lanes_before(count_), converged{};
    for (int done = 0; done < constants::kMostLaneSweeps; ++done) {
      const IntLanes ends = sweep(active) & is_bounded();
      converged |= active & ends;
      active &= ~ends & is_bounded();
      if (bits_of(active) == 0) break;
      if (done + 1 < constants::kMostLaneSweeps) newton_step(active, may_stick);
    }
    store();
    count_ = 0;
    return bits_of(converged & is_finite());
  }

 private:
  static constexpr auto kOpen = static_cast<double>(ContactStatus::open),
                        kSlip = static_cast<double>(ContactStatus::slip),
                        kStick = static_cast<double>(ContactStatus::stick);
  using Column = double[kLanes];
  using VecLanes = Lanes[Dim];

  struct Field {
    Column velocity[Dim], inverse_mass;
  };
  /// In columns, to be filled lane by lane.
  struct Contact {
    Column normal[Dim], reduced_mass, target_approach, friction, static_friction, exists, acts, bilateral,
        must_stick;
    Column impulse[Dim], status;
  };
  /// While they are solved.
  struct Moving {
    VecLanes velocity;
    Lanes inverse_mass;
  };
  struct Solving {
    VecLanes normal, impulse, change;
    Lanes reduced_mass, target_approach, friction, static_friction, status;
    IntLanes acts, bilateral, must_stick;
  };
  static constexpr int first_field(int pair) {
    int a = 0;
    while (pair >= kFields - 1 - a) pair -= kFields - 1 - a++;
    return a;
  }
  static constexpr int second_field(int pair) {
    int a = 0;
    while (pair >= kFields - 1 - a) pair -= kFields - 1 - a++;
    return a + 1 + pair;
  }

  static Lanes dot(const VecLanes& x, const VecLanes& y) {
    Lanes sum = x[0] * y[0];
    for (int d = 1; d < Dim; ++d) sum += x[d] * y[d];
    return sum;
  }
  static Lanes chosen(IntLanes which, Lanes a, Lanes b) { return which ? a : b; }

  /// Lanes without a node hold one that does nothing.
  void fill_up() {
    for (int lane = count_; lane < kLanes; ++lane) {
      for (Field& f : fields_) {
        for (int d = 0; d < Dim; ++d) f.velocity[d][lane] = 0;
        f.inverse_mass[lane] = 1;
      }
      for (Contact& c : contacts_) c.acts[lane] = c.exists[lane] = 0;
    }
  }

  void load() {
    const auto is_set = [](const Column& x) { return load_lanes(x) != 0.0; };
    for (int k = 0; k < kFields; ++k) {
      for (int d = 0; d < Dim; ++d) moving_[k].velocity[d] = load_lanes(fields_[k].velocity[d]);
      moving_[k].inverse_mass = load_lanes(fields_[k].inverse_mass);
    }
    for (int k = 0; k < kContacts; ++k) {
      const Contact& from = contacts_[k];
      Solving& to = solving_[k];
      const IntLanes exists = is_set(from.exists);
      const auto there = [&](const Column& x) { return chosen(exists, load_lanes(x), Lanes{}); };
      for (int d = 0; d < Dim; ++d) to.normal[d] = there(from.normal[d]), to.impulse[d] = Lanes{};
      to.reduced_mass = there(from.reduced_mass);
      to.target_approach = there(from.target_approach);
      to.friction = there(from.friction);
      to.static_friction = there(from.static_friction);
      to.acts = exists & is_set(from.acts);
      to.bilateral = exists & is_set(from.bilateral);
      to.must_stick = exists & is_set(from.must_stick);
      to.status = Lanes{};
    }
  }

  void store() {
    for (int k = 0; k < kContacts; ++k) {
      for (int d = 0; d < Dim; ++d) store_lanes(contacts_[k].impulse[d], solving_[k].impulse[d]);
      store_lanes(contacts_[k].status, solving_[k].status);
    }
  }

  /// As NodeSolver::find_scales, in squares.
  void find_scales() {
    constexpr double kRoundOff = constants::kVelocityRoundOff, kMost = constants::kMostImpulse;
    Lanes fastest{}, heaviest{}, momentum{}, least = moving_[0].inverse_mass;
    VecLanes ground;
    for (int d = 0; d < Dim; ++d) ground[d] = moving_[0].velocity[d];
    for (const Moving& f : moving_) {
      fastest = larger(fastest, dot(f.velocity, f.velocity));
      const IntLanes heavier = f.inverse_mass < least;
      least = chosen(heavier, f.inverse_mass, least);
      for (int d = 0; d < Dim; ++d) ground[d] = chosen(heavier, f.velocity[d], ground[d]);
    }
    for (const Moving& f : moving_) {
      VecLanes apart;
      for (int d = 0; d < Dim; ++d) apart[d] = f.velocity[d] - ground[d];
      const IntLanes moves = f.inverse_mass > 0.0;
      momentum += chosen(
          moves, quotient(square_root(dot(apart, apart)), chosen(moves, f.inverse_mass, one())), Lanes{});
    }
    for (const Solving& c : solving_) heaviest = larger(heaviest, c.reduced_mass);
    noise_ = kRoundOff * kRoundOff * heaviest * heaviest * fastest;
    most_ = kMost * kMost * momentum * momentum;
  }
  static Lanes one() { return broadcast<Lanes>(1.0); }
  IntLanes is_bounded() const { return largest_ <= most_; }
  /// Of a number and a NaN, `larger` may give the number: so NaN is looked for here.
  IntLanes is_finite() const {
    Lanes sum{};
    for (const Solving& c : solving_) sum += dot(c.impulse, c.impulse);
    return sum < std::numeric_limits<double>::infinity();
  }

  /// ActiveSetRule::response with Coulomb's law.
  /// @param trial    Δp_a that sticking would need, N s
  /// @param impulse  result, or null
  /// @return the status
  static Lanes response(const Solving& c, const VecLanes& trial, VecLanes* impulse) {
    const Lanes along = dot(trial, c.normal), end = along + c.reduced_mass * c.target_approach;
    VecLanes tangential;
    for (int d = 0; d < Dim; ++d) tangential[d] = trial[d] - along * c.normal[d];
    const Lanes needed =
        larger(square_root(dot(tangential, tangential)), broadcast<Lanes>(constants::kLeastImpulse));
    const Lanes presses = larger(-end, Lanes{}), limit = c.friction * presses;
    const IntLanes none = ~c.acts | ((end > 0.0) & ~c.bilateral);
    const IntLanes sticks =
        c.must_stick | (needed <= c.static_friction * presses) | ((needed <= limit) & (limit > 0.0));
    if (impulse) {
      const Lanes share = chosen(sticks, one(), quotient(limit, needed));
      for (int d = 0; d < Dim; ++d)
        (*impulse)[d] = chosen(none, Lanes{}, end * c.normal[d] + share * tangential[d]);
    }
    return chosen(none, broadcast<Lanes>(kOpen),
                  chosen(sticks, broadcast<Lanes>(kStick), broadcast<Lanes>(kSlip)));
  }

  template <int kPair>
  void add(const VecLanes& impulse) {
    Moving &a = moving_[first_field(kPair)], &b = moving_[second_field(kPair)];
    for (int d = 0; d < Dim; ++d) {
      solving_[kPair].impulse[d] += impulse[d];
      a.velocity[d] += a.inverse_mass * impulse[d];
      b.velocity[d] -= b.inverse_mass * impulse[d];
    }
  }
  template <int kPair>
  void relative_velocity(VecLanes& out) const {
    for (int d = 0; d < Dim; ++d)
      out[d] = moving_[second_field(kPair)].velocity[d] - moving_[first_field(kPair)].velocity[d];
  }
  template <class F>
  static void for_each_pair(const F& f) {
    [&]<int... K>(std::integer_sequence<int, K...>) { (f(std::integral_constant<int, K>()), ...); }
    (std::make_integer_sequence<int, kContacts>());
  }

  /// One Gauss–Seidel sweep. @return where the impulses have converged
  IntLanes sweep(IntLanes active) {
    constexpr double kTolerance = constants::kSweepTolerance * constants::kSweepTolerance;
    Lanes change{};
    largest_ = Lanes{};
    for_each_pair([&](auto pair) {
      Solving& c = solving_[pair];
      VecLanes trial, impulse, step;
      relative_velocity<pair>(trial);
      for (int d = 0; d < Dim; ++d) trial[d] = c.impulse[d] + c.reduced_mass * trial[d];
      c.status = chosen(active, response(c, trial, &impulse), c.status);
      for (int d = 0; d < Dim; ++d) step[d] = chosen(active, impulse[d] - c.impulse[d], Lanes{});
      add<pair>(step);
      largest_ = larger(largest_, dot(c.impulse, c.impulse));
      change = larger(change, dot(step, step));
    });
    return change <= larger(kTolerance * largest_, noise_);
  }

  /// The active-set Newton step in the lanes `going`. A contact that opens leaves the set, and the step
  /// begins anew.
  void newton_step(IntLanes going, bool may_stick) {
    for (int opened = 0; opened <= kContacts; ++opened) {
      going &= may_stick ? find_changes<Dim>(going) : find_changes<1>(going);
      if (bits_of(going) == 0) return;
      Lanes opens;
      const Lanes share = step_length(going, opens);
      for_each_pair([&](auto pair) {
        Solving& c = solving_[pair];
        VecLanes step;
        for (int d = 0; d < Dim; ++d) step[d] = chosen(going, share * c.change[d], Lanes{});
        add<pair>(step);
        c.status = chosen(going & (opens == static_cast<double>(pair)), Lanes{}, c.status);
      });
      going &= opens >= 0.0;
    }
  }

  /// The changes of impulses that end all constrained relative motion (DelassusOperator), kRows rows for each
  /// contact; one that sticks has the first alone.
  /// @return where there is such motion, and the changes are finite
  template <int kRows>
  IntLanes find_changes(IntLanes going) {
    constexpr int kCount = kContacts * kRows;
    VecLanes motion[kCount], impulse[kCount];
    Lanes matrix[kCount][kCount], amount[kCount];  // [column][equation]
    IntLanes some{};
    for_each_pair([&](auto pair) {
      const Solving& c = solving_[pair];
      const IntLanes sticks = going & (c.status == kStick), slips = going & (c.status == kSlip);
      some |= sticks | slips;
      const Lanes along = dot(c.impulse, c.normal);
      const IntLanes loaded = magnitude(along) > constants::kLeastImpulse;
      const Lanes inverse = quotient(one(), chosen(loaded, along, one()));
      VecLanes residual;
      relative_velocity<pair>(residual);
      for (int d = 0; d < Dim; ++d)
        residual[d] = c.reduced_mass * (residual[d] + c.target_approach * c.normal[d]);
      for (int row = 0; row < kRows; ++row) {
        const int i = pair * kRows + row;
        for (int d = 0; d < Dim; ++d) {
          const Lanes unit = chosen(sticks, broadcast<Lanes>(d == row ? 1.0 : 0.0), Lanes{});
          motion[i][d] = row == 0 ? chosen(slips, c.normal[d], unit) : unit;
          impulse[i][d] =
              row == 0 ? chosen(slips, chosen(loaded, inverse * c.impulse[d], c.normal[d]), unit) : unit;
        }
        amount[i] = dot(residual, motion[i]);
      }
    });
    for_each_pair([&](auto k) {
      const Lanes share_a = solving_[k].reduced_mass * moving_[first_field(k)].inverse_mass,
                  share_b = solving_[k].reduced_mass * moving_[second_field(k)].inverse_mass;
      for_each_pair([&](auto l) {
        constexpr int a = first_field(k), b = second_field(k), p = first_field(l), q = second_field(l);
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
    Lanes inverse[kCount];
    for (int p = 0; p < kCount; ++p) {
      const Lanes pivot = matrix[p][p];
      const IntLanes needed = magnitude(pivot) > constants::kRedundantPivot;
      if (bits_of(needed) == 0) {  // of no lane: nothing finite changes
        inverse[p] = Lanes{};
        continue;
      }
      inverse[p] = chosen(needed, quotient(one(), chosen(needed, pivot, one())), Lanes{});
      const auto take = [&](Lanes* from) {
        const Lanes own = from[p] * inverse[p];
        for (int i = 0; i < kCount; ++i)
          if (i != p) from[i] -= matrix[p][i] * own;
      };
      for (int j = p + 1; j < kCount; ++j) take(matrix[j]);
      take(amount);
    }
    IntLanes finite = going & some;
    for (int i = 0; i < kCount; ++i) amount[i] *= inverse[i];
    for_each_pair([&](auto pair) {
      for (int d = 0; d < Dim; ++d) {
        Lanes sum = amount[pair * kRows] * impulse[pair * kRows][d];
        for (int row = 1; row < kRows; ++row)
          sum += amount[pair * kRows + row] * impulse[pair * kRows + row][d];
        solving_[pair].change[d] = sum;
        finite &= magnitude(sum) < std::numeric_limits<double>::infinity();
      }
    });
    return finite;
  }

  /// Where every sticking contact sticks over this share of the step.
  IntLanes all_stick(Lanes share) const {
    IntLanes all = lanes_before(kLanes);
    for (const Solving& c : solving_) {
      const IntLanes sticks = c.status == kStick;
      if (bits_of(sticks) == 0) continue;
      VecLanes trial;
      for (int d = 0; d < Dim; ++d)
        trial[d] = c.impulse[d] + share * c.change[d] - c.reduced_mass * c.target_approach * c.normal[d];
      all &= ~sticks | (response(c, trial, nullptr) == kStick);
    }
    return all;
  }

  /// As NodeSolver::step_length.
  /// @param opens  result: the contact that ends the step by opening; negative: none
  Lanes step_length(IntLanes going, Lanes& opens) const {
    Lanes most = one();
    opens = broadcast<Lanes>(-1.0);
    for (int k = 0; k < kContacts; ++k) {
      const Solving& c = solving_[k];
      const Lanes now = dot(c.impulse, c.normal), change = dot(c.change, c.normal), end = now + change;
      const IntLanes turns =
          (c.status == kSlip) & ~c.bilateral & (((now > 0.0) & (end < 0.0)) | (~(now > 0.0) & (end > 0.0)));
      const Lanes share = larger(Lanes{}, quotient(-now, chosen(turns, change, one())));
      const IntLanes first = turns & (share < most);
      most = chosen(first, share, most);
      opens = chosen(first, broadcast<Lanes>(static_cast<double>(k)), opens);
    }
    const IntLanes keep = all_stick(most) | ~going;
    if (bits_of(~keep) == 0) return most;
    opens = chosen(keep, opens, broadcast<Lanes>(-1.0));
    Lanes share{}, step = 0.5 * most;
    for (int halved = 0; halved < constants::kStepHalvings; ++halved, step *= 0.5)
      share = chosen(all_stick(share + step), share + step, share);
    return chosen(keep, most, share);
  }

  int count_ = 0;
  Field fields_[kFields];
  Contact contacts_[kContacts];
  Moving moving_[kFields];
  Solving solving_[kContacts];
  Lanes largest_, noise_, most_;  ///< N² s²: the largest |J|², that of round-off, the bound on |J|²
};

}  // namespace mpmfast

#pragma GCC diagnostic pop
