#include "frame_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/output/particle_access.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

namespace {

// Shown by means of their own: who a particle is, and its shape.
constexpr std::array<std::string_view, 6> kNoFields{"id",     "body",         "material",
                                                    "volume", "domain_share", kDomainAngle};
// A page that must leave fields out keeps these.
constexpr std::array<std::string_view, 5> kFirst{"pressure", "von_mises", "speed", "plastic_strain",
                                                 "temperature"};

std::string unit_of(const std::string& array) {
  if (array == "stress" || array == "von_mises" || array == "pressure") return "Pa";
  for (const QuantityInfo& info : kQuantityTable)
    if (info.name == array) return info.unit == "-" ? "" : std::string(info.unit);
  return "";
}

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

double determinant(const double* f) {
  return f[0] * (f[4] * f[8] - f[5] * f[7]) - f[1] * (f[3] * f[8] - f[5] * f[6]) +
         f[2] * (f[3] * f[7] - f[4] * f[6]);
}

}  // namespace

const std::vector<double>& FrameFile::values(const VtuArray& array) const {
  const auto known = unpacked_.find(array.name);
  if (known != unpacked_.end()) return known->second;
  return unpacked_.emplace(array.name, reader_.values(array)).first->second;
}

std::vector<double> FrameField::values(const FrameFile& file) const {
  const VtuArray* found = file.reader().find(array);
  std::vector<double> out(file.size(), std::numeric_limits<double>::quiet_NaN());
  if (found == nullptr || component >= found->components) return out;
  const std::vector<double>& all = file.values(*found);
  const std::size_t n = found->components;
  const VtuArray* const split = kind == Kind::domain ? file.reader().find("domain_share") : nullptr;
  const double* const share = split != nullptr ? file.values(*split).data() : nullptr;
  const VtuArray* const turned = kind == Kind::domain ? file.reader().find(kDomainAngle) : nullptr;
  const double* const angle = turned != nullptr ? file.values(*turned).data() : nullptr;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double* tuple = all.data() + n * i;
    if (kind == Kind::component || kind == Kind::domain) out[i] = tuple[component];
    if (angle != nullptr && component % 3 < 2) {
      const double* row = tuple + component - component % 3;
      out[i] = component % 3 == 0 ? std::cos(angle[i]) * row[0] + std::sin(angle[i]) * row[1]
                                  : std::cos(angle[i]) * row[1] - std::sin(angle[i]) * row[0];
    }
    if (share != nullptr) out[i] *= share[3 * i + component % 3];
    if (kind == Kind::magnitude) out[i] = std::hypot(tuple[0], tuple[1], tuple[2]);
    if (kind == Kind::determinant) out[i] = determinant(tuple);
  }
  if (const VtuArray* body = file.reader().find("body"); body != nullptr && !without.empty()) {
    const std::vector<double>& bodies = file.values(*body);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (without.count(static_cast<std::uint32_t>(bodies[i])) > 0)
        out[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

std::vector<FrameField> frame_fields(const VtuReader& file, int dimension, const std::string& picture,
                                     const std::set<std::uint32_t>& rigid) {
  using Kind = FrameField::Kind;
  std::vector<FrameField> fields;
  for (const VtuArray& array : file.point_data()) {
    const std::string unit = unit_of(array.name);
    if (std::find(kNoFields.begin(), kNoFields.end(), array.name) != kNoFields.end()) continue;
    if (array.name == "deformation_gradient" && array.components == 9) {
      if (!file.find("volume_ratio"))
        fields.push_back({"volume_ratio", "", array.name, 0, Kind::determinant});
      continue;
    }
    if (array.name == "velocity" && array.components == 3)
      fields.push_back({"speed", unit, array.name, 0, Kind::magnitude});
    for (std::size_t k = 0; k < array.components; ++k) {
      const std::string part = k < array.names.size() ? lower_case(array.names[k]) : std::to_string(k);
      // In the plane there is nothing along z but the stress across it.
      if (dimension == 2 && array.components > 1 && part.find('z') != std::string::npos && part != "zz")
        continue;
      fields.push_back({array.components > 1 ? array.name + "_" + part : array.name, unit, array.name, k,
                        Kind::component});
    }
  }
  for (FrameField& field : fields)
    if (field.array != "velocity") field.without = rigid;
  const auto rank = [&](const FrameField& field) {
    if (field.name == picture) return std::ptrdiff_t{-1};
    return std::find(kFirst.begin(), kFirst.end(), field.name) - kFirst.begin();
  };
  std::stable_sort(fields.begin(), fields.end(),
                   [&](const FrameField& a, const FrameField& b) { return rank(a) < rank(b); });
  return fields;
}

}  // namespace mpmfast
