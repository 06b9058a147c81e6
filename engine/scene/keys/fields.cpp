#include "engine/scene/keys/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

/// The first of them: a message for each of thousands of values must not name thousands of words.
std::string list_text(std::span<const std::string> words) {
  constexpr std::size_t kMost = 50;
  if (words.size() <= kMost) return fmt::format("{}", fmt::join(words, ", "));
  return fmt::format("{}, … {} in all", fmt::join(words.first(kMost), ", "), words.size());
}

/// What else an unknown key may be: half a number, two words run together, a key of another section.
std::string hint_for_key(const Key& key, const Node& value, std::span<const std::string> known) {
  const std::string& text = key.text;
  if (value.kind == Node::Kind::null && !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])))
    return "The decimal sign is a point, not a comma";
  const std::string first = text.substr(0, text.find(':'));
  if (first.size() < text.size() && std::find(known.begin(), known.end(), first) != known.end())
    return fmt::format("A blank is missing after '{}:'", first);
  return home_of(text);
}

/// Of the first hundred problems: a hint looks at all known words, which may be thousands themselves.
std::string hint_for(const std::string& word, std::span<const std::string> known, const Problems& problems) {
  constexpr std::size_t kMostHints = 100;
  return problems.count() < kMostHints ? did_you_mean(word, known) : "";
}

}  // namespace

bool is_name(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  if (text.empty() || text.size() > kLongest) return false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (!std::isalnum(byte) && byte < 0x80 && c != '_' && c != '-') return false;
  }
  return true;
}

void Value::complain(const std::string& message, const std::string& hint) const {
  report(message + ", got " + describe(*node_), hint);
}

void Value::report(const std::string& message, const std::string& hint) const {
  if (!node_->faulty) problems_->add(node_->location, path_, message, hint);
}

bool Value::is_list(int least, int most) const {
  return is(Node::Kind::list) && size() >= static_cast<std::size_t>(least) &&
         size() <= static_cast<std::size_t>(most);
}

Value Value::item(std::size_t index) const {
  return Value(node_->items[index], join(path_, std::to_string(index)), *problems_);
}

Value Value::entry(std::size_t index) const {
  return Value(node_->items[index], join(path_, node_->keys[index].text), *problems_);
}

std::optional<Value> Value::find(const std::string& key) const {
  const int index = index_of(*node_, key);
  return index < 0 ? std::nullopt : std::optional(entry(static_cast<std::size_t>(index)));
}

std::optional<double> Value::quantity(Measure kind, const Limit& limit) const {
  if (!is(Node::Kind::scalar)) {
    complain(fmt::format("not a number ({})", expected_of(kind)));
    return std::nullopt;
  }
  const auto parsed = parse_quantity(node_->scalar, kind);
  if (const auto* error = std::get_if<QuantityError>(&parsed)) {
    complain(error->message, error->hint);
    return std::nullopt;
  }
  const double value = std::get<double>(parsed);
  if (!limit.holds(value)) {
    complain(fmt::format("must be {} ({})", limit.description, expected_of(kind)));
    return std::nullopt;
  }
  return value;
}

std::optional<int> Value::integer(int lowest, int highest) const {
  const auto refuse = [&] {
    complain(fmt::format("not a whole number from {} to {}", lowest, highest));
    return std::nullopt;
  };
  if (!is(Node::Kind::scalar)) return refuse();
  const std::string& text = node_->scalar;
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  const bool leading_zeros = whole && text != std::to_string(value);
  if (!whole || leading_zeros || value < lowest || value > highest) return refuse();
  return value;
}

std::optional<bool> Value::boolean() const {
  if (is_keyword("true")) return true;
  if (is_keyword("false")) return false;
  complain("not true or false");  // yes, no, on and off are words like any other
  return std::nullopt;
}

std::optional<std::string> Value::text() const {
  if (is(Node::Kind::scalar)) return node_->scalar;
  complain("not text");
  return std::nullopt;
}

std::optional<std::string> Value::name() const {
  if (is(Node::Kind::scalar) && is_name(node_->scalar)) return node_->scalar;
  complain("not a name (letters, digits, '_' and '-')");
  return std::nullopt;
}

std::optional<Vec3> Value::vector(Measure kind, int count, const Limit& limit) const {
  if (!is_list(count, count)) {
    complain(fmt::format("not a list of {} ({} each)", count, expected_of(kind)), vector_hint(kind, count));
    return std::nullopt;
  }
  Vec3 out{};
  bool good = true;
  for (std::size_t k = 0; k < size(); ++k) {
    const auto component = item(k).quantity(kind, limit);
    if (component) out[k] = *component;
    good = good && component;
  }
  if (!good) return std::nullopt;
  return out;
}

std::string Value::vector_hint(Measure kind, int count) const {
  if (!is(Node::Kind::scalar) || std::holds_alternative<QuantityError>(parse_quantity(node_->scalar, kind)))
    return "";
  const bool length = kind == Measure::length, falls = kind == Measure::acceleration;
  std::string number = node_->scalar.substr(node_->scalar[0] == '+' ? 1 : 0);
  if (falls && number[0] != '-') number = "-" + number;
  if (falls && parse_number(number)) number += fmt::format(" {}", kind_of(kind).si);
  std::vector<std::string> parts(static_cast<std::size_t>(count), length ? number : "0");
  parts[falls ? 1 : 0] = number;
  return fmt::format("Perhaps [{}]", fmt::join(parts, ", "));
}

std::optional<std::size_t> Value::reference(std::span<const std::string> known) const {
  if (known.empty() && !problems_->empty()) return std::nullopt;  // they could not be read themselves
  return keyword_index(known);
}

std::optional<std::size_t> Value::keyword_index(std::span<const std::string> known) const {
  const bool scalar = is(Node::Kind::scalar);
  const auto found = scalar ? std::find(known.begin(), known.end(), node_->scalar) : known.end();
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  complain(fmt::format("not known here (one of {})", list_text(known)),
           scalar ? hint_for(node_->scalar, known, *problems_) : "");
  return std::nullopt;
}

bool Value::read_columns(Measure kind, PointList& table) const {
  MapReader map(*this);
  bool good = true;
  const auto read_column = [&](const char* key, Measure column_kind, std::vector<double>& out) {
    const auto column = map.need(key, "a list");
    const bool list = column && column->is_list(1);
    if (column && !list) column->complain("not a list of one or more");
    good = good && list;
    for (std::size_t k = 0; list && k < column->size(); ++k) {
      const auto entry = column->item(k).quantity(column_kind);
      good = good && entry;
      out.push_back(entry.value_or(0));
    }
  };
  read_column("times", Measure::time, table.along);
  read_column("values", kind, table.value);
  map.finish();
  if (good && table.along.size() != table.value.size()) {
    report(fmt::format("{} times but {} values", table.along.size(), table.value.size()));
    return false;
  }
  return good;
}

bool Value::read_pairs(const Points& form, const std::string& no_list, const std::string& pair,
                       PointList& out) const {
  bool good = is_list(1);
  if (!good) complain(no_list);
  for (std::size_t k = 0; is(Node::Kind::list) && k < size(); ++k) {
    const Value one = item(k);
    if (!one.is_list(2, 2)) {
      one.complain("not a pair " + pair);
      good = false;
      continue;
    }
    const auto along = one.item(0).quantity(form.along);
    const auto value = one.item(1).quantity(form.value);
    good = good && along && value;
    out.along.push_back(along.value_or(0));
    out.value.push_back(value.value_or(0));
  }
  return good;
}

bool Value::rises(const std::vector<double>& values, Measure kind, const std::string& fault) const {
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k] > values[k - 1]) continue;
    const char* unit = kind_of(kind).si;
    report(fmt::format("{}, but {} {} follows {} {}", fault, values[k], unit, values[k - 1], unit));
    return false;
  }
  return true;
}

std::optional<TimeTable> Value::table(Measure kind) const {
  if (!is(Node::Kind::map) && !is(Node::Kind::list)) {
    const auto constant = quantity(kind);
    return constant ? std::optional(TimeTable{{0}, {*constant}}) : std::nullopt;
  }
  PointList table;
  const bool good = is(Node::Kind::map)
                        ? read_columns(kind, table)
                        : read_pairs({Measure::time, kind}, "not a table (one or more pairs [time, value])",
                                     "[time, value]", table);
  if (!good || !rises(table.along, Measure::time, "times must increase")) return std::nullopt;
  return TimeTable{std::move(table.along), std::move(table.value)};
}

std::optional<Value::PointList> Value::points(const Points& form) const {
  PointList out;
  const std::string pair = fmt::format("[{}, {}]", noun_of(form.along), noun_of(form.value)),
                    no_list = fmt::format("not a curve (one or more pairs {})", pair),
                    fault = plural_of(form.along) + " must increase";
  if (!read_pairs(form, no_list, pair, out) || !rises(out.along, form.along, fault)) return std::nullopt;
  return out;
}

MapReader::MapReader(const Value& value, const std::string& expected)
    : value_(value), valid_(value.is(Node::Kind::map)) {
  if (!valid_) value_.complain("not " + expected);
}

bool MapReader::lacks(const std::string& key) {
  if (!lacking_.empty()) conditional_.push_back({key, lacking_});
  return !lacking_.empty();
}

std::optional<Value> MapReader::find(const std::string& key) {
  if (lacks(key)) return std::nullopt;
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return value_.find(key);
}

std::optional<Value> MapReader::need(const std::string& key, const std::string& expected) {
  auto found = find(key);
  if (!found && valid_ && lacking_.empty()) {
    value_.problems().add(value_.node().location, join(value_.path(), key),
                          fmt::format("missing ({})", expected));
  }
  return found;
}

void MapReader::boolean(const std::string& key, bool& out) {
  const auto found = find(key);
  if (const auto read = found ? found->boolean() : std::nullopt) out = *read;
}

int MapReader::one_of(const KeyGroups& groups) {
  int chosen = -1, touched = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto present = std::count_if(groups[g].begin(), groups[g].end(),
                                       [&](const std::string& key) { return find(key).has_value(); });
    if (present > 0) ++touched;
    if (present == std::ssize(groups[g])) chosen = static_cast<int>(g);
  }
  return touched == 1 ? chosen : -1;
}

void MapReader::refuse(const Key& key, const Node& value) {
  Problems& problems = value_.problems();
  const std::string path = join(value_.path(), key.text);
  for (const Conditional& other : conditional_)
    if (other.key == key.text)
      return problems.add(key.location, path, fmt::format("needs '{}' beside it", other.condition), "");
  const std::string meant = hint_for(key.text, known_, problems);
  problems.add(key.location, path,
               meant.empty() ? fmt::format("unknown key (known here: {})", list_text(known_)) : "unknown key",
               meant.empty() ? hint_for_key(key, value, known_) : meant);
}

void MapReader::finish() {
  if (!valid_) return;
  const std::vector<Key>& keys = value_.node().keys;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (std::find(known_.begin(), known_.end(), keys[k].text) == known_.end())
      refuse(keys[k], value_.node().items[k]);
}

}  // namespace mpmfast
