#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/suggest.hpp"
#include "exit_codes.hpp"

namespace mpmfast {

namespace {

void print_topic(const std::string& topic) {
  const std::vector<CatalogueEntry> entries = catalogue(topic);
  std::size_t width = 0;
  for (const CatalogueEntry& entry : entries) width = std::max(width, entry.name.size());
  fmt::print("{}\n", topic);
  for (const CatalogueEntry& entry : entries) {
    const std::string says =
        entry.keys.empty() || entry.says.empty() ? entry.keys + entry.says : entry.keys + ": " + entry.says;
    fmt::print("  {:<{}}{}{}\n", entry.name, says.empty() ? 0 : width, says.empty() ? "" : "  ", says);
  }
}

}  // namespace

int list_command(const CommandLine& line) {
  const std::vector<std::string> topics = catalogue_topics();
  if (!line.topic.empty() && std::find(topics.begin(), topics.end(), line.topic) == topics.end()) {
    const std::string hint = did_you_mean(line.topic, topics);
    fmt::print(stderr, "mpmfast: nothing to list under '{}' (one of {}){}\n", line.topic,
               fmt::join(topics, ", "), hint.empty() ? "" : ". " + hint);
    return kExitWrongInput;
  }
  for (const std::string& topic : topics) {
    if (!line.topic.empty() && topic != line.topic) continue;
    if (line.topic.empty() && topic != topics.front()) fmt::print("\n");
    print_topic(topic);
  }
  return 0;
}

}  // namespace mpmfast
