#include "study_units.hpp"

#include <algorithm>

#include "engine/output/shown_units.hpp"
#include "handy_units.hpp"

namespace mpmfast {

std::string shown_unit(const StudyRuns& runs, const std::string& unit) {
  const bool metre = std::all_of(runs.variants.begin(), runs.variants.end(),
                                 [](const StudyRun& run) { return is_per_metre(run.scene); });
  return metre ? unit_per_metre(unit) : unit;
}

bool looks_for_value(const ErrorSpec& spec) {
  return spec.rule.compare == Compare::final_value || spec.rule.compare == Compare::crossing;
}

std::string measured_unit(const StudyRuns& runs, const ErrorSpec& spec) {
  const bool place = spec.rule.compare == Compare::crossing;
  return shown_unit(runs, unit_of((place ? spec.x : spec.quantity)->expression));
}

std::string axis_label(const StudyRuns& runs, const Expression& expression) {
  const std::string unit = unit_of(expression), name = name_beside(expression, unit);
  return unit.empty() ? name : name + " (" + shown_unit(runs, unit) + ")";
}

}  // namespace mpmfast
