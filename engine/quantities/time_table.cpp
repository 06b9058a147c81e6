#include "engine/quantities/time_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/quantities/quantity.hpp"

namespace mpmfast {

std::string table_text(const TimeTable& table, Measure measure) {
  if (table.time.size() == 1 && table.time[0] == 0) return quantity_text(table.value[0], measure);
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < table.time.size(); ++k) {
    parts.push_back(fmt::format("[{}, {}]", quantity_text(table.time[k], Measure::time),
                                quantity_text(table.value[k], measure)));
  }
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

}  // namespace mpmfast
