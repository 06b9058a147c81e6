#include "engine/output/shown_units.hpp"

#include <algorithm>
#include <array>

namespace mpmfast {

bool is_per_metre(const Scene& scene) {
  const bool plane = scene.space == Space::plane_strain || scene.space == Space::plane_stress;
  return plane && scene.thickness == 1;
}

std::string unit_per_metre(const std::string& unit) {
  constexpr std::array<const char*, 4> kGrow{"J", "N", "kg", "N m"};
  if (unit == "kg m/s") return unit + " per m";  // a second stroke would be read as a product
  return std::find(kGrow.begin(), kGrow.end(), unit) == kGrow.end() ? unit : unit + "/m";
}

std::string shown_unit(const std::vector<bool>& per_metre, const std::string& unit) {
  const auto are_all = [&](bool metre) {
    return std::find(per_metre.begin(), per_metre.end(), !metre) == per_metre.end();
  };
  const std::string of_metre = unit_per_metre(unit);
  if (of_metre == unit || are_all(false)) return unit;
  return are_all(true) ? of_metre : "";
}

}  // namespace mpmfast
