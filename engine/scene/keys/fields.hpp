#pragma once

/// @file Reading typed values out of the tree: each reader reports what is wrong with its value and goes on.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/quantities/quantity.hpp"
#include "engine/scene/keys/known.hpp"
#include "engine/scene/keys/names.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/text/problems.hpp"
#include "engine/scene/text/tree.hpp"

namespace mpmfast {

/// May this head a column of a table, name a field, stand in a dotted path? Letters, digits, '_' and '-'.
bool is_name(const std::string& text);

/// The names of entries, in their order.
template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return names;
}

/// One value of the scene: where it is, what it is called, and who hears of its faults.
class Value {
 public:
  Value(const Node& node, std::string path, Problems& problems)
      : node_(&node), path_(std::move(path)), problems_(&problems) {}

  const Node& node() const { return *node_; }
  const std::string& path() const { return path_; }
  Problems& problems() const { return *problems_; }
  bool is(Node::Kind kind) const { return node_->kind == kind; }
  /// Is this the word?
  bool is_keyword(const char* word) const { return is(Node::Kind::scalar) && node_->scalar == word; }
  /// Is this a list of so many entries?
  bool is_list(int least = 0, int most = Form::kNoEnd) const;

  /// "message, got VALUE".
  void complain(const std::string& message, const std::string& hint = "") const;
  /// The message alone, at this value's place.
  void report(const std::string& message, const std::string& hint = "") const;

  Value item(std::size_t index) const;
  /// The value of a map's key, by its place; by its name, where this is a map that has it.
  Value entry(std::size_t index) const;
  std::optional<Value> find(const std::string& key) const;
  std::size_t size() const { return node_->items.size(); }

  std::optional<double> quantity(Measure kind, const Limit& limit = kAny) const;
  std::optional<int> integer(int lowest, int highest) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> text() const;
  /// Text that is_name.
  std::optional<std::string> name() const;
  /// Exactly `count` quantities; the rest of the result is zero.
  std::optional<Vec3> vector(Measure kind, int count, const Limit& limit = kAny) const;
  /// The list that one number in its place may stand for: gravity pulls down, lengths are alike.
  std::string vector_hint(Measure kind, int count) const;
  /// A quantity (constant in time), {times: […], values: […]}, or a list of [time, value].
  std::optional<TimeTable> table(Measure kind) const;
  /// A list of [along, value], of which the first increase.
  struct PointList {
    std::vector<double> along, value;
  };
  std::optional<PointList> points(const Points& form) const;

  /// One of a fixed set of words.
  template <class E, std::size_t N>
  std::optional<E> word(const std::array<Keyword<E>, N>& words) const {
    const auto index = keyword_index(names_of(words));
    return index ? std::optional(words[*index].value) : std::nullopt;
  }
  /// Index of the word among `known`; nothing and a complaint when it is none of them.
  std::optional<std::size_t> keyword_index(std::span<const std::string> known) const;
  /// The same where the words are names that the scene itself gives, of materials or bodies.
  std::optional<std::size_t> reference(std::span<const std::string> known) const;

 private:
  bool read_columns(Measure kind, PointList& table) const;
  bool read_pairs(const Points& form, const std::string& no_list, const std::string& pair,
                  PointList& out) const;
  bool rises(const std::vector<double>& values, Measure kind, const std::string& fault) const;

  const Node* node_;
  std::string path_;
  Problems* problems_;
};

/// A map while it is read: each key asked for becomes a known key, and finish() refuses the others.
class MapReader {
 public:
  explicit MapReader(const Value& value, const std::string& expected = "a map");

  /// False when the value is no map (reported then).
  bool valid() const { return valid_; }
  const Value& value() const { return value_; }

  std::optional<Value> find(const std::string& key);
  /// As find, but its absence is an error that says what was expected.
  std::optional<Value> need(const std::string& key, const std::string& expected);

  /// Replaces `out` when the key is there and good.
  void boolean(const std::string& key, bool& out);
  template <class E, std::size_t N>
  bool word(const std::string& key, const std::array<Keyword<E>, N>& words, E& out) {
    const auto found = find(key);
    const auto read = found ? found->word(words) : std::nullopt;
    if (read) out = *read;
    return read.has_value();
  }

  /// Which of these groups of keys is there, whole, and none of the other keys; −1 when it is not so.
  int one_of(const KeyGroups& groups);

  /// What is asked for until `end_lacking` needs this first, such as "at: surface", which is not there:
  /// nothing is found, and finish() names it for a key that is there all the same.
  void begin_lacking(const std::string& condition) { lacking_ = condition; }
  void end_lacking() { lacking_.clear(); }

  /// Reports every key that nobody asked for.
  void finish();

 private:
  Value value_;
  bool valid_;
  /// A key, and what it needs first.
  struct Conditional {
    std::string key, condition;
  };
  bool lacks(const std::string& key);
  void refuse(const Key& key, const Node& value);

  std::vector<std::string> known_;
  std::string lacking_;  ///< empty: nothing
  std::vector<Conditional> conditional_;
};

}  // namespace mpmfast
