#include "engine/run/describe_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "engine/geometry/shapes.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/shown_units.hpp"

namespace mpmfast {

namespace {

/// "coulomb, friction 0.3"
std::string law_text(const SurfaceLaw& law) {
  std::string text = std::visit([](const auto& one) { return std::string(one.kKeyword); }, law.acts);
  if (std::holds_alternative<Coulomb>(law.acts)) text += fmt::format(", friction {:g}", law.friction);
  return text;
}

/// "x 3 to 9, y 2 to 8 mm": in the unit of the pictures.
std::string extents_text(const Scene& scene, const Shape& shape) {
  const Bounds box = bounds(shape);
  const DisplayUnit unit = length_unit(scene);
  std::string text;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.dimension()); ++k)
    text += fmt::format("{}{} {:.6g} to {:.6g}", k > 0 ? ", " : "", "xyz"[k], box.lower[k] / unit.in_si,
                        box.upper[k] / unit.in_si);
  return text + " " + unit.name;
}

std::string mass_text(const Scene& scene, double mass) {
  return fmt::format("{:.4g} {}", mass, shown_unit(scene, "kg"));
}

}  // namespace

std::vector<std::string> folded(std::vector<std::string> lines, bool all) {
  constexpr std::size_t kMost = 12, kShown = 8;
  if (all || lines.size() <= kMost) return lines;
  const std::size_t more = lines.size() - kShown;
  lines.resize(kShown);
  lines.push_back(fmt::format("… and {} more (all with --verbose)", more));
  return lines;
}

template <int Dim>
std::vector<std::string> body_lines(const Scene& scene, const Particles<Dim>& particles) {
  std::vector<std::size_t> count(scene.bodies.size());
  std::vector<double> mass(scene.bodies.size());
  for (std::size_t p = 0; p < particles.size(); ++p) {
    ++count[particles.body()[p]];
    mass[particles.body()[p]] += particles.column(Quantity::mass)[p];
  }
  std::size_t widest = 0;
  for (const BodySpec& body : scene.bodies) widest = std::max(widest, body.name.size());
  std::vector<std::string> lines;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    const MaterialSpec& material = scene.materials[static_cast<std::size_t>(body.material)];
    const std::string law =
        std::visit([](const auto& one) { return std::string(one.kModel); }, material.model);
    const std::string made = law == material.name ? law : fmt::format("{} ({})", material.name, law);
    const std::string weight = is_rigid(scene, body) ? "" : ", " + mass_text(scene, mass[b]);
    lines.push_back(fmt::format("{:<{}}  {}: {} particle{}{}; {}", body.name, widest, made, count[b],
                                count[b] == 1 ? "" : "s", weight, extents_text(scene, body.shape)));
  }
  return lines;
}

std::vector<std::string> pair_lines(const Scene& scene) {
  std::vector<std::string> lines;
  for (const PairLawSpec& pair : scene.contact.pairs) {
    const auto name = [&](std::size_t k) {
      const auto index = static_cast<std::size_t>(pair.between[k]);
      return pair.materials ? scene.materials[index].name : scene.bodies[index].name;
    };
    lines.push_back(fmt::format("{} and {}: {}", name(0), name(1), law_text(pair.law)));
  }
  return lines;
}

template std::vector<std::string> body_lines<2>(const Scene&, const Particles<2>&);
template std::vector<std::string> body_lines<3>(const Scene&, const Particles<3>&);

}  // namespace mpmfast
