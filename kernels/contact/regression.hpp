#pragma once

/// @file The contact normal by logistic regression (N20 §3.1 and its appendix): the plane that most probably
/// parts the two classes of a cloud.

#include <cmath>
#include <limits>

#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// When the iteration ends. The defaults are N20's.
struct RegressionRule {
  double tolerance = 1e-5;  ///< on 1 − n'·n of two successive normals
  int max_iterations = 15;
};

template <int Dim>
struct Regression {
  enum class Outcome {
    converged,          ///< two successive normals agree
    unconverged,        ///< the best plane seen within the allowed iterations
    centroid_fallback,  ///< no usable plane: from the centroid of a to that of b
    failed              ///< a class is empty or the centroids coincide: the normal is zero
  };
  Vec<Dim> normal = Vec<Dim>::Zero();  ///< unit, from a to b
  int iterations = 0;                  ///< logistic steps after the linear start
  Outcome outcome = Outcome::failed;
};

namespace detail {

constexpr int packed_size(int n) { return n * (n + 1) / 2; }
/// Place of (row, column), column ≤ row, in a packed lower triangle.
constexpr int packed(int row, int column) { return row * (row + 1) / 2 + column; }

/// Solves A x = b by LDLᵀ for a symmetric positive A, packed; A is overwritten, b becomes x.
/// @return false if a pivot falls below 1e-12 of its diagonal entry (a test that no scaling of the unknowns
/// changes)
template <int N>
inline bool solve_symmetric(double (&a)[packed_size(N)], double (&b)[N]) {
  double inverse_pivot[N];
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) {
    double scaled[N];  // L_jk D_k
    const double diagonal = a[packed(j, j)];
    double pivot = diagonal;
#pragma GCC unroll 16
    for (int k = 0; k < j; ++k) {
      scaled[k] = a[packed(j, k)];
      a[packed(j, k)] *= inverse_pivot[k];
      pivot -= scaled[k] * a[packed(j, k)];
    }
    if (!(pivot > 1e-12 * diagonal)) return false;  // also for NaN
    inverse_pivot[j] = 1.0 / pivot;
#pragma GCC unroll 16
    for (int i = j + 1; i < N; ++i)
#pragma GCC unroll 16
      for (int k = 0; k < j; ++k) a[packed(i, j)] -= a[packed(i, k)] * a[packed(j, k)];
  }
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j)
#pragma GCC unroll 16
    for (int k = 0; k < j; ++k) b[j] -= a[packed(j, k)] * b[k];
#pragma GCC unroll 16
  for (int j = N - 1; j >= 0; --j) {
    b[j] *= inverse_pivot[j];
#pragma GCC unroll 16
    for (int i = j + 1; i < N; ++i) b[j] -= a[packed(i, j)] * b[i];
  }
  return true;
}

/// The sum over the lanes of each of kLanes vectors, in the lanes of one: neighbouring lanes of two vectors
/// are added into one, until one is left. A third of the instructions of as many sums one by one.
inline Lanes sums_of(Lanes (&v)[kLanes]) {
  IntLanes even, odd;
#pragma GCC unroll 16
  for (int i = 0; i < kLanes; ++i) {
    even[i] = 2 * i;
    odd[i] = 2 * i + 1;
  }
#pragma GCC unroll 16
  for (int half = kLanes / 2; half > 0; half /= 2)
#pragma GCC unroll 16
    for (int i = 0; i < half; ++i)
      v[i] = __builtin_shuffle(v[2 * i], v[2 * i + 1], even) + __builtin_shuffle(v[2 * i], v[2 * i + 1], odd);
  return v[0];
}

/// What one pass over the cloud sums up.
template <int N>
struct NormalEquations {
  double matrix[packed_size(N)];  ///< JᵀJ, packed
  double right[N];                ///< Jᵀ(c − f)
  double error;                   ///< Σ (f − c)², plus a constant
};

/// One pass over the cloud: for each point its weight ψ and residual r, given as functions of s = c ξ·φ, and
/// the sums of ψ² ηηᵀ, ψ r η and r² with η = c (ξ, 1).
///
/// f is odd and ψ is even, so that with c = ±1: c − f(ξ·φ) = c (1 − f(s)), ψ(ξ·φ) = ψ(s). Working with η in
/// place of ξ needs no c elsewhere and drops the padding (η = 0) by itself; it adds a constant to the error
/// only.
template <int Dim, class Evaluate>
inline NormalEquations<Dim + 1> sum_cloud(const CloudView<Dim>& cloud, const double (&phi)[Dim + 1],
                                          Evaluate evaluate) {
  constexpr int N = Dim + 1, kError = packed_size(N) + N, kSums = padded_count(kError + 1);
  Lanes sum[kSums] = {};
  for (int k = 0; k < cloud.count; k += kLanes) {
    Lanes eta[N];
    eta[Dim] = load_lanes(cloud.side + k);
    Lanes s = eta[Dim] * phi[Dim];
#pragma GCC unroll 16
    for (int d = 0; d < Dim; ++d) {
      eta[d] = eta[Dim] * load_lanes(cloud.xi[d] + k);
      s += eta[d] * phi[d];
    }
    Lanes weight, residual;
    evaluate(s, weight, residual);
    sum[kError] += residual * residual;
#pragma GCC unroll 16
    for (int i = 0; i < N; ++i) {
      const Lanes row = weight * eta[i];
      sum[packed_size(N) + i] += residual * row;
#pragma GCC unroll 16
      for (int j = 0; j <= i; ++j) sum[packed(i, j)] += row * (weight * eta[j]);
    }
  }
  alignas(64) double total[kSums];
#pragma GCC unroll 16
  for (int e = 0; e < kSums; e += kLanes)
    store_lanes(total + e, sums_of(reinterpret_cast<Lanes(&)[kLanes]>(sum[e])));
  NormalEquations<N> sums;
  std::memcpy(sums.matrix, total, sizeof sums.matrix);
  std::memcpy(sums.right, total + packed_size(N), sizeof sums.right);
  sums.error = total[kError];
  return sums;
}

/// ψ and 1 − f of the logistic function: with e = exp(−s) and q = 1/(1 + e), f = 2q − 1, thus 1 − f = 2 e q
/// and ψ = 2 e q² (N20 Eq. 53). exponential() clamps its argument, so that nothing overflows.
struct Logistic {
  void operator()(Lanes s, Lanes& weight, Lanes& residual) const {
    const Lanes e = exponential(-s), q = 1.0 / (1.0 + e);
    residual = 2.0 * e * q;
    weight = residual * q;
  }
};

/// Linear regression: ψ = 1, f = 0.
struct Linear {
  void operator()(Lanes, Lanes& weight, Lanes& residual) const { weight = residual = broadcast<Lanes>(1.0); }
};

template <int Dim>
inline double squared_length(const double (&v)[Dim + 1]) {
  double sum = 0;
  for (int d = 0; d < Dim; ++d) sum += v[d] * v[d];
  return sum;
}

/// Unit vector along the first Dim entries; their squared length must be normal and positive.
template <int Dim>
inline Vec<Dim> direction(const double (&v)[Dim + 1]) {
  const double scale = 1.0 / std::sqrt(squared_length<Dim>(v));
  Vec<Dim> n;
  for (int d = 0; d < Dim; ++d) n[d] = scale * v[d];
  return n;
}

/// Is 1 − a·b of the two directions below the tolerance?
template <int Dim>
inline bool agree(const double (&a)[Dim + 1], const double (&b)[Dim + 1], double tolerance) {
  double dot = 0;
  for (int d = 0; d < Dim; ++d) dot += a[d] * b[d];
  return dot > (1.0 - tolerance) * std::sqrt(squared_length<Dim>(a) * squared_length<Dim>(b));
}

/// Squared lengths between which a vector has a direction (false for NaN).
inline bool has_direction(double squared) { return squared > 1e-200 && squared < 1e200; }

/// From the centroid of a to that of b. The sums of the linear start hold the classes' sizes and first
/// moments: Σ c² = n_b + n_a, Σ c = n_b − n_a, Σ c² ξ and Σ c ξ.
template <int Dim>
struct Centroids {
  double difference[Dim + 1] = {};
  bool both = false;   ///< neither class is empty
  bool apart = false;  ///< further than a billionth of the cloud's size: not by round-off alone

  explicit Centroids(const NormalEquations<Dim + 1>& linear) {
    const double total = linear.matrix[packed(Dim, Dim)], excess = linear.right[Dim];
    const double n_a = 0.5 * (total - excess), n_b = 0.5 * (total + excess);
    both = n_a > 0.5 && n_b > 0.5;
    if (!both) return;
    double spread = 0;
    for (int d = 0; d < Dim; ++d) {
      const double sum = linear.matrix[packed(Dim, d)], b_less_a = linear.right[d];
      difference[d] = 0.5 * ((sum + b_less_a) / n_b - (sum - b_less_a) / n_a);
      spread += linear.matrix[packed(d, d)];
    }
    const double squared = squared_length<Dim>(difference);
    apart = has_direction(squared) && squared > 1e-18 * spread / total;
  }
};

/// Logistic steps from `plane`, which becomes the best plane seen. A step that raises the objective is
/// halved.
/// @return how many passes over the cloud it took; @param converged two successive normals agree
template <int Dim>
inline int minimise(const CloudView<Dim>& cloud, double penalty, const RegressionRule& rule,
                    double (&plane)[Dim + 1], bool& converged) {
  constexpr int N = Dim + 1;
  double phi[N], best_objective = std::numeric_limits<double>::infinity();
  std::memcpy(phi, plane, sizeof phi);
  converged = false;
  for (int iteration = 1; iteration <= rule.max_iterations; ++iteration) {
    NormalEquations<N> sums = sum_cloud<Dim>(cloud, phi, Logistic{});
    const double objective = sums.error + penalty * squared_length<Dim>(phi);
    if (!(objective <= best_objective)) {
      for (int i = 0; i < N; ++i) phi[i] = 0.5 * (phi[i] + plane[i]);
      continue;
    }
    best_objective = objective;
    std::memcpy(plane, phi, sizeof phi);
    for (int d = 0; d < Dim; ++d) {
      sums.matrix[packed(d, d)] += penalty;
      sums.right[d] -= penalty * phi[d];
    }
    if (!solve_symmetric<N>(sums.matrix, sums.right)) return iteration;
    for (int i = 0; i < N; ++i) phi[i] += sums.right[i];
    converged = agree<Dim>(phi, plane, rule.tolerance);
    if (converged) {
      std::memcpy(plane, phi, sizeof phi);
      return iteration;
    }
  }
  return rule.max_iterations;
}

}  // namespace detail

/// The normal of one contact node: minimises Σ (f(ξ·φ) − c)² + λ Σ_j φ_j² over the plane φ (λ not on the
/// offset), with f(s) = 2/(1 + e^−s) − 1 (N20 Eq. 20), by φ ← φ + (JᵀJ + Λ)⁻¹(Jᵀ(c − f) − Λφ) (Eq. 21) from
/// twice the linear regression. Beyond the paper: a step that raises the objective is halved back towards the
/// best plane seen; a singular first matrix, or a normal against the centroids, falls back to the centroids'
/// difference.
/// @param penalty λ in cell units
template <int Dim>
inline Regression<Dim> fit_normal(const CloudView<Dim>& cloud, double penalty,
                                  const RegressionRule& rule = {}) {
  using Outcome = typename Regression<Dim>::Outcome;
  constexpr int N = Dim + 1;
  Regression<Dim> result;
  double plane[N] = {};
  detail::NormalEquations<N> linear = detail::sum_cloud<Dim>(cloud, plane, detail::Linear{});
  const detail::Centroids<Dim> centroids(linear);
  if (!centroids.both) return result;

  for (int d = 0; d < Dim; ++d) linear.matrix[detail::packed(d, d)] += penalty;
  if (detail::solve_symmetric<N>(linear.matrix, linear.right)) {
    for (int i = 0; i < N; ++i) plane[i] = 2.0 * linear.right[i];
    bool converged;
    result.iterations = detail::minimise<Dim>(cloud, penalty, rule, plane, converged);
    double forward = 0;
    for (int d = 0; d < Dim; ++d) forward += plane[d] * centroids.difference[d];
    if (detail::has_direction(detail::squared_length<Dim>(plane)) && forward >= 0) {
      result.normal = detail::direction<Dim>(plane);
      result.outcome = converged ? Outcome::converged : Outcome::unconverged;
      return result;
    }
  }
  if (centroids.apart) {
    result.normal = detail::direction<Dim>(centroids.difference);
    result.outcome = Outcome::centroid_fallback;
  }
  return result;
}

}  // namespace mpmfast
