#pragma once

/// @file Tiny scenes as text, and what the reader says of them.

#include <string>
#include <vector>

#include "engine/scene/read_scene.hpp"
#include "tests/text.hpp"

namespace mpmfast::test {

/// A valid 2-D scene in lines of its own: each can be replaced by a test. Lines 1 … 7.
inline std::string plain_scene() {
  return "space: plane_strain\n"
         "grid: {size: [10 mm, 20 mm], cell: 1 mm}\n"
         "time: {end: 1 us}\n"
         "materials:\n"
         "  steel: {model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}\n"
         "bodies:\n"
         "  - {name: block, box: {from: [1 mm, 1 mm], to: [4 mm, 3 mm]}, material: steel}\n";
}

/// The same in three dimensions.
inline std::string solid_scene() {
  return "space: 3d\n"
         "grid: {size: [10 mm, 20 mm, 5 mm], cell: 1 mm}\n"
         "time: {end: 1 us}\n"
         "materials:\n"
         "  steel: {model: linear_elastic, density: 7.85 g/cm^3, young: 210 GPa, poisson: 0.3}\n"
         "bodies:\n"
         "  - {name: block, box: {from: [1 mm, 1 mm, 0], to: [4 mm, 3 mm, 2 mm]}, material: steel}\n";
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "the text to replace is absent: " + from
                                 : text.replace(at, from.size(), to);
}

inline Scene parse(const std::string& text, const std::vector<Override>& overrides = {}) {
  return parse_scene(text, "scene.yaml", overrides);
}

/// Every line of what the reader says is wrong; empty when the scene is good.
inline std::vector<std::string> faults(const std::string& text, const std::vector<Override>& overrides = {}) {
  std::vector<std::string> out;
  try {
    parse(text, overrides);
  } catch (const SceneError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) out.push_back(diagnostic.text());
  }
  return out;
}

/// The one fault of a scene with one fault.
inline std::string fault(const std::string& text, const std::vector<Override>& overrides = {}) {
  const std::vector<std::string> all = faults(text, overrides);
  if (all.size() == 1) return all[0];
  std::string joined = std::to_string(all.size()) + " faults:";
  for (const std::string& one : all) joined += "\n" + one;
  return joined;
}

}  // namespace mpmfast::test
