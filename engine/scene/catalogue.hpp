#pragma once

/// @file What this build offers, from the tables that the reader itself uses.

#include <string>
#include <vector>

namespace mpmfast {

struct CatalogueEntry {
  std::string name, keys, description;  ///< keys may be empty
};

/// materials, bases, updates, …
std::vector<std::string> catalogue_topics();

/// The entries of a topic; none when the topic is unknown.
std::vector<CatalogueEntry> catalogue(const std::string& topic);

}  // namespace mpmfast
