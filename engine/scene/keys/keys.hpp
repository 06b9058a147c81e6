#pragma once

/// @file The keys of a scene, each described once: its name, what it means, the member that it fills, the
/// form of its value. A description is a function of `Keys`, which reads a map of a scene into the members,
/// writes them as a map, or lists the keys that are known (known.hpp).

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/keys/fields.hpp"
#include "engine/scene/keys/known.hpp"
#include "engine/scene/keys/names.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/text/written.hpp"

namespace mpmfast {

// Forms of values, as descriptions state them; of one number see kernels/measure.hpp. Words are an array of
// Keyword (names.hpp).

struct Whole {
  int least = 0, most = Form::kNoEnd;
};
struct Truth {};
struct Vector {
  Measure measure;
  int count;
  Limit limit = kAny;
};
/// A quantity that may change in time.
struct Table {
  Measure measure;
};
struct Name {};
struct Text {};

/// What a message says is missing.
std::string expected_of(const Number& form);
std::string expected_of(const Vector& form);
std::string expected_of(const Table& form);
std::string expected_of(const Points& form);
template <class E, std::size_t N>
std::string expected_of(const std::array<Keyword<E>, N>& words) {
  std::string out;
  for (const Keyword<E>& word : words)
    out += (out.empty() ? "" : &word == &words.back() ? " or " : ", ") + std::string(word.name);
  return out;
}

class Keys;
using MapBody = std::function<void(Keys&)>;

/// The place of one value. The functions of a form return whether the value is good; what is wrong with one
/// that is read is reported.
class Slot {
 public:
  using Body = std::function<void(Slot&)>;
  using ItemBody = std::function<void(Slot&, std::size_t)>;

  explicit Slot(const Value& value) : value_(value) {}
  explicit Slot(Written& out) : out_(&out) {}
  Slot(KeyRegistry& knowledge, std::string pattern) : registry_(&knowledge), pattern_(std::move(pattern)) {}

  bool reads() const { return value_.has_value(); }
  bool writes() const { return out_ != nullptr; }
  bool describes() const { return registry_ != nullptr; }
  /// Where it is read.
  const std::optional<Value>& value() const { return value_; }
  bool good() const { return good_; }

  bool take(double& out, const Number& form);
  bool take(int& out, const Whole& form);
  bool take(bool& out, const Truth& form = {});
  bool take(Vec3& out, const Vector& form);
  bool take(TimeTable& out, const Table& form);
  bool take(TractionCurve& out, const Points& form);
  bool take(std::string& out, const Name& form);
  bool take(std::string& out, const Text& form);
  template <class E, std::size_t N>
  bool take(E& out, const std::array<Keyword<E>, N>& words) {
    std::size_t index = 0;
    while (index + 1 < N && words[index].value != out) ++index;
    if (!choose(index, words)) return false;
    out = words[index].value;
    return true;
  }
  /// One of these words.
  bool take(std::string& out, const std::vector<std::string>& words);
  /// The index of one of these entries, by name.
  template <class Entries>
  bool choose(std::size_t& index, const Entries& entries) {
    for (const auto& one : entries) offer(one.name, one.description);
    if (writes()) write(entries[index].name);
    return !reads() || accept(index, value_->keyword_index(names_of(entries)));
  }
  /// One of the names that another section gives.
  bool reference(int& index, const std::vector<std::string>& names);

  // Where a value has several forms, each of these says whether it is this one: what is read looks so, what
  // is written is `chosen`. The list of known keys has all of them.
  bool is_keyword(const char* word, bool chosen, const char* description = "");
  bool is_map(bool chosen, const MapBody& body);
  bool is_list(bool chosen, const std::string& expected, int least, int most, std::size_t& count,
               const ItemBody& body);
  /// For words that their reader finds himself, as "xpic(m)" with m in a range.
  void offer(const char* word, const char* description);
  void offer(const Form& form);
  void write(std::string text);

  /// A map, its keys, and no others.
  /// @param expected  "a map {…}", for what is none
  bool map(const std::string& expected, const MapBody& body);
  /// A list of so many; `count` is what is written and becomes what is read.
  bool list(const std::string& expected, int least, int most, std::size_t& count, const ItemBody& body);

  /// "message, got VALUE"; and the message alone. Nothing where nothing is read.
  void complain(const std::string& message, const std::string& hint = "");
  void report(const std::string& message, const std::string& hint = "");
  /// Of an entry of the list that is read, "message, got VALUE".
  void refuse_item(std::size_t k, const std::string& message) {
    value_->item(k).complain(message);
    keep(false);
  }
  /// What was found out of the value elsewhere.
  bool keep(bool good) {
    good_ = good_ && good;
    return good;
  }

 private:
  template <class T>
  bool accept(T& out, std::optional<T> read) {
    if (read) out = std::move(*read);
    return keep(read.has_value());
  }

  std::optional<Value> value_;
  Written* out_ = nullptr;
  KeyRegistry* registry_ = nullptr;
  std::string pattern_;
  bool good_ = true;
};

/// A map of the scene, while it is described.
class Keys {
 public:
  /// Reads; `expected` for what is no map.
  explicit Keys(const Value& map, const std::string& expected = "a map")
      : reader_(MapReader(map, expected)) {}
  /// Writes.
  explicit Keys(Written& out) : out_(&out) { out.kind = Written::Kind::map; }
  /// Tells.
  Keys(KeyRegistry& knowledge, std::string pattern) : registry_(&knowledge), pattern_(std::move(pattern)) {}

  bool reads() const { return reader_.has_value(); }
  bool writes() const { return out_ != nullptr; }
  bool describes() const { return registry_ != nullptr; }
  /// Was all that was read as it must be?
  bool good() const { return good_; }

  /// A key that may be absent: the member keeps what it holds.
  template <class T, class F>
  bool key(const std::string& name, const char* description, T& member, const F& form) {
    return at(name, description, [&](Slot& slot) { slot.take(member, form); });
  }
  bool key(const std::string& name, const char* description, bool& member) {
    return key(name, description, member, Truth{});
  }
  /// A key that must be there.
  template <class T, class F>
  bool need(const std::string& name, const char* description, T& member, const F& form) {
    return need_at(name, description, expected_of(form), [&](Slot& slot) { slot.take(member, form); });
  }

  /// A key whose value is described at its place. @return false where it is read and wrong
  bool at(const std::string& name, const char* description, const Slot::Body& body);
  bool need_at(const std::string& name, const char* description, const std::string& expected,
               const Slot::Body& body);

  /// As key and at, where the default follows from other keys: the list of known keys has none.
  template <class T, class F>
  bool derived(const std::string& name, const char* description, T& member, const F& form) {
    return derived_at(name, description, [&](Slot& slot) { slot.take(member, form); });
  }
  bool derived_at(const std::string& name, const char* description, const Slot::Body& body);

  /// How many entries a map has whose keys the user chooses; `written` of them are written.
  std::size_t count(std::size_t written) const;
  /// The k-th of them; `word` stands for its name in patterns.
  bool entry(std::size_t k, const std::string& word, const char* description, std::string& name,
             const Slot::Body& body);

  /// A section that may be absent, or must be there: a map.
  bool section(const std::string& name, const char* description, const std::string& expected,
               const MapBody& body) {
    return at(name, description, [&](Slot& slot) { slot.map(expected, body); });
  }
  bool need_section(const std::string& name, const char* description, const std::string& expected,
                    const MapBody& body) {
    return need_at(name, description, expected.substr(expected.find('{')),
                   [&](Slot& slot) { slot.map(expected, body); });
  }

  /// Which of these groups of keys is there, whole, and none of the other keys.
  class Choice {
   public:
    bool takes(int group) const { return all_ || group == given_; }
    bool none() const { return given_ < 0 && !all_; }

   private:
    friend class Keys;
    int given_ = 0;
    bool all_ = false;
  };
  /// @param written  the group that is written
  Choice one_of(const KeyGroups& groups, int written = 0);

  /// Keys that the map has under a condition: "bitmap" and "!bitmap" (this key is there, or not),
  /// "model=rigid", "3d". They are read where it holds, and always listed. Listed is what the map does
  /// not have anyway; a key of the condition's own name is one that it may have.
  void under(const std::string& condition, bool holds, const std::function<void()>& body);

  /// What stands under a key that is read.
  std::optional<Value> stated(const std::string& name);
  /// Looks again at a key that was read.
  void check(const std::string& name, const Slot::Body& body);
  void report(const std::string& message, const std::string& hint = "");
  MapReader& reader() { return *reader_; }

  /// Every other key is refused. A map that does not say so is closed when its description ends.
  void close();
  /// It is not: nobody knows what it may hold.
  void allow_other_keys() { open_ = true; }

 private:
  friend class Slot;
  std::string child(const std::string& name) const { return join(pattern_, name); }
  enum class Presence { optional, derived, needed, chosen };  ///< the last: its name is the user's choice
  /// @param absent  what is returned where nothing is found
  bool read(const std::optional<Value>& found, bool absent, const Slot::Body& body);
  /// Writes or lists.
  bool describe(const std::string& name, const char* description, Presence presence, const Slot::Body& body);
  void register_key(const std::string& name, const char* description, Presence presence,
                    const Slot::Body& body);

  std::optional<MapReader> reader_;
  Written* out_ = nullptr;
  KeyRegistry* registry_ = nullptr;
  std::string pattern_, condition_;        ///< the innermost
  std::optional<std::string> outside_;     ///< the pattern without it
  std::vector<std::string> alternatives_;  ///< patterns of one_of's keys: none is needed by itself
  bool good_ = true, open_ = false, closed_ = false;
};

}  // namespace mpmfast
