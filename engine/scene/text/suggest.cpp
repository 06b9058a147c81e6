#include "engine/scene/text/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>
#include <vector>

namespace mpmfast {

namespace {

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

constexpr std::size_t kLongestWord =
    64;  // a longer one is no misspelling, and the table grows with its square

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  if (a.size() > kLongestWord || b.size() > kLongestWord) return std::numeric_limits<int>::max();
  const std::size_t width = b.size() + 1;
  std::vector<int> table((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> int& { return table[i * width + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = at(i - 1, j - 1) + (a[i - 1] == b[j - 1] ? 0 : 1);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  }
  return table.back();
}

std::string closest(std::string_view word, std::span<const std::string> known) {
  const std::string small = lower_case(word);
  const std::string* best = nullptr;
  int best_score = std::numeric_limits<int>::max();
  for (const std::string& candidate : known) {
    if (candidate == word) continue;
    const int distance = edit_distance(small, lower_case(candidate));
    // A third of the letters may be wrong; of a word of one letter none but its case.
    const int allowed = static_cast<int>((std::max(word.size(), candidate.size()) + 1) / 3);
    if (distance > allowed || (distance > 0 && word.size() < 2)) continue;
    const int score = 2 * distance + (edit_distance(word, candidate) > distance ? 1 : 0);
    if (score < best_score) {
      best = &candidate;
      best_score = score;
    }
  }
  return best ? *best : std::string();
}

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
  if (std::string hint = hint_of_synonym(word, known); !hint.empty()) return hint;
  const std::string found = closest(word, known);
  return found.empty() ? std::string() : "Did you mean '" + found + "'?";
}

}  // namespace mpmfast
