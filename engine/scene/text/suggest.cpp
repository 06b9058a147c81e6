#include "engine/scene/text/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// One of our words, and what other programs or everyday speech have in its place.
struct Synonyms {
  std::string_view ours;
  std::array<std::string_view, 4> others;
  std::string_view description = "";  ///< in place of "Did you mean …?"
};

constexpr Synonyms kSynonyms[] = {
    {"disk", {"circle"}},
    {"tube", {"cylinder"}},
    {"box", {"rectangle", "square", "cube", "block"}},
    {"sphere", {"ball"}},
    {"linear_elastic", {"elastic"}},
    {"neo_hookean", {"hyperelastic"}},
    {"j2_plasticity", {"plastic", "elastoplastic", "von_mises"}},
    {"fixed", {"clamped", "sticky", "no_slip"}},
    {"wall", {"roller", "slip", "rigid"}},
    {"free", {"open"}},
    {"symmetry", {"periodic"}, "No face is periodic; 'symmetry' mirrors what is before it"},
    {"friction", {"mu"}},
    {"shear", {"mu", "g"}},
    {"bulk", {"k"}},
    {"young", {"e"}},
    {"poisson", {"nu"}},
    {"density", {"rho"}},
    {"cfl", {"dt", "timestep"}, "The step follows from the waves: 'cfl' is its share of the stable one"},
    {"cell", {"dx", "h", "spacing"}},
    {"end", {"t_end", "duration"}},
    {"particles_per_cell", {"ppc"}},
    {"velocity", {"v", "v0"}},
    {"centre", {"center"}},
    {"picture", {"colour", "color"}},
};

/// What a synonym stands for among the known words.
std::string hint_of_synonym(std::string_view word, std::span<const std::string> known) {
  const std::string small = lower_case(word);
  for (const auto& [ours, others, description] : kSynonyms) {
    const bool meant = !small.empty() && std::find(others.begin(), others.end(), small) != others.end();
    if (!meant || std::find(known.begin(), known.end(), ours) == known.end()) continue;
    return description.empty() ? fmt::format("Did you mean '{}'?", ours) : std::string(description);
  }
  return "";
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::string hint = hint_of_synonym(word, known);
  return hint.empty() ? closest_hint(word, known) : hint;
}

}  // namespace mpmfast
