#include "engine/quantities/closest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <vector>

namespace mpmfast {

namespace {

constexpr std::size_t kLongestWord = 64;  // a longer one is no misspelling, and the table grows as its square

}  // namespace

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

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

std::string closest_hint(std::string_view word, std::span<const std::string> known) {
  const std::string found = closest(word, known);
  return found.empty() ? "" : fmt::format("Did you mean '{}'?", found);
}

}  // namespace mpmfast
