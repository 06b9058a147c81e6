#include "engine/output/read_frame.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>

#include <array>

#include "engine/errors.hpp"
#include "engine/output/particle_access.hpp"

namespace mpmfast {

namespace {

/// Evolving state that files hold under the names of the columns.
constexpr std::array kState{Quantity::volume_ratio, Quantity::dissipated_energy, Quantity::internal_energy,
                            Quantity::plastic_strain, Quantity::temperature};

std::string name_of(Quantity quantity) {
  return std::string(kQuantityTable[static_cast<std::size_t>(quantity)].name);
}

bool stretches(const Scene& scene) {
  return scene.space == Space::plane_stress || scene.space == Space::axisymmetric;
}

template <int Dim>
std::vector<Quantity> columns_of(const VtuReader& file, const Scene& scene) {
  std::vector<Quantity> out{Quantity::position};
  if (file.find("velocity")) out.push_back(Quantity::velocity);
  if (file.find("deformation_gradient")) {
    out.push_back(Quantity::deformation_gradient);
    if (Dim == 2 && stretches(scene)) out.push_back(Quantity::out_of_plane_stretch);
  }
  if (file.find("stress")) out.push_back(Quantity::kirchhoff_stress);
  if (file.find("volume")) out.push_back(Quantity::initial_volume);
  if (file.find("domain_share")) out.push_back(Quantity::domain_share);
  for (const Quantity quantity : kState)
    if (file.find(name_of(quantity))) out.push_back(quantity);
  return out;
}

/// Array `name` to columns, component `source[k]` of its `width` to column k.
template <int Dim, std::size_t N>
void fill(const VtuReader& file, const std::string& name, std::size_t width, Quantity quantity,
          const std::array<std::size_t, N>& source, Particles<Dim>& out) {
  if (!out.has(quantity)) return;
  const std::vector<double> values = name == "Points" ? file.points() : file.values(*file.find(name));
  if (values.size() != width * out.size())
    throw FileError(fmt::format("{} has {} values", name, values.size()));
  for (std::size_t k = 0; k < N; ++k) {
    double* column = out.column(quantity, static_cast<int>(k));
    for (std::size_t p = 0; p < out.size(); ++p) column[p] = values[width * p + source[k]];
  }
}

/// Files hold F of the body; the state holds that of domains, which may have lain at an angle at the start.
template <int Dim>
void turn_domains(const VtuReader& file, Particles<Dim>& out) {
  const VtuArray* found = file.find(kDomainAngle);
  if (!found || !out.has(Quantity::deformation_gradient)) return;
  const std::vector<double> angle = file.values(*found);
  if (angle.size() != out.size())
    throw FileError(fmt::format("{} has {} values", kDomainAngle, angle.size()));
  for (int row = 0; row < Dim; ++row) {
    double* along = out.column(Quantity::deformation_gradient, Dim * row);
    double* across = out.column(Quantity::deformation_gradient, Dim * row + 1);
    for (std::size_t p = 0; p < out.size(); ++p) {
      const double cosine = std::cos(angle[p]), sine = std::sin(angle[p]), x = along[p], y = across[p];
      along[p] = cosine * x + sine * y;
      across[p] = cosine * y - sine * x;
    }
  }
}

template <int Dim>
void fill_columns(const VtuReader& file, Particles<Dim>& out) {
  if constexpr (Dim == 2) {
    constexpr std::array<std::size_t, 2> axes{0, 1};
    fill(file, "Points", 3, Quantity::position, axes, out);
    fill(file, "velocity", 3, Quantity::velocity, axes, out);
    fill(file, "domain_share", 3, Quantity::domain_share, axes, out);
    fill(file, "deformation_gradient", 9, Quantity::deformation_gradient,
         std::array<std::size_t, 4>{0, 1, 3, 4}, out);
    fill(file, "deformation_gradient", 9, Quantity::out_of_plane_stretch, std::array<std::size_t, 1>{8}, out);
    fill(file, "stress", 6, Quantity::kirchhoff_stress, std::array<std::size_t, 4>{0, 1, 2, 3}, out);
  } else {
    constexpr std::array<std::size_t, 3> axes{0, 1, 2};
    fill(file, "Points", 3, Quantity::position, axes, out);
    fill(file, "velocity", 3, Quantity::velocity, axes, out);
    fill(file, "domain_share", 3, Quantity::domain_share, axes, out);
    fill(file, "deformation_gradient", 9, Quantity::deformation_gradient,
         std::array<std::size_t, 9>{0, 1, 2, 3, 4, 5, 6, 7, 8}, out);
    fill(file, "stress", 6, Quantity::kirchhoff_stress, std::array<std::size_t, 6>{0, 1, 2, 3, 4, 5}, out);
  }
  constexpr std::array<std::size_t, 1> alone{0};
  fill(file, "volume", 1, Quantity::initial_volume, alone, out);
  for (const Quantity quantity : kState) fill(file, name_of(quantity), 1, quantity, alone, out);
}

}  // namespace

template <int Dim>
Particles<Dim> read_frame(const VtuReader& file, const std::filesystem::path& path, const Scene& scene) try {
  Particles<Dim> out;
  out.allocate(file.size(), columns_of<Dim>(file, scene));
  fill_columns(file, out);
  turn_domains(file, out);
  const std::vector<std::uint32_t> id = file.read<std::uint32_t>("id");
  const std::vector<std::uint16_t> body = file.read<std::uint16_t>("body");
  if (id.size() != out.size() || body.size() != out.size())
    throw FileError("a particle has no number or body");
  for (std::size_t p = 0; p < out.size(); ++p) {
    if (body[p] >= scene.bodies.size())
      throw FileError(fmt::format("body {} of {}", body[p], scene.bodies.size()));
    out.id()[p] = id[p];
    out.body()[p] = body[p];
    // Files hold what users ask for, Cauchy stress and present volume.
    const double j = volume_ratio(out, p);
    if (out.has(Quantity::initial_volume)) out.column(Quantity::initial_volume)[p] /= j;
    if (out.has(Quantity::kirchhoff_stress))
      for (int k = 0; k < kSymmetric<Dim>; ++k) out.column(Quantity::kirchhoff_stress, k)[p] *= j;
  }
  return out;
} catch (const FileError& error) {
  throw FileError(fmt::format("{} does not fit the scene beside it: {}", path.string(), error.what()));
}

Polylines read_lines(const VtuReader& file, const std::filesystem::path& path) {
  if (!file.find_of_file(kLineLengths)) return {};
  const std::vector<double> points = file.read_of_file<double>(kLinePoints);
  const std::vector<std::uint32_t> lengths = file.read_of_file<std::uint32_t>(kLineLengths);
  const std::uint64_t all = std::accumulate(lengths.begin(), lengths.end(), std::uint64_t{0});
  const auto finite = [](double x) { return std::isfinite(x); };
  if (file.find_of_file(kLinePoints)->components != 3 || points.size() != 3 * all ||
      !std::all_of(points.begin(), points.end(), finite))
    throw FileError(
        fmt::format("cannot read {}: its cracks have other points than they say, or such that are no numbers",
                    path.string()));
  Polylines lines;
  std::size_t at = 0;
  for (const std::uint32_t length : lengths) {
    auto& line = lines.emplace_back();
    for (std::uint32_t k = 0; k < length; ++k, at += 3) line.emplace_back(points[at], points[at + 1]);
  }
  return lines;
}

template Particles<2> read_frame(const VtuReader&, const std::filesystem::path&, const Scene&);
template Particles<3> read_frame(const VtuReader&, const std::filesystem::path&, const Scene&);

}  // namespace mpmfast
