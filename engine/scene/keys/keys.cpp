#include "engine/scene/keys/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace mpmfast {

namespace {

Form form_of(const Number& n) { return {Form::Kind::quantity, n.measure, n.limit}; }
Form form_of(const Vector& v) { return {Form::Kind::vector, v.measure, v.limit, v.count, v.count}; }
Form list_of(int least, int most) { return {Form::Kind::list, Measure::number, kAny, least, most}; }

/// What is shown as a default: a scalar or a list of scalars that says something.
std::optional<std::string> default_text(const Written& value) {
  const bool simple = value.kind == Written::Kind::scalar ||
                      (value.kind == Written::Kind::list && !value.items.empty() &&
                       std::all_of(value.items.begin(), value.items.end(), [](const auto& item) {
                         return item.value.kind == Written::Kind::scalar;
                       }));
  const std::string text = simple ? value.flow() : "";
  return text.empty() || text == "\"\"" ? std::nullopt : std::optional(text);
}

}  // namespace

std::string expected_of(const Number& form) { return expected_of(form.measure); }

std::string expected_of(const Vector& form) {
  return fmt::format("a list of {} {}", form.count, plural_of(form.measure));
}

std::string expected_of(const Points& form) {
  return fmt::format("a list of points [{}, {}]", noun_of(form.along), noun_of(form.value));
}

std::string expected_of(const Table& form) { return expected_of(form.measure) + "; or a table"; }

bool Slot::take(double& out, const Number& form) {
  offer(form_of(form));
  if (writes()) out_->set(quantity_text(out, form.measure));
  return !reads() || accept(out, value_->quantity(form.measure, form.limit));
}

bool Slot::take(int& out, const Whole& form) {
  offer({Form::Kind::whole, Measure::number, kAny, form.least, form.most});
  if (writes()) out_->set(fmt::format("{}", out));
  return !reads() || accept(out, value_->integer(form.least, form.most));
}

bool Slot::take(bool& out, const Truth&) {
  offer({Form::Kind::truth});
  if (writes()) out_->set(out ? "true" : "false");
  return !reads() || accept(out, value_->boolean());
}

bool Slot::take(Vec3& out, const Vector& form) {
  offer(form_of(form));
  if (writes()) out_->set(vector_text(out, form.measure, form.count));
  return !reads() || accept(out, value_->vector(form.measure, form.count, form.limit));
}

bool Slot::take(TimeTable& out, const Table& form) {
  offer({Form::Kind::table, form.measure});
  if (writes()) out_->set(table_text(out, form.measure));
  return !reads() || accept(out, value_->table(form.measure));
}

bool Slot::take(TractionCurve& out, const Points& form) {
  Form points{Form::Kind::points, form.value};
  points.along = form.along;
  offer(points);
  if (writes()) out_->set(points_text(out.jump, out.traction, form));
  if (!reads()) return true;
  auto read = value_->points(form);
  if (!read) return keep(false);
  out = {std::move(read->along), std::move(read->value)};
  return true;
}

bool Slot::take(std::string& out, const Name&) {
  offer({Form::Kind::name});
  if (writes() && !out.empty()) out_->set(name_text(out));
  return !reads() || accept(out, value_->name());
}

bool Slot::take(std::string& out, const Text&) {
  offer({Form::Kind::text});
  if (writes()) out_->set(quoted_text(out));
  return !reads() || accept(out, value_->text());
}

bool Slot::take(std::string& out, const std::vector<std::string>& words) {
  for (const std::string& word : words) offer(word.c_str(), "");
  if (writes()) out_->set(out);
  if (!reads()) return true;
  const auto index = value_->keyword_index(words);
  if (index) out = words[*index];
  return keep(index.has_value());
}

bool Slot::reference(int& index, const std::vector<std::string>& names) {
  offer({Form::Kind::name});
  const auto known = static_cast<std::size_t>(index);
  if (writes() && known < names.size()) out_->set(name_text(names[known]));
  if (!reads()) return true;
  const auto read = value_->reference(names);
  if (read) index = static_cast<int>(*read);
  return keep(read.has_value());
}

void Slot::offer(const char* word, const char* description) {
  if (describes()) registry_->word(pattern_, word, description);
}

void Slot::offer(const Form& form) {
  if (describes()) registry_->form(pattern_, form);
}

void Slot::write(std::string text) {
  if (writes()) out_->set(std::move(text));
}

bool Slot::is_keyword(const char* word, bool chosen, const char* description) {
  offer(word, description);
  if (writes() && chosen) out_->set(word);
  return (writes() && chosen) || (reads() && value_->is_keyword(word));
}

bool Slot::is_map(bool chosen, const MapBody& body) {
  if (reads() ? !value_->is(Node::Kind::map) : !describes() && !chosen) return false;
  map("a map", body);
  return !describes();
}

bool Slot::is_list(bool chosen, const std::string& expected, int least, int most, std::size_t& count,
                   const ItemBody& body) {
  if (reads() ? !value_->is(Node::Kind::list) : !describes() && !chosen) return false;
  list(expected, least, most, count, body);
  return !describes();
}

bool Slot::map(const std::string& expected, const MapBody& body) {
  offer({Form::Kind::map});
  Keys keys = reads() ? Keys(*value_, expected) : writes() ? Keys(*out_) : Keys(*registry_, pattern_);
  if (reads() && !keys.reader().valid()) return keep(false);
  body(keys);
  if (!keys.open_) keys.close();
  return keep(keys.good());
}

bool Slot::list(const std::string& expected, int least, int most, std::size_t& count, const ItemBody& body) {
  offer(list_of(least, most));
  if (reads()) {
    const auto size = value_->is(Node::Kind::list) ? value_->size() : 0;
    if (!value_->is_list(least, most)) {
      value_->complain("not " + expected);
      return keep(false);
    }
    count = size;
  }
  if (describes()) count = 1;
  if (writes()) out_->kind = Written::Kind::list;
  for (std::size_t k = 0; k < count; ++k) {
    Written item;
    Slot slot = reads() ? Slot(value_->item(k)) : writes() ? Slot(item) : Slot(*registry_, pattern_ + "[]");
    body(slot, k);
    keep(slot.good());
    if (writes()) out_->add("", std::move(item));
  }
  return good_;
}

void Slot::complain(const std::string& message, const std::string& hint) {
  if (reads()) value_->complain(message, hint);
  keep(!reads());
}

void Slot::report(const std::string& message, const std::string& hint) {
  if (reads()) value_->report(message, hint);
  keep(!reads());
}

bool Keys::at(const std::string& name, const char* description, const Slot::Body& body) {
  return reads() ? read(reader_->find(name), true, body)
                 : describe(name, description, Presence::optional, body);
}

bool Keys::derived_at(const std::string& name, const char* description, const Slot::Body& body) {
  return reads() ? read(reader_->find(name), true, body)
                 : describe(name, description, Presence::derived, body);
}

bool Keys::need_at(const std::string& name, const char* description, const std::string& expected,
                   const Slot::Body& body) {
  return reads() ? read(reader_->need(name, expected), false, body)
                 : describe(name, description, Presence::needed, body);
}

bool Keys::read(const std::optional<Value>& found, bool absent, const Slot::Body& body) {
  bool good = absent;
  if (found) {
    Slot slot(*found);
    body(slot);
    good = slot.good();
  }
  good_ = good_ && good;
  return good;
}

bool Keys::describe(const std::string& name, const char* description, Presence presence,
                    const Slot::Body& body) {
  if (describes()) {
    register_key(name, description, presence, body);
    return true;
  }
  Written value;
  Slot slot(value);
  body(slot);
  if (value.kind != Written::Kind::nothing) out_->add(name, std::move(value));
  return true;
}

void Keys::register_key(const std::string& name, const char* description, Presence presence,
                        const Slot::Body& body) {
  const bool itself = outside_ && name == condition_;  // its presence is the condition: the map may have it
  const std::string map = itself ? *outside_ : pattern_, pattern = join(map, name);
  const bool alternative =
      std::find(alternatives_.begin(), alternatives_.end(), pattern) != alternatives_.end();
  const bool needed = presence == Presence::needed && !alternative && !itself;
  if (!itself && outside_ && registry_->describes(*outside_, name, needed)) return;
  registry_->key(map, pattern, needed, description);
  if (presence == Presence::optional) {
    Written value;
    Slot writing(value);
    body(writing);
    if (const auto standard = default_text(value)) registry_->standard(pattern, *standard);
  }
  Slot telling(*registry_, pattern);
  body(telling);
}

std::size_t Keys::count(std::size_t written) const {
  return reads() ? reader_->value().size() : writes() ? written : 1;
}

bool Keys::entry(std::size_t k, const std::string& word, const char* description, std::string& name,
                 const Slot::Body& body) {
  if (!reads()) return describe(writes() ? name_text(name) : word, description, Presence::chosen, body);
  name = reader_->value().node().keys[k].text;
  return read(reader_->value().entry(k), true, body);
}

Keys::Choice Keys::one_of(const KeyGroups& groups, int written) {
  Choice choice;
  choice.given_ = reads() ? reader_->one_of(groups) : written;
  choice.all_ = describes();
  if (!describes()) return choice;
  const bool described = outside_ && registry_->has_groups(*outside_, groups);
  if (!described) registry_->groups(pattern_, groups);
  for (const auto& group : groups)
    for (const std::string& name : group) {
      alternatives_.push_back(child(name));
      if (!described) registry_->key(pattern_, child(name), false, "");
    }
  return choice;
}

void Keys::under(const std::string& condition, bool holds, const std::function<void()>& body) {
  if (!describes()) {
    if (holds) body();
    return;
  }
  const std::string pattern = pattern_, before = condition_;
  const std::optional<std::string> outside = outside_;
  pattern_ += "<" + condition + ">";
  outside_ = pattern;
  condition_ = condition;
  body();
  pattern_ = pattern;
  outside_ = outside;
  condition_ = before;
}

std::optional<Value> Keys::stated(const std::string& name) {
  return reads() ? reader_->find(name) : std::nullopt;
}

void Keys::check(const std::string& name, const Slot::Body& body) {
  if (reads()) read(reader_->find(name), true, body);
}

void Keys::report(const std::string& message, const std::string& hint) {
  if (reads()) reader_->value().report(message, hint);
  good_ = good_ && !reads();
}

void Keys::close() {
  if (describes()) registry_->closed(pattern_);
  if (closed_ || !reads()) return;
  closed_ = true;
  reader_->finish();
}

}  // namespace mpmfast
