#include "error_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpmfast {

namespace {

double crossing(const ErrorRule& rule, const Curve& curve) {
  const auto beyond = [&](std::size_t k) {  // > 0: passed
    return rule.below ? rule.threshold - curve.y[k] : curve.y[k] - rule.threshold;
  };
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (curve.x[k] < rule.from || curve.x[k] > rule.to || !(beyond(k) > 0)) continue;
    if (k == 0 || curve.x[k - 1] < rule.from || beyond(k - 1) > 0) return curve.x[k];
    const double share = beyond(k - 1) / (beyond(k - 1) - beyond(k));
    return curve.x[k - 1] + share * (curve.x[k] - curve.x[k - 1]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Measured of_one_value(const ErrorRule& rule, const Curve& curve, const Curve& reference) {
  Measured out;
  double expected = rule.expected;
  if (rule.compare == Compare::crossing) {
    out.value = crossing(rule, curve);
    if (std::isnan(expected)) expected = crossing(rule, reference);
  } else if (!curve.x.empty()) {
    out.value = curve.y.back();
    if (std::isnan(expected)) expected = value_at(reference, curve.x.back());
  }
  out.error = std::abs(out.value - expected);
  if (rule.relative != Relative::absolute) out.error /= std::abs(expected);
  return out;
}

}  // namespace

Measured measure_error(const ErrorRule& rule, const Curve& curve, const Curve& reference) {
  if (rule.compare == Compare::final_value || rule.compare == Compare::crossing)
    return of_one_value(rule, curve, reference);
  double largest = 0, squares = 0, scale = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < reference.x.size(); ++k)
    if (reference.x[k] >= rule.from && reference.x[k] <= rule.to)
      scale = std::max(scale, std::abs(reference.y[k]));
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (curve.x[k] < rule.from || curve.x[k] > rule.to) continue;
    const double expected = value_at(reference, curve.x[k]);
    if (std::isnan(expected)) continue;
    double difference = std::abs(curve.y[k] - expected);
    if (rule.relative == Relative::pointwise && difference > 0) difference /= std::abs(expected);
    if (rule.relative == Relative::maximum && difference > 0) difference /= scale;
    largest = difference > largest || std::isnan(difference) ? difference : largest;
    squares += difference * difference;
    ++count;
  }
  Measured out;
  if (count == 0) return out;
  out.error = rule.compare == Compare::maximum ? largest : std::sqrt(squares / static_cast<double>(count));
  return out;
}

}  // namespace mpmfast
