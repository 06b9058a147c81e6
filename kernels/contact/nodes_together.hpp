#pragma once

/// @file Contacts of kLanes nodes at once that each have as many fields: what together.hpp does for one node,
/// a lane for each.

#include <limits>
#include <type_traits>
#include <utility>

#include "kernels/contact/laws.hpp"
#include "kernels/contact/set_rule.hpp"
#include "kernels/contact/together.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/lanes.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

/// Nodes of kFields fields whose contacts are of the step's one set and have friction by Coulomb's law or
/// none.
///
/// The steps are those of ContactsTogether, contacts in the order of their fields: sweeps, and leaps between
/// them, each lane until its own node has settled. A lane does the same whatever stands in the others. Nodes
/// that do not settle within a few sweeps are left to ContactsTogether, from the start: one in a hundred of
/// pressed grains in the plane, most of random nodes of four and more fields in space.
template <int Dim, int kFields>
class NodesTogether {
 public:
  static constexpr int kContacts = kFields * (kFields - 1) / 2;

  int count() const { return count_; }
  bool is_full() const { return count_ == kLanes; }
  bool is_empty() const { return count_ == 0; }
  /// A contact's place: that of its two fields.
  static constexpr int place_of(int a, int b) {
    const int low = a < b ? a : b, high = a < b ? b : a;
    return low * kFields - low * (low + 1) / 2 + high - low - 1;
  }

  /// Takes a node, in the next lane, as yet without contacts.
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
  /// As FieldContact. No two of a node have the same fields.
  void add_contact(int lane, int a, int b, const Vec<Dim>& normal, double reduced, double closing,
                   const SetRule<Dim>& rule, const Coulomb& law) {
    Contact& c = contacts_[place_of(a, b)];
    for (int d = 0; d < Dim; ++d) c.normal[d][lane] = a < b ? normal[d] : -normal[d];
    c.reduced[lane] = reduced;
    c.closing[lane] = closing;
    c.friction[lane] = rule.friction ? law.friction : 0;
    c.static_friction[lane] = rule.friction ? law.static_friction : 0;
    c.exists[lane] = 1;
    c.acts[lane] = rule.acts;
    c.both_ways[lane] = rule.both_ways;
    c.holds_slip[lane] = rule.holds_slip;
  }
  bool has(int lane, int a, int b) const { return contacts_[place_of(a, b)].exists[lane] != 0; }
  /// Found: Δp_a, N s.
  Vec<Dim> impulse(int lane, int a, int b) const {
    const Contact& c = contacts_[place_of(a, b)];
    Vec<Dim> out;
    for (int d = 0; d < Dim; ++d) out[d] = a < b ? c.impulse[d][lane] : -c.impulse[d][lane];
    return out;
  }
  bool sticks(int lane, int a, int b) const { return contacts_[place_of(a, b)].hinders[lane] == kSlip; }

  /// Finds the impulses of all nodes, from none, and forgets them with the next node.
  /// @param may_stick  not of these nodes but of all that are solved so: sums of fewer terms round
  /// differently
  /// @return a bit for each that settled to 1e-9 of its largest impulse
  unsigned solve(bool may_stick) {
    if (is_empty()) return 0;
    fill_up();
    load();
    find_scales();
    IntLanes active = lanes_before(count_), settled{};
    for (int done = 0; done < kSweeps; ++done) {
      const IntLanes ends = sweep(active) & is_bounded();
      settled |= active & ends;
      active &= ~ends & is_bounded();
      if (bits_of(active) == 0) break;
      if (done + 1 < kSweeps) leap(active, may_stick);
    }
    store();
    count_ = 0;
    return bits_of(settled & is_finite());
  }

 private:
  static constexpr int kSweeps = 8;
  static constexpr double kLeast = 1e-290;                         ///< N s: less than this has no inverse
  static constexpr double kNothing = 0, kApproach = 1, kSlip = 2;  ///< as Hinders
  using Column = double[kLanes];
  using VecLanes = Lanes[Dim];

  struct Field {
    Column velocity[Dim], inverse_mass;
  };
  /// In columns, to be filled lane by lane.
  struct Contact {
    Column normal[Dim], reduced, closing, friction, static_friction, exists, acts, both_ways, holds_slip;
    Column impulse[Dim], hinders;
  };
  /// While they are solved.
  struct Moving {
    VecLanes velocity;
    Lanes inverse_mass;
  };
  struct Solving {
    VecLanes normal, impulse, change;
    Lanes reduced, closing, friction, static_friction, hinders;
    IntLanes acts, both_ways, holds_slip;
  };
  static constexpr int first_of(int place) {
    int a = 0;
    while (place >= kFields - 1 - a) place -= kFields - 1 - a++;
    return a;
  }
  static constexpr int second_of(int place) {
    int a = 0;
    while (place >= kFields - 1 - a) place -= kFields - 1 - a++;
    return a + 1 + place;
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
      to.reduced = there(from.reduced);
      to.closing = there(from.closing);
      to.friction = there(from.friction);
      to.static_friction = there(from.static_friction);
      to.acts = exists & is_set(from.acts);
      to.both_ways = exists & is_set(from.both_ways);
      to.holds_slip = exists & is_set(from.holds_slip);
      to.hinders = Lanes{};
    }
  }

  void store() {
    for (int k = 0; k < kContacts; ++k) {
      for (int d = 0; d < Dim; ++d) store_lanes(contacts_[k].impulse[d], solving_[k].impulse[d]);
      store_lanes(contacts_[k].hinders, solving_[k].hinders);
    }
  }

  /// As ContactsTogether::find_scales, in squares.
  void find_scales() {
    constexpr double kRoundOff = 1e-14, kShare = 30;
    Lanes fastest{}, heaviest{}, motion{}, least = moving_[0].inverse_mass;
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
      motion += chosen(moves, quotient(square_root(dot(apart, apart)), chosen(moves, f.inverse_mass, one())),
                       Lanes{});
    }
    for (const Solving& c : solving_) heaviest = larger(heaviest, c.reduced);
    noise_ = kRoundOff * kRoundOff * heaviest * heaviest * fastest;
    most_ = kShare * kShare * motion * motion;
  }
  static Lanes one() { return broadcast<Lanes>(1.0); }
  IntLanes is_bounded() const { return largest_ <= most_; }
  /// The larger of a number and what is none may be the number.
  IntLanes is_finite() const {
    Lanes sum{};
    for (const Solving& c : solving_) sum += dot(c.impulse, c.impulse);
    return sum < std::numeric_limits<double>::infinity();
  }

  /// The demand of a contact for which sticking would need `stick`: SetRule::demand with Coulomb's law.
  /// @param impulse  found: what it demands, or null
  /// @return what it hinders then
  static Lanes demand(const Solving& c, const VecLanes& stick, VecLanes* impulse) {
    const Lanes along = dot(stick, c.normal), end = along + c.reduced * c.closing;
    VecLanes tangential;
    for (int d = 0; d < Dim; ++d) tangential[d] = stick[d] - along * c.normal[d];
    const Lanes needed = larger(square_root(dot(tangential, tangential)), broadcast<Lanes>(kLeast));
    const Lanes presses = larger(-end, Lanes{}), limit = c.friction * presses;
    const IntLanes none = ~c.acts | ((end > 0.0) & ~c.both_ways);
    const IntLanes sticks =
        c.holds_slip | (needed <= c.static_friction * presses) | ((needed <= limit) & (limit > 0.0));
    if (impulse) {
      const Lanes share = chosen(sticks, one(), quotient(limit, needed));
      for (int d = 0; d < Dim; ++d)
        (*impulse)[d] = chosen(none, Lanes{}, end * c.normal[d] + share * tangential[d]);
    }
    return chosen(none, broadcast<Lanes>(kNothing),
                  chosen(sticks, broadcast<Lanes>(kSlip), broadcast<Lanes>(kApproach)));
  }

  template <int kPlace>
  void add(const VecLanes& impulse) {
    Moving &a = moving_[first_of(kPlace)], &b = moving_[second_of(kPlace)];
    for (int d = 0; d < Dim; ++d) {
      solving_[kPlace].impulse[d] += impulse[d];
      a.velocity[d] += a.inverse_mass * impulse[d];
      b.velocity[d] -= b.inverse_mass * impulse[d];
    }
  }
  template <int kPlace>
  void slip(VecLanes& out) const {
    for (int d = 0; d < Dim; ++d)
      out[d] = moving_[second_of(kPlace)].velocity[d] - moving_[first_of(kPlace)].velocity[d];
  }
  template <class F>
  static void for_each_place(const F& f) {
    [&]<int... K>(std::integer_sequence<int, K...>) { (f(std::integral_constant<int, K>()), ...); }
    (std::make_integer_sequence<int, kContacts>());
  }

  /// @return where no impulse changed by more than 1e-9 of the largest, or by round-off alone
  IntLanes sweep(IntLanes active) {
    Lanes change{};
    largest_ = Lanes{};
    for_each_place([&](auto place) {
      Solving& c = solving_[place];
      VecLanes stick, impulse, step;
      slip<place>(stick);
      for (int d = 0; d < Dim; ++d) stick[d] = c.impulse[d] + c.reduced * stick[d];
      c.hinders = chosen(active, demand(c, stick, &impulse), c.hinders);
      for (int d = 0; d < Dim; ++d) step[d] = chosen(active, impulse[d] - c.impulse[d], Lanes{});
      add<place>(step);
      largest_ = larger(largest_, dot(c.impulse, c.impulse));
      change = larger(change, dot(step, step));
    });
    return change <= larger(1e-18 * largest_, noise_);
  }

  /// Goes where no hindered motion is left, in the lanes `going`; contacts that part on the way are left
  /// behind.
  void leap(IntLanes going, bool may_stick) {
    for (int parted = 0; parted <= kContacts; ++parted) {
      going &= may_stick ? find_changes<Dim>(going) : find_changes<1>(going);
      if (bits_of(going) == 0) return;
      Lanes parts;
      const Lanes share = share_of_leap(going, parts);
      for_each_place([&](auto place) {
        Solving& c = solving_[place];
        VecLanes step;
        for (int d = 0; d < Dim; ++d) step[d] = chosen(going, share * c.change[d], Lanes{});
        add<place>(step);
        c.hinders = chosen(going & (parts == static_cast<double>(place)), Lanes{}, c.hinders);
      });
      going &= parts >= 0.0;
    }
  }

  /// The changes of impulses that end all hindered motion: Hindrances, kWays of them for each contact. A
  /// sliding one has the first alone.
  /// @return where there are some, and finite
  template <int kWays>
  IntLanes find_changes(IntLanes going) {
    constexpr double kRedundant = 1e-11;
    constexpr int kCount = kContacts * kWays;
    VecLanes motion[kCount], impulse[kCount];
    Lanes matrix[kCount][kCount], amount[kCount];  // [column][equation]
    IntLanes some{};
    for_each_place([&](auto place) {
      const Solving& c = solving_[place];
      const IntLanes slips = going & (c.hinders == kSlip), slides = going & (c.hinders == kApproach);
      some |= slips | slides;
      const Lanes along = dot(c.impulse, c.normal);
      const IntLanes loaded = magnitude(along) > kLeast;
      const Lanes inverse = quotient(one(), chosen(loaded, along, one()));
      VecLanes left;
      slip<place>(left);
      for (int d = 0; d < Dim; ++d) left[d] = c.reduced * (left[d] + c.closing * c.normal[d]);
      for (int way = 0; way < kWays; ++way) {
        const int i = place * kWays + way;
        for (int d = 0; d < Dim; ++d) {
          const Lanes unit = chosen(slips, broadcast<Lanes>(d == way ? 1.0 : 0.0), Lanes{});
          motion[i][d] = way == 0 ? chosen(slides, c.normal[d], unit) : unit;
          impulse[i][d] =
              way == 0 ? chosen(slides, chosen(loaded, inverse * c.impulse[d], c.normal[d]), unit) : unit;
        }
        amount[i] = dot(left, motion[i]);
      }
    });
    for_each_place([&](auto k) {
      const Lanes share_a = solving_[k].reduced * moving_[first_of(k)].inverse_mass,
                  share_b = solving_[k].reduced * moving_[second_of(k)].inverse_mass;
      for_each_place([&](auto l) {
        constexpr int a = first_of(k), b = second_of(k), p = first_of(l), q = second_of(l);
        constexpr int sign_a = (a == p) - (a == q), sign_b = (b == q) - (b == p);
        for (int j = l * kWays; j < (l + 1) * kWays; ++j)
          for (int i = k * kWays; i < (k + 1) * kWays; ++i) {
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
      const IntLanes needed = magnitude(pivot) > kRedundant;
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
    for_each_place([&](auto place) {
      for (int d = 0; d < Dim; ++d) {
        Lanes sum = amount[place * kWays] * impulse[place * kWays][d];
        for (int way = 1; way < kWays; ++way)
          sum += amount[place * kWays + way] * impulse[place * kWays + way][d];
        solving_[place].change[d] = sum;
        finite &= magnitude(sum) < std::numeric_limits<double>::infinity();
      }
    });
    return finite;
  }

  /// Where every stuck contact remains so over this share of the leap.
  IntLanes all_stick(Lanes share) const {
    IntLanes all = lanes_before(kLanes);
    for (const Solving& c : solving_) {
      const IntLanes slips = c.hinders == kSlip;
      if (bits_of(slips) == 0) continue;
      VecLanes stick;
      for (int d = 0; d < Dim; ++d)
        stick[d] = c.impulse[d] + share * c.change[d] - c.reduced * c.closing * c.normal[d];
      all &= ~slips | (demand(c, stick, nullptr) == kSlip);
    }
    return all;
  }

  /// As ContactsTogether::share_of_leap.
  /// @param parts  the place of the contact that stops it by parting; negative: none
  Lanes share_of_leap(IntLanes going, Lanes& parts) const {
    Lanes most = one();
    parts = broadcast<Lanes>(-1.0);
    for (int k = 0; k < kContacts; ++k) {
      const Solving& c = solving_[k];
      const Lanes now = dot(c.impulse, c.normal), change = dot(c.change, c.normal), end = now + change;
      const IntLanes turns = (c.hinders == kApproach) & ~c.both_ways &
                             (((now > 0.0) & (end < 0.0)) | (~(now > 0.0) & (end > 0.0)));
      const Lanes share = larger(Lanes{}, quotient(-now, chosen(turns, change, one())));
      const IntLanes first = turns & (share < most);
      most = chosen(first, share, most);
      parts = chosen(first, broadcast<Lanes>(static_cast<double>(k)), parts);
    }
    const IntLanes keep = all_stick(most) | ~going;
    if (bits_of(~keep) == 0) return most;
    parts = chosen(keep, parts, broadcast<Lanes>(-1.0));
    Lanes share{}, step = 0.5 * most;
    for (int halved = 0; halved < 6; ++halved, step *= 0.5)
      share = chosen(all_stick(share + step), share + step, share);
    return chosen(keep, most, share);
  }

  int count_ = 0;
  Field fields_[kFields];
  Contact contacts_[kContacts];
  Moving moving_[kFields];
  Solving solving_[kContacts];
  Lanes largest_, noise_, most_;  ///< N² s²: the largest |J|², what round-off makes of it, what it may be
};

}  // namespace mpmfast

#pragma GCC diagnostic pop
