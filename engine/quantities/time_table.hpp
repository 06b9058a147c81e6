#pragma once

/// @file Quantities tabulated in time: values, integrals, text.

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/measure.hpp"

namespace mpmfast {

/// Linear between the points, constant before the first and after the last.
struct TimeTable {
  std::vector<double> time;   ///< s, strictly increasing, at least one entry
  std::vector<double> value;  ///< as many entries as `time`
};

/// "[[0 s, 0 m/s], [2 s, 1 m/s]]", as a scene writes it; a table that is one value at time zero is that
/// value.
std::string table_text(const TimeTable& table, Measure measure);

/// "[[0 m, 0 Pa], [0.001 m, 1000000 Pa]]".
std::string points_text(const std::vector<double>& along, const std::vector<double>& value,
                        const Points& form);

inline double value_at(const TimeTable& table, double t) {
  const auto& x = table.time;
  const auto& y = table.value;
  if (t <= x.front()) return y.front();
  for (std::size_t k = 1; k < x.size(); ++k)
    if (t <= x[k]) return y[k - 1] + (y[k] - y[k - 1]) * (t - x[k - 1]) / (x[k] - x[k - 1]);
  return y.back();
}

/// ∫ from 0 to t, exact for the piecewise linear function.
inline double integral_to(const TimeTable& table, double t) {
  const auto& x = table.time;
  const auto from_first = [&](double end) {  // ∫ from x_0 to end
    if (end <= x.front()) return (end - x.front()) * table.value.front();
    double sum = 0;
    for (std::size_t k = 1; k < x.size() && x[k - 1] < end; ++k) {
      const double upper = end < x[k] ? end : x[k];
      sum += 0.5 * (table.value[k - 1] + value_at(table, upper)) * (upper - x[k - 1]);
    }
    return end > x.back() ? sum + (end - x.back()) * table.value.back() : sum;
  };
  return from_first(t) - from_first(0);
}

/// The constant value with the same integral over [t, t + dt].
inline double mean_over(const TimeTable& table, double t, double dt) {
  if (table.time.size() == 1) return table.value.front();
  return dt > 0 ? (integral_to(table, t + dt) - integral_to(table, t)) / dt : value_at(table, t);
}

/// Largest |value|.
inline double largest(const TimeTable& table) {
  double m{};
  for (double v : table.value) m = v > m ? v : -v > m ? -v : m;
  return m;
}

}  // namespace mpmfast
