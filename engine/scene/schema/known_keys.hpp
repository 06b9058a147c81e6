#pragma once

/// @file What is known of the keys, in words: shared by the schema, the reference page and `mpmfast list`.

#include <string>
#include <vector>

#include "engine/scene/keys/known.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

/// One key of a map.
struct KnownKey {
  std::string name;
  std::string pattern;    ///< of its value
  std::string condition;  ///< "model=rigid", "bitmap", "!bitmap", "3d"; empty: always
};

const Known& known_at(const std::string& pattern);

/// What stands behind a pattern of a map in other patterns: "model=rigid", "model=j2_plasticity><bitmap".
std::vector<std::string> conditions_of(const std::string& map);
/// Keys that a map always may have.
std::vector<KnownKey> plain_keys(const std::string& map);
/// Those and then the ones under conditions, where the conditions do not close the map (as a material's model
/// does).
std::vector<KnownKey> all_keys(const std::string& map);

/// "length > 0", "2 or 3 lengths", "true or false", "velocity or table"; with `units`: "length (m, cm, mm,
/// um) > 0".
std::string form_text(const std::string& pattern, bool units);
/// "none" and the like; empty where a key has no default.
std::string default_text(const std::string& pattern);
/// The keys of a map, each with its default: "density, bulk, shear (or young, poisson), hardening = 0 Pa".
std::string keys_text(const std::string& map);
/// The same for the parameters of a law.
std::string law_keys_text(const ContactLawKind& law);

}  // namespace mpmfast
