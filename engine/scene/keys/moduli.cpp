#include "engine/scene/keys/moduli.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "engine/scene/keys/keys.hpp"
#include "kernels/materials/parameters.hpp"

namespace mpmfast {

namespace {

void report_moduli(Keys& map, const char* volumetric) {
  std::string got;
  int many = 0;
  for (const char* key : {volumetric, "shear", "young", "poisson"}) {
    if (!map.stated(key)) continue;
    got += (got.empty() ? ", but has only " : " and ") + std::string(key);
    ++many;
  }
  map.report(fmt::format("needs either {} and shear or young and poisson{}", volumetric,
                         many > 2      ? ", not more"
                         : got.empty() ? ", but has none"
                                       : got));
}

/// `volumetric` (bulk or lambda) and shear, or young and poisson in their place.
void describe_moduli(Keys& map, const char* volumetric, double& modulus, double& shear) {
  const bool lame = std::string_view(volumetric) == "lambda";
  const auto choice = map.one_of({{volumetric, "shear"}, {"young", "poisson"}});
  if (choice.none()) return report_moduli(map, volumetric);
  if (choice.takes(0)) {
    map.need(volumetric, lame ? "First Lamé constant." : kBulkDescription, modulus,
             Number{Measure::pressure, lame ? kNotNegative : kPositive});
    map.need("shear", kShearDescription, shear, kModulus);
  }
  if (!choice.takes(1)) return;
  double young = 0, poisson = 0;
  const bool first = map.need("young", kYoungDescription, young, kModulus);
  const bool second = map.need("poisson", kPoissonDescription, poisson, kPoisson);
  if (!map.reads() || !first || !second) return;
  shear = young / (2 * (1 + poisson));
  modulus = lame ? 2 * shear * poisson / (1 - 2 * poisson) : young / (3 * (1 - 2 * poisson));
  const bool holds = shear > 0 && (lame ? modulus >= 0 : modulus > 0);
  if (!holds || !std::isfinite(shear) || !std::isfinite(modulus))
    map.report(fmt::format("young and poisson give {} = {} Pa and shear = {} Pa: out of range", volumetric,
                           modulus, shear));
}

}  // namespace

void describe_bulk_and_shear(Keys& map, double& bulk, double& shear) {
  describe_moduli(map, "bulk", bulk, shear);
}

void describe_lambda_and_shear(Keys& map, double& lambda, double& shear) {
  describe_moduli(map, "lambda", lambda, shear);
}

}  // namespace mpmfast
