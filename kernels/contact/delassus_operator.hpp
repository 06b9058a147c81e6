#pragma once

/// @file The Delassus operator of the closed contacts of a node: what relative velocities impulses leave, and
/// the impulses that leave none.

#include <algorithm>
#include <cmath>

#include "kernels/constants.hpp"
#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/lanes.hpp"

namespace mpmfast {

/// Row i is one direction of relative velocity that contact k constrains, with a direction along which the
/// impulse of k may change. The changes x_j along these directions follow from
///   Σ_j m_k c_kl (motion_i · impulse_j) x_j = residual_i,
/// where j belongs to contact l, and c_kl is the change of v_a − v_b at k by a unit impulse at l. residual_i
/// is the relative velocity that remains along motion_i, times the reduced mass m_k. So the diagonal is one.
template <int Dim>
class DelassusOperator {
 public:
  static constexpr int kMost = 64;  ///< with more, elimination costs more than sweeps

  /// One direction that a contact constrains.
  struct Row {
    int contact, a, b;         ///< the contact's number, and its fields
    double share_a, share_b;   ///< m_k/m_a, m_k/m_b
    Vec<Dim> impulse, motion;  ///< directions
    double residual;           ///< N s
  };

  void clear() { count_ = 0; }
  int count() const { return count_; }
  bool is_full() const { return count_ + Dim > kMost; }
  void push(const Row& row) {
    contact_[count_] = row.contact;
    a_[count_] = row.a;
    b_[count_] = row.b;
    share_a_[count_] = row.share_a;
    share_b_[count_] = row.share_b;
    for (int d = 0; d < Dim; ++d) {
      impulse_[d][count_] = row.impulse[d];
      motion_[d][count_] = row.motion[d];
    }
    amount_[count_++] = row.residual;
  }

  /// Finds x. Three fields that stick to each other have more impulses than equations: a row that follows
  /// from those before gets none.
  /// @return whether all x are finite
  bool solve() {
    if (2 * count_ <= kFew)
      solve_few<kFew / 2>();
    else if (count_ <= kFew)
      solve_few<kFew>();
    else if (count_ <= 2 * kFew)
      solve_many<2 * kFewVectors>();
    else
      solve_many<0>();
    return std::all_of(amount_, amount_ + count_, [](double x) { return std::isfinite(x); });
  }

  /// Calls f(contact, change of its impulse) for each row.
  template <class F>
  void for_each_change(const F& f) const {
    for (int i = 0; i < count_; ++i) {
      Vec<Dim> change;
      for (int d = 0; d < Dim; ++d) change[d] = amount_[i] * impulse_[d][i];
      f(contact_[i], change);
    }
  }

 private:
  static constexpr int kFew = 8;                ///< so many equations stay in registers
  static constexpr int kSpaced = kMost + kFew;  ///< columns of a power of two apart share lines of the cache
  static constexpr int kFewVectors = (kFew + kLanes - 1) / kLanes, kMostVectors = kMost / kLanes;

  /// The coefficients of x_j in the equations `from` to `from` + kLanes.
  Lanes coefficients(int j, int from) const {
    const Lanes zero{}, one = broadcast<Lanes>(1.0), a = load_lanes(a_ + from), b = load_lanes(b_ + from);
    const Lanes share =
        load_lanes(share_a_ + from) * ((a == a_[j] ? one : zero) - (a == b_[j] ? one : zero)) +
        load_lanes(share_b_ + from) * ((b == b_[j] ? one : zero) - (b == a_[j] ? one : zero));
    Lanes along = load_lanes(motion_[0] + from) * impulse_[0][j];
    for (int d = 1; d < Dim; ++d) along += load_lanes(motion_[d] + from) * impulse_[d][j];
    return share * along;
  }

  static double inverse_of(double pivot) {
    return std::abs(pivot) > constants::kRedundantPivot ? 1 / pivot : 0;
  }

  /// Gauss–Jordan in registers.
  template <int kEquations>
  void solve_few() {
    constexpr int kVectors = (kEquations + kLanes - 1) / kLanes;
    Lanes column[kEquations][kVectors], right[kVectors], inverse[kVectors]{};
    for (int v = 0; v < kVectors; ++v) {
      right[v] = load_lanes(amount_ + v * kLanes);
      for (int j = 0; j < kEquations; ++j) column[j][v] = coefficients(j, v * kLanes);
    }
#pragma GCC unroll 8
    for (int p = 0; p < kEquations; ++p) {
      if (p >= count_) break;
      const int at = p / kLanes, lane = p % kLanes;
      const double pivot = inverse_of(column[p][at][lane]);
      inverse[at][lane] = pivot;
      Lanes factor[kVectors];
      for (int v = 0; v < kVectors; ++v) factor[v] = column[p][v] * pivot;
      factor[at][lane] = 0;
#pragma GCC unroll 8
      for (int j = p + 1; j < kEquations; ++j) {
        const double own = column[j][at][lane];
        for (int v = 0; v < kVectors; ++v) column[j][v] -= factor[v] * own;
      }
      const double own = right[at][lane];
      for (int v = 0; v < kVectors; ++v) right[v] -= factor[v] * own;
    }
    for (int v = 0; v < kVectors; ++v) store_lanes(amount_ + v * kLanes, right[v] * inverse[v]);
  }

  /// @tparam kVectors  of a column; 0: as many as it takes
  template <int kVectors>
  void solve_many() {
    const int vectors = kVectors > 0 ? kVectors : padded_count(count_) / kLanes;
    double inverse[kMost];
    for (int j = 0; j < count_; ++j)
      for (int v = 0; v < vectors; ++v) store_lanes(matrix_[j] + v * kLanes, coefficients(j, v * kLanes));
    for (int p = 0; p < count_; ++p) {
      inverse[p] = inverse_of(matrix_[p][p]);
      if (inverse[p] == 0) continue;
      Lanes factor[kVectors > 0 ? kVectors : kMostVectors];
      matrix_[p][p] = 0;
      for (int v = 0; v < vectors; ++v) factor[v] = load_lanes(matrix_[p] + v * kLanes) * inverse[p];
      const auto take = [&](double* from) {
        const double own = from[p];
        for (int v = 0; v < vectors; ++v)
          store_lanes(from + v * kLanes, load_lanes(from + v * kLanes) - factor[v] * own);
      };
      for (int j = p + 1; j < count_; ++j) take(matrix_[j]);
      take(amount_);
    }
    for (int i = 0; i < count_; ++i) amount_[i] *= inverse[i];
  }

  int count_ = 0;
  // Equations beyond the last fill the last vector. They hold what earlier ones left, and change no other.
  int contact_[kMost];
  double a_[kSpaced]{}, b_[kSpaced]{}, share_a_[kSpaced]{}, share_b_[kSpaced]{};
  double impulse_[Dim][kSpaced]{}, motion_[Dim][kSpaced]{};
  double amount_[kSpaced]{};     ///< the residual, then x
  double matrix_[kMost][kMost];  ///< [column][equation]
};

}  // namespace mpmfast
