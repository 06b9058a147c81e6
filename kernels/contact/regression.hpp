#pragma once

/// @file The contact normal by regression (N20 §3.1 and its appendix, NN §3.4): the plane that most probably
/// parts the two classes of a cloud.

#include <cmath>
#include <limits>

#include "kernels/constants.hpp"
#include "kernels/contact/cloud.hpp"
#include "kernels/dimension.hpp"
#include "kernels/simd/math.hpp"

namespace mpmfast {

/// What is minimised over the plane φ, with s = ξ·φ and m = (c + 1)/2.
enum class Fit {
  least_squares,  ///< Σ (f(s) − c)², f = 2/(1 + e^−s) − 1 (N20 Eq. 20)
  likelihood,     ///< Σ log(1 + e^−s) + (1 − m) s (NN Eq. 3.36), by reweighted least squares
  linear,         ///< Σ (s − c)² (NN Eq. 3.17): one solution, no iteration
};

/// What to fit and when to end. The defaults are N20's.
struct RegressionRule {
  Fit fit = Fit::least_squares;
  double penalty = 1e-7;    ///< λ of the normal's components, cell units
  double offset_penalty{};  ///< λ of the offset (NN §3.4.5)
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
  double plane[Dim + 1] = {};          ///< φ, to start from in the next step; zero after a fallback
  int iterations{};                    ///< logistic steps after the start
  Outcome outcome = Outcome::failed;
};

namespace detail {

constexpr int packed_size(int n) { return n * (n + 1) / 2; }
/// Place of (row, column), column ≤ row, in a packed lower triangle.
constexpr int packed(int row, int column) { return row * (row + 1) / 2 + column; }

/// Solves A x = b by LDLᵀ for a symmetric positive A, packed; A is overwritten, b becomes x.
/// @return false if a pivot falls below kLeastFitPivot of its diagonal entry (a test that no scaling of the
/// unknowns changes)
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
    if (!(pivot > constants::kLeastFitPivot * diagonal)) return false;  // also for NaN
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
#pragma GCC unroll 16
  for (int half = kLanes / 2; half > 0; half /= 2)
#pragma GCC unroll 16
    for (int i = 0; i < half; ++i) v[i] = add_neighbours(v[2 * i], v[2 * i + 1]);
  return v[0];
}

/// What one pass over the cloud sums up.
template <int N>
struct NormalEquations {
  double matrix[packed_size(N)];  ///< JᵀJ, packed
  double right[N];                ///< Jᵀ(c − f)
  double error;                   ///< Σ (f − c)² or Σ log(1 + e^−s), plus a constant
};

/// One pass over the cloud: for each point its weight ψ, residual r and error, given as functions of
/// s = c ξ·φ, and the sums of ψ² ηηᵀ, ψ r η and of the errors, with η = c (ξ, 1).
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
    Lanes weight, residual, error;
    evaluate(s, weight, residual, error);
    sum[kError] += error;
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
struct LeastSquares {
  static constexpr double kPenaltyShare = 1;  ///< objective: error + share · λ φ²
  void operator()(Lanes s, Lanes& weight, Lanes& residual, Lanes& error) const {
    const Lanes e = exponential(-s), q = 1.0 / (1.0 + e);
    residual = 2.0 * e * q;
    weight = residual * q;
    error = residual * residual;
  }
};

/// NN Eq. 3.38 to 3.42: the matrix has f(1 − f) = ψ² and the vector 1 − f = ψ r. With h = exp(−s/2) these are
/// ψ = h/(1 + h²) and r = h.
struct Likelihood {
  static constexpr double kPenaltyShare = 0.5;
  void operator()(Lanes s, Lanes& weight, Lanes& residual, Lanes& error) const {
    const Lanes h = exponential(-0.5 * s), sum = 1.0 + h * h;
    residual = h;
    weight = h / sum;
    error = logarithm(sum);
  }
};

/// Linear regression: ψ = 1, f = 0.
struct Linear {
  void operator()(Lanes, Lanes& weight, Lanes& residual, Lanes& error) const {
    weight = residual = error = broadcast<Lanes>(1.0);
  }
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
inline bool has_direction(double squared) {
  return squared > constants::kLeastSquaredLength && squared < constants::kMostSquaredLength;
}

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
    apart = has_direction(squared) && squared > constants::kCoincidentCentroids * spread / total;
  }
};

/// Logistic steps from `plane`, which becomes the best plane seen. A step that raises the objective is
/// halved.
/// @return how many passes over the cloud it took; @param converged two successive normals agree
template <int Dim, class Objective>
inline int minimise(const CloudView<Dim>& cloud, const RegressionRule& rule, double (&plane)[Dim + 1],
                    bool& converged) {
  constexpr int N = Dim + 1;
  double phi[N], best_objective = std::numeric_limits<double>::infinity();
  std::memcpy(phi, plane, sizeof phi);
  converged = false;
  for (int iteration = 1; iteration <= rule.max_iterations; ++iteration) {
    NormalEquations<N> sums = sum_cloud<Dim>(cloud, phi, Objective{});
    const double objective =
        sums.error + Objective::kPenaltyShare * (rule.penalty * squared_length<Dim>(phi) +
                                                 rule.offset_penalty * phi[Dim] * phi[Dim]);
    if (!(objective <= best_objective)) {
      for (int i = 0; i < N; ++i) phi[i] = 0.5 * (phi[i] + plane[i]);
      continue;
    }
    best_objective = objective;
    std::memcpy(plane, phi, sizeof phi);
    for (int i = 0; i < N; ++i) {
      const double penalty = i < Dim ? rule.penalty : rule.offset_penalty;
      sums.matrix[packed(i, i)] += penalty;
      sums.right[i] -= penalty * phi[i];
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

/// The linear regression. @return false if its matrix is singular
template <int Dim>
inline bool solve_linear(NormalEquations<Dim + 1>& linear, const RegressionRule& rule,
                         double (&plane)[Dim + 1]) {
  for (int d = 0; d < Dim; ++d) linear.matrix[packed(d, d)] += rule.penalty;
  linear.matrix[packed(Dim, Dim)] += rule.offset_penalty;
  if (!solve_symmetric<Dim + 1>(linear.matrix, linear.right)) return false;
  std::memcpy(plane, linear.right, sizeof plane);
  return true;
}

/// The plane with its normal as the result. @return false if it has no direction
template <int Dim>
inline bool accept(const double (&plane)[Dim + 1], bool converged, Regression<Dim>& result) {
  if (!has_direction(squared_length<Dim>(plane))) return false;
  std::memcpy(result.plane, plane, sizeof plane);
  result.normal = direction<Dim>(plane);
  result.outcome = converged ? Regression<Dim>::Outcome::converged : Regression<Dim>::Outcome::unconverged;
  return true;
}

template <int Dim>
inline int minimise(const CloudView<Dim>& cloud, const RegressionRule& rule, double (&plane)[Dim + 1],
                    bool& converged) {
  return rule.fit == Fit::likelihood ? minimise<Dim, Likelihood>(cloud, rule, plane, converged)
                                     : minimise<Dim, LeastSquares>(cloud, rule, plane, converged);
}

}  // namespace detail

/// The normal of one contact node: minimises the rule's objective + Σ_j λ_j φ_j² over the plane φ, by
/// φ ← φ + (JᵀJ + Λ)⁻¹(Jᵀ(c − f) − Λφ) (N20 Eq. 21) from twice the linear regression. Beyond the paper: a
/// step that raises the objective is halved back towards the best plane seen; a singular first matrix, or a
/// normal against the centroids, falls back to the centroids' difference.
/// @param start  plane to begin with in place of the linear regression, which is then done only if the
///               iteration from there does not converge; null or without direction: none
template <int Dim>
inline Regression<Dim> fit_normal(const CloudView<Dim>& cloud, const RegressionRule& rule = {},
                                  const double* start = nullptr) {
  using Outcome = typename Regression<Dim>::Outcome;
  constexpr int N = Dim + 1;
  Regression<Dim> result;
  double plane[N] = {};
  if (start && rule.fit != Fit::linear) {
    std::memcpy(plane, start, sizeof plane);
    bool converged = false;
    if (detail::has_direction(detail::squared_length<Dim>(plane)))
      result.iterations = detail::minimise<Dim>(cloud, rule, plane, converged);
    if (converged && detail::accept<Dim>(plane, true, result)) return result;
    std::memset(plane, 0, sizeof plane);
  }
  detail::NormalEquations<N> linear = detail::sum_cloud<Dim>(cloud, plane, detail::Linear{});
  const detail::Centroids<Dim> centroids(linear);
  if (!centroids.both) return result;
  if (detail::solve_linear<Dim>(linear, rule, plane)) {
    bool converged = rule.fit == Fit::linear;
    if (!converged) {
      for (double& v : plane) v *= 2.0;
      result.iterations += detail::minimise<Dim>(cloud, rule, plane, converged);
    }
    double forward = 0;
    for (int d = 0; d < Dim; ++d) forward += plane[d] * centroids.difference[d];
    if (forward >= 0 && detail::accept<Dim>(plane, converged, result)) return result;
  }
  if (centroids.apart) {
    result.normal = detail::direction<Dim>(centroids.difference);
    result.outcome = Outcome::centroid_fallback;
  }
  return result;
}

}  // namespace mpmfast
