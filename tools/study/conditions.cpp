#include "conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpmfast {

namespace {

double constant(const std::optional<Formula>& formula, double otherwise, const Constants& constants) {
  return formula ? evaluate(formula->expression, constants) : otherwise;
}

/// How much of the way to the bound is used: by value over bound where the bound allows more than zero, the
/// other way round where it asks for more than zero.
double share_of_bound(double value, double bound, bool above) {
  const bool holds = above ? value <= bound : value >= bound;
  if (std::isinf(bound)) return 0;
  if (bound == 0) return holds ? 0 : kInfinity;
  const bool allows = above == (bound > 0);
  const double share = allows ? value / bound : value * bound > 0 ? bound / value : kInfinity;
  return std::max(0.0, share);
}

std::vector<double> judged_values(const Condition& condition, const Table& history,
                                  const Constants& constants) {
  std::vector<double> values = evaluate(condition.quantity->expression, history, constants);
  if (values.empty()) return values;
  const double first = condition.change ? values.front() : 0;
  double scale = 1;
  if (condition.over) {
    scale = 0;
    for (const double value : evaluate(condition.over->expression, history, constants))
      scale = std::max(scale, std::abs(value));
  }
  for (double& value : values) value = value == first ? 0 : (value - first) / scale;
  const std::vector<double>& time = *history.find("time_s");
  const double from = constant(condition.from, -kInfinity, constants);
  const double to = constant(condition.to, kInfinity, constants);
  std::vector<double> out;
  for (std::size_t k = condition.at_end ? values.size() - 1 : 0; k < values.size(); ++k)
    if (time[k] >= from && time[k] <= to) out.push_back(values[k]);
  return out;
}

}  // namespace

Judgement judge(const Condition& condition, const Table& history, const Constants& constants) {
  const double least = constant(condition.at_least, -kInfinity, constants);
  const double most = constant(condition.at_most, kInfinity, constants);
  const std::vector<double> values = judged_values(condition, history, constants);
  Judgement out{!values.empty(), 0, -1};
  for (const double value : values) {
    const bool inside = value >= least && value <= most;
    const double share =
        std::isnan(value) ? kInfinity
                          : std::max(share_of_bound(value, least, false), share_of_bound(value, most, true));
    out.holds = out.holds && inside;
    if (share <= out.share) continue;
    out.share = share;
    out.value = value;
  }
  return out;
}

std::string bounds_text(const Condition& condition) {
  if (condition.at_least && condition.at_most)
    return fmt::format("from {} to {}", condition.at_least->expression.text(),
                       condition.at_most->expression.text());
  return condition.at_least ? "at least " + condition.at_least->expression.text()
                            : "at most " + condition.at_most->expression.text();
}

}  // namespace mpmfast
