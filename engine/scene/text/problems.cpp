#include "engine/scene/text/problems.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace mpmfast {

int Problems::add_file(std::string name) {
  sources_.push_back(std::move(name));
  return static_cast<int>(sources_.size()) - 1;
}

void Problems::add(const SourceLocation& location, std::string path, std::string message, std::string hint) {
  // A place within a --set argument would say nothing.
  const SourceLocation shown =
      location.source == 0 || is_included(location.source) ? location : SourceLocation{};
  found_.push_back({location,
                    {sources_[static_cast<std::size_t>(location.source)], shown.line, shown.column,
                     std::move(path), std::move(message), std::move(hint)}});
}

std::vector<Diagnostic> Problems::sorted() const {
  std::vector<Found> found = found_;
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.location.source, a.location.line, a.location.column) <
           std::tie(b.location.source, b.location.line, b.location.column);
  });
  std::vector<Diagnostic> out;
  std::set<std::string> seen;
  for (Found& entry : found)
    if (seen.insert(entry.diagnostic.text()).second) out.push_back(std::move(entry.diagnostic));
  return out;
}

}  // namespace mpmfast
