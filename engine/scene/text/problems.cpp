#include "engine/scene/text/problems.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace mpmfast {

int Problems::add_file(std::string name) {
  sources_.push_back(std::move(name));
  return static_cast<int>(sources_.size()) - 1;
}

void Problems::add(const Place& place, std::string path, std::string message, std::string hint) {
  // A place within a --set argument would say nothing.
  const Place shown = place.source == 0 || is_included(place.source) ? place : Place{};
  found_.push_back({place,
                    {sources_[static_cast<std::size_t>(place.source)], shown.line, shown.column,
                     std::move(path), std::move(message), std::move(hint)}});
}

std::vector<Diagnostic> Problems::sorted() const {
  std::vector<Found> found = found_;
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.place.source, a.place.line, a.place.column) <
           std::tie(b.place.source, b.place.line, b.place.column);
  });
  std::vector<Diagnostic> out;
  std::set<std::string> told;
  for (Found& entry : found)
    if (told.insert(entry.diagnostic.text()).second) out.push_back(std::move(entry.diagnostic));
  return out;
}

}  // namespace mpmfast
