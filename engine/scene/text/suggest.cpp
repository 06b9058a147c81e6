#include "engine/scene/text/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace mpmfast {

std::string home_of(std::string_view key) {
  // Only keys that one section alone has.
  static constexpr std::pair<std::string_view, std::string_view> kHomes[] = {
      {"size", "grid"},          {"cell", "grid"},          {"leaving", "grid"},
      {"end", "time"},           {"cfl", "time"},           {"max_step", "time"},
      {"basis", "method"},       {"update", "method"},      {"strain", "method"},
      {"law", "contact"},        {"friction", "contact"},   {"normal", "contact"},
      {"separation", "contact"}, {"pairs", "contact"},      {"corrections", "contact"},
      {"frames", "output"},      {"history", "output"},     {"picture", "output"},
      {"checkpoint", "output"},  {"overlap", "output"},     {"density", "a material"},
      {"young", "a material"},   {"poisson", "a material"}, {"bulk", "a material"},
      {"shear", "a material"},   {"velocity", "a body"},    {"rotation", "a body"},
      {"seeding", "a body"},     {"piston", "boundaries"},  {"particles_per_cell", "a body"}};
  for (const auto& [word, home] : kHomes)
    if (word == key)
      return "It belongs to " + (home[1] == ' ' ? std::string(home) : fmt::format("'{}'", home));
  return "";
}

namespace {

/// A word of other programs, or of everyday speech, for one of ours.
struct Synonym {
  std::string_view word, ours;
  std::string_view says = "";  ///< in place of "Did you mean …?"
};

constexpr Synonym kSynonyms[] = {
    {"circle", "disk"},
    {"cylinder", "tube"},
    {"rectangle", "box"},
    {"square", "box"},
    {"cube", "box"},
    {"block", "box"},
    {"ball", "sphere"},
    {"elastic", "linear_elastic"},
    {"hyperelastic", "neo_hookean"},
    {"plastic", "j2_plasticity"},
    {"elastoplastic", "j2_plasticity"},
    {"von_mises", "j2_plasticity"},
    {"clamped", "fixed"},
    {"sticky", "fixed"},
    {"no_slip", "fixed"},
    {"roller", "wall"},
    {"slip", "wall"},
    {"rigid", "wall"},
    {"open", "free"},
    {"periodic", "symmetry", "No face is periodic; 'symmetry' mirrors what is before it"},
    {"mu", "friction"},
    {"mu", "shear"},
    {"g", "shear"},
    {"k", "bulk"},
    {"e", "young"},
    {"nu", "poisson"},
    {"rho", "density"},
    {"dt", "cfl", "The step follows from the waves: 'cfl' is its share of the stable one"},
    {"timestep", "cfl", "The step follows from the waves: 'cfl' is its share of the stable one"},
    {"dx", "cell"},
    {"h", "cell"},
    {"spacing", "cell"},
    {"t_end", "end"},
    {"duration", "end"},
    {"ppc", "particles_per_cell"},
    {"v", "velocity"},
    {"v0", "velocity"},
    {"center", "centre"},
    {"colour", "picture"},
    {"color", "picture"},
};

/// What a synonym stands for among the known words.
std::string hint_of_synonym(std::string_view word, std::span<const std::string> known) {
  for (const auto& [other, ours, says] : kSynonyms) {
    if (lower_case(word) != other || std::find(known.begin(), known.end(), ours) == known.end()) continue;
    return says.empty() ? fmt::format("Did you mean '{}'?", ours) : std::string(says);
  }
  return "";
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::string hint = hint_of_synonym(word, known);
  return hint.empty() ? closest_hint(word, known) : hint;
}

}  // namespace mpmfast
