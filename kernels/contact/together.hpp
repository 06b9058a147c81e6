#pragma once

/// @file All contacts of a node where three or more fields meet, at once: impulses such that each contact
/// obeys its law with the velocities that all of them leave.

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// A field of the node; a rigid one has no inverse mass.
template <int Dim>
struct MovingField {
  Vec<Dim> velocity;    ///< m/s, with the impulses so far
  double inverse_mass;  ///< 1/kg
};

/// A contact between the node's fields a and b that may have an impulse.
template <int Dim>
struct FieldContact {
  int a, b;
  Vec<Dim> normal;                      ///< unit, from a to b
  double reduced;                       ///< 1/(1/m_a + 1/m_b), kg
  Vec<Dim> stick = Vec<Dim>::Zero();    ///< Δp_a that sticking would need while the others stay, N s
  Vec<Dim> impulse = Vec<Dim>::Zero();  ///< found: Δp_a, N s; b takes −Δp_a
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

  /// Finds the impulses, from the present ones.
  /// @param law  law(k, d): the impulse of contact k where sticking would need d
  /// @return whether they settled to 1e-9 of the largest; if not, they are as they are, less what would do
  /// work
  template <class Law>
  bool solve(const Law& law) {
    constexpr int kSweeps = 100, kLeaps = 10;  // where kinds still change then, leaps seldom help
    for (int done = 0; done < kSweeps; ++done) {
      if (sweep(law) || contacts.size() == 1) return true;
      if (done < kLeaps || done % kLeaps == 0) leap(law);
    }
    take_back_work();
    for (FieldContact<Dim>& c : contacts) c.stick = c.impulse + c.reduced * slip(c);
    return false;
  }

 private:
  static constexpr int kMost = 32;  ///< hindrances; with more, elimination costs more than sweeps

  /// Changes of contacts' impulses along given directions, and the motions that they are to end. Those of a
  /// contact follow each other.
  struct Hindrances {
    int count;
    int contact[kMost];
    double a[kMost], b[kMost];  ///< fields of the contact
    double impulse[Dim][kMost];
    Vec<Dim> motion[kMost];

    void push(int of, const FieldContact<Dim>& c, const Vec<Dim>& along, const Vec<Dim>& hindered) {
      contact[count] = of;
      a[count] = c.a;
      b[count] = c.b;
      for (int d = 0; d < Dim; ++d) impulse[d][count] = along[d];
      motion[count++] = hindered;
    }
  };

  MovingField<Dim>& field(int k) { return fields[static_cast<std::size_t>(k)]; }
  Vec<Dim> slip(const FieldContact<Dim>& c) { return field(c.b).velocity - field(c.a).velocity; }

  void add(FieldContact<Dim>& c, const Vec<Dim>& impulse) {
    field(c.a).velocity += field(c.a).inverse_mass * impulse;
    field(c.b).velocity -= field(c.b).inverse_mass * impulse;
  }

  /// @return whether no impulse changed by more than 1e-9 of the largest
  template <class Law>
  bool sweep(const Law& law) {
    double largest = 0, change = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      FieldContact<Dim>& c = contacts[k];
      c.stick = c.impulse + c.reduced * slip(c);
      const Vec<Dim> impulse = law(k, c.stick), step = impulse - c.impulse;
      add(c, step);
      c.impulse = impulse;
      largest = std::max(largest, impulse.squaredNorm());
      change = std::max(change, step.squaredNorm());
    }
    return change <= 1e-18 * largest;
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

  /// What each contact hinders by its present kind: stuck, all slip; sliding, with J = J_n (n + s) and s to
  /// stay, the approach; parted, nothing.
  /// @return false if that is nothing at all or too much
  bool find_hindrances() {
    hindrances_.count = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      const int at = static_cast<int>(k);
      if (c.impulse.isZero(0)) continue;
      if (hindrances_.count + Dim > kMost) return false;
      if (c.impulse == c.stick)
        for (int d = 0; d < Dim; ++d) hindrances_.push(at, c, Vec<Dim>::Unit(d), Vec<Dim>::Unit(d));
      else if (const double normal = c.impulse.dot(c.normal); normal != 0)  // squares may underflow
        hindrances_.push(at, c, c.impulse / normal, c.normal);
    }
    return hindrances_.count > 0;
  }

  /// The equations Σ_j m_k c_kl (motion_i · impulse_j) x_j = m_k slip_k · motion_i, where hindrance i is of
  /// contact k and j of l, and c_kl is how v_a − v_b of k changes for an impulse of l: the diagonal is one.
  void set_equations(int width) {
    const Hindrances& h = hindrances_;
    const Lanes zero{}, one = broadcast<Lanes>(1.0);
    for (int i = 0; i < h.count; ++i) {
      const FieldContact<Dim>& c = contacts[static_cast<std::size_t>(h.contact[i])];
      const double of_a = c.reduced * field(c.a).inverse_mass, of_b = c.reduced * field(c.b).inverse_mass;
      for (int j = 0; j < width; j += kLanes) {
        const Lanes a = load_lanes(h.a + j), b = load_lanes(h.b + j);
        const Lanes share = of_a * ((a == h.a[i] ? one : zero) - (b == h.a[i] ? one : zero)) +
                            of_b * ((b == h.b[i] ? one : zero) - (a == h.b[i] ? one : zero));
        Lanes along = h.motion[i][0] * load_lanes(h.impulse[0] + j);
        for (int d = 1; d < Dim; ++d) along += h.motion[i][d] * load_lanes(h.impulse[d] + j);
        store_lanes(matrix_ + i * width + j, share * along);
      }
      right_[i] = c.reduced * slip(c).dot(h.motion[i]);
    }
  }

  /// Goes where no hindered motion is left, or as far as all contacts remain what they are and just beyond.
  template <class Law>
  void leap(const Law& law) {
    if (!find_hindrances()) return;
    const int n = hindrances_.count, width = padded_count(n);
    set_equations(width);
    eliminate(n, width);
    changes_.assign(contacts.size(), Vec<Dim>::Zero());
    for (int i = 0; i < n; ++i) {
      if (!std::isfinite(right_[i])) return;
      for (int d = 0; d < Dim; ++d)
        changes_[static_cast<std::size_t>(hindrances_.contact[i])][d] +=
            right_[i] * hindrances_.impulse[d][i];
    }
    const double share = share_of_leap(law);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      contacts[k].impulse += share * changes_[k];
      add(contacts[k], share * changes_[k]);
    }
  }

  /// Does every contact remain what it is over this share of the leap?
  template <class Law>
  bool kinds_remain(const Law& law, double share) {
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const FieldContact<Dim>& c = contacts[k];
      if (c.impulse.isZero(0)) continue;
      const Vec<Dim> impulse = c.impulse + share * changes_[k];
      const bool stuck = c.impulse == c.stick;
      if (stuck ? law(k, impulse) != impulse : impulse.dot(c.normal) * c.impulse.dot(c.normal) < 0)
        return false;
    }
    return true;
  }

  /// All of the leap, or what leads just beyond the first change of a contact's kind.
  template <class Law>
  double share_of_leap(const Law& law) {
    if (kinds_remain(law, 1)) return 1;
    double below = 0, above = 1;
    for (int halving = 0; halving < 6; ++halving) {
      const double middle = 0.5 * (below + above);
      (kinds_remain(law, middle) ? below : above) = middle;
    }
    return above;
  }

  /// Gauss–Jordan; the solution takes the place of the right-hand side. Three fields that stick to each other
  /// have more impulses than they need: those that follow from the ones before stay as they are.
  void eliminate(int n, int width) {
    constexpr double kRedundant = 1e-11;
    double inverse[kMost];
    for (int pivot = 0; pivot < n; ++pivot) {
      double* own = matrix_ + pivot * width;
      const bool redundant = !(std::abs(own[pivot]) > kRedundant);
      inverse[pivot] = redundant ? 0 : 1 / own[pivot];
      for (int i = 0; i < n; ++i) {
        double* row = matrix_ + i * width;
        const double factor = row[pivot] * inverse[pivot];
        if (i == pivot || factor == 0) continue;
        for (int j = 0; j < width; j += kLanes)
          store_lanes(row + j, load_lanes(row + j) - factor * load_lanes(own + j));
        right_[i] -= factor * right_[pivot];
      }
    }
    for (int i = 0; i < n; ++i) right_[i] *= inverse[i];
  }

  Hindrances hindrances_{};
  std::vector<Vec<Dim>> changes_;  ///< of the contacts' impulses, or the fields' momenta
  double matrix_[kMost * kMost], right_[kMost];
};

}  // namespace mpmfast
