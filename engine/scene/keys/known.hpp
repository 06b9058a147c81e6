#pragma once

/// @file What scenes may say, gathered from the descriptions of their keys (keys.hpp): the source of the JSON
/// schema, of the page of all keys and of `mpmfast list`.
///
/// A place is named by a pattern: an entry of a list is `bodies[]`, a name that the user chooses is a word in
/// capitals (`materials.NAME.model`), and what a map holds only under a condition stands behind it
/// (`materials.NAME<model=rigid>.density`, `bodies[]<bitmap>.extent`).

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/quantities/quantity.hpp"

namespace mpmfast {

/// One form that a value may have.
struct Form {
  /// In the order in which they are shown.
  enum class Kind { word, truth, whole, quantity, table, points, text, name, vector, list, map };
  static constexpr int kNoEnd = std::numeric_limits<int>::max();

  Kind kind;
  Measure measure = Measure::number;  ///< of a quantity, of a vector's components, of a table's values
  Limit limit = kAny;                 ///< of a quantity and of a vector's components
  int least = 0, most = kNoEnd;       ///< a whole number; entries of a list or vector; m of words "xpic(m)"
  Measure along = Measure::number;    ///< of a curve's points: what `measure` changes with
};

/// A word that a value may be, and what it means.
struct KnownKeyword {
  std::string name, description;
};

using KeyGroups = std::vector<std::vector<std::string>>;

/// All that is known of the values at one pattern.
struct Known {
  std::string description;  ///< what the key means, a sentence
  std::vector<Form> forms;
  std::vector<KnownKeyword> words;  ///< where one form is a word
  bool needed = false;
  std::optional<std::string> standard;  ///< what is taken when the key is absent, as a scene would write it
  bool varies = false;                  ///< another value is taken elsewhere: other keys decide
  std::vector<std::string> keys;        ///< of a map, in the order in which they are described
  bool closed = false;                  ///< every other key of the map is refused
  KeyGroups one_of;                     ///< exactly one of these groups of keys must be there

  const Form* form(Form::Kind kind) const;
};

/// Collects the keys that the descriptions list. Keys listed twice, for planes and for solids, are merged.
class KeyRegistry {
 public:
  void form(const std::string& pattern, const Form& form);
  void word(const std::string& pattern, const std::string& name, const std::string& description);
  /// @param child  pattern of the key's value
  void key(const std::string& map, const std::string& child, bool needed, const std::string& description);
  void standard(const std::string& pattern, const std::string& text);
  /// From now on, these keys have values that are not their defaults.
  void choose(const std::vector<std::string>& patterns) { chosen_ = patterns; }
  void closed(const std::string& map) { found_[map].closed = true; }
  void groups(const std::string& map, const KeyGroups& groups) { found_[map].one_of = groups; }

  /// Has the map this key, needed if that is asked?
  bool describes(const std::string& map, const std::string& key, bool needed) const;
  bool has_groups(const std::string& map, const KeyGroups& groups) const;

  /// By pattern.
  const std::map<std::string, Known>& found() const { return found_; }

 private:
  std::map<std::string, Known> found_;
  std::vector<std::string> chosen_;
};

/// All that a scene may say.
const std::map<std::string, Known>& known_values();

}  // namespace mpmfast
