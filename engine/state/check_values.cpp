#include "engine/state/check_values.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/errors.hpp"

namespace mpmfast {

void refuse_checkpoint(std::string_view why) {
  throw FileError(fmt::format("the checkpoint is none of its scene: {}", why));
}

void check_finite(std::string_view name, const double* values, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k)
    if (!std::isfinite(values[k])) refuse_checkpoint(fmt::format("{} holds {} at {}", name, values[k], k));
}

void check_not_negative(std::string_view name, double value) {
  if (!(value >= 0 && std::isfinite(value))) refuse_checkpoint(fmt::format("{} is {}", name, value));
}

}  // namespace mpmfast
