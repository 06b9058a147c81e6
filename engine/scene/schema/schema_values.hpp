#pragma once

/// @file The parts of the schema that say what a single value may be.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/scene/keys/known.hpp"

namespace mpmfast {

using Json = nlohmann::ordered_json;

/// Text that holds an expression may stand wherever a scalar does.
inline constexpr const char* kExpression = "\\$\\{";

/// Schemas that many places refer to, collected while they are used.
class Definitions {
 public:
  /// What a number with or without a unit may be: two alternatives.
  std::vector<Json> quantity(Measure measure, const Limit& limit);
  Json table(Measure measure);
  Json points(const Points& form);
  Json words(const std::vector<KnownKeyword>& words, const Form& form) const;
  Json name() const;

  /// Adds a schema under this name, and refers to it.
  Json reference(const std::string& name, const Json& schema);

  const Json& all() const { return all_; }

 private:
  Json all_ = Json::object();
};

/// A text of the scene as JSON has it: number, truth, list or text.
Json json_of(const std::string& text);

}  // namespace mpmfast
