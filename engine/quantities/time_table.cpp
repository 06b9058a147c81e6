#include "engine/quantities/time_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/quantities/quantity.hpp"

namespace mpmfast {

std::string table_text(const TimeTable& table, Measure measure) {
  if (table.time.size() == 1 && table.time[0] == 0) return quantity_text(table.value[0], measure);
  return points_text(table.time, table.value, {Measure::time, measure});
}

std::string points_text(const std::vector<double>& along, const std::vector<double>& value,
                        const Points& form) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < along.size(); ++k)
    parts.push_back(
        fmt::format("[{}, {}]", quantity_text(along[k], form.along), quantity_text(value[k], form.value)));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

}  // namespace mpmfast
