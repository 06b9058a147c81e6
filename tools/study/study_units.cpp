#include "study_units.hpp"

#include <vector>

#include "engine/output/shown_units.hpp"
#include "handy_units.hpp"

namespace mpmfast {

std::string shown_unit(const StudyRuns& runs, const std::string& unit) {
  std::vector<bool> per_metre;
  for (const StudyRun& run : runs.variants) per_metre.push_back(is_per_metre(run.scene));
  return shown_unit(per_metre, unit);
}

bool looks_for_value(const ErrorSpec& spec) {
  return spec.rule.compare == Compare::final_value || spec.rule.compare == Compare::crossing;
}

std::string measured_unit(const StudyRuns& runs, const ErrorSpec& spec) {
  const bool crossing = spec.rule.compare == Compare::crossing;
  return shown_unit(runs, unit_of((crossing ? spec.x : spec.quantity)->expression));
}

std::string axis_label(const StudyRuns& runs, const Expression& expression) {
  const std::string unit = unit_of(expression), name = name_beside(expression, unit);
  const std::string shown = shown_unit(runs, unit);
  return shown.empty() ? name : name + " (" + shown + ")";
}

}  // namespace mpmfast
