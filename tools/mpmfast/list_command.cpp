#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>

#include "commands.hpp"
#include "complain.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "engine/scene/text/suggest.hpp"
#include "exit_codes.hpp"

namespace mpmfast {

namespace {

void print_topic(const std::string& topic) {
  const std::vector<CatalogueEntry> entries = catalogue(topic);
  std::size_t width = 0;
  for (const CatalogueEntry& entry : entries) width = std::max(width, entry.name.size());
  say("{}\n", topic);
  for (const CatalogueEntry& entry : entries) {
    const std::string description = entry.keys.empty() || entry.description.empty()
                                        ? entry.keys + entry.description
                                        : entry.keys + ": " + entry.description;
    say("  {:<{}}{}{}\n", entry.name, description.empty() ? 0 : width, description.empty() ? "" : "  ",
        description);
  }
}

/// The sections of the page of all keys, by their names in a scene: grid, contact, method …
std::map<std::string, std::string> reference_sections() {
  std::map<std::string, std::string> sections;
  const std::string page = write_reference(), mark = "\n## ";
  for (std::size_t at = page.find(mark); at != std::string::npos;) {
    const std::size_t begin = at + mark.size(), next = page.find(mark, begin);
    const std::string section = page.substr(begin, next == std::string::npos ? next : next - begin);
    std::string name = section.substr(0, section.find('\n'));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    sections.emplace(name, section);
    at = next;
  }
  return sections;
}

}  // namespace

int list_command(const CommandLine& line) {
  const std::vector<std::string> topics = catalogue_topics();
  if (!line.topic.empty() && std::find(topics.begin(), topics.end(), line.topic) == topics.end()) {
    const auto sections = reference_sections();
    if (const auto section = sections.find(line.topic); section != sections.end()) {
      say("{}", section->second);
      return 0;
    }
    std::vector<std::string> known = topics;
    for (const auto& [name, text] : sections)
      if (std::find(topics.begin(), topics.end(), name) == topics.end()) known.push_back(name);
    const std::string hint = did_you_mean(line.topic, known);
    complain("mpmfast: nothing to list under '{}' (one of {}){}\n", line.topic, fmt::join(known, ", "),
             hint.empty() ? "" : ". " + hint);
    return kExitWrongInput;
  }
  for (const std::string& topic : topics) {
    if (!line.topic.empty() && topic != line.topic) continue;
    if (line.topic.empty() && topic != topics.front()) say("\n");
    print_topic(topic);
  }
  return 0;
}

}  // namespace mpmfast
