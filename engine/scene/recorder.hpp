#pragma once

/// @file What the reader would accept, noted while it reads: the source of the schema and of the reference
/// page.
///
/// Paths become patterns: an entry of a list is `bodies[]`, a name that the user chooses is a word in
/// capitals
/// (`materials.NAME.model`), and what a map holds only under a condition stands behind it
/// (`materials.NAME<model=rigid>.density`, `bodies[]<bitmap>.extent`).

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/quantity.hpp"

namespace mpmfast {

/// One form that a value may have.
struct Form {
  enum class Kind { word, truth, whole, quantity, table, text, name, vector, list, map };  ///< as shown
  static constexpr int kNoEnd = std::numeric_limits<int>::max();

  Kind kind;
  Measure measure = Measure::number;  ///< of a quantity, of a vector's components, of a table's values
  Limit limit = kAny;                 ///< of a quantity and of a vector's components
  int least = 0, most = kNoEnd;       ///< a whole number; entries of a list or vector; m of words "xpic(m)"
};

/// A word that a value may be, and what it means.
struct KnownWord {
  std::string name, says;
};

using KeyGroups = std::vector<std::vector<std::string>>;

/// All that was noted of the values at one pattern.
struct Known {
  std::vector<Form> forms;
  std::vector<KnownWord> words;  ///< where one form is a word
  bool needed = false;
  std::optional<std::string> standard;  ///< what is taken when the key is absent, as a scene would write it
  bool varies = false;                  ///< another value was taken elsewhere: other keys decide
  std::vector<std::string> keys;        ///< of a map, in the order in which the reader asks
  bool closed = false;                  ///< every other key of the map is refused
  KeyGroups one_of;                     ///< exactly one of these groups of keys must be there

  const Form* form(Form::Kind kind) const;
};

class Recorder {
 public:
  void note(const std::string& path, const Form& form);
  void note_word(const std::string& path, const std::string& name, const std::string& says);
  void note_key(const std::string& map, const std::string& path, bool needed);
  void note_standard(const std::string& path, const std::string& text);
  void note_closed(const std::string& map);
  void note_groups(const std::string& map, const KeyGroups& groups);

  /// The last part of this path was chosen by the user: patterns show `word` in its place.
  void rename(const std::string& path, const std::string& word);
  /// What is noted below this path until `leave` holds under this condition only.
  void enter(const std::string& path, const std::string& condition);
  void leave(const std::string& path);
  /// While silent, nothing is noted: what is said of a table says what its columns are.
  void set_silent(bool silent) { silent_ = silent; }
  bool silent() const { return silent_; }

  /// By pattern.
  const std::map<std::string, Known>& found() const { return found_; }

 private:
  std::string pattern(const std::string& path) const;

  std::map<std::string, Known> found_;
  std::map<std::string, std::string> words_;                    ///< of paths that users chose
  std::map<std::string, std::vector<std::string>> conditions_;  ///< of paths, innermost last
  bool silent_ = false;
};

/// While it lives, nothing is noted.
class Silence {
 public:
  explicit Silence(Recorder* recorder) : recorder_(recorder), before_(recorder && recorder->silent()) {
    if (recorder_) recorder_->set_silent(true);
  }
  ~Silence() {
    if (recorder_) recorder_->set_silent(before_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  Recorder* recorder_;
  bool before_;
};

/// The pattern without its conditions.
std::string unconditional(const std::string& pattern);

/// Reads the probes (probes.cpp).
void record_probes(Recorder& recorder);
/// What they find: all that the reader accepts.
const std::map<std::string, Known>& known_values();

/// Reads a scene for the recorder alone; what is wrong with it is not reported.
void record_scene(const std::string& text, const std::string& file, Recorder& recorder);

}  // namespace mpmfast
