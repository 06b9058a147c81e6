#include "engine/scene/keys/known.hpp"

#include <algorithm>

namespace mpmfast {

namespace {

bool alike(const Form& a, const Form& b) {
  const bool counted = a.kind == Form::Kind::vector || a.kind == Form::Kind::list;
  return a.kind == b.kind && a.measure == b.measure && a.along == b.along && a.limit.same(b.limit) &&
         (counted || (a.least == b.least && a.most == b.most));
}

void insert(const Form& form, std::vector<Form>& forms) {
  const auto later = [](const Form& a, const Form& b) { return a.kind < b.kind; };
  forms.insert(std::upper_bound(forms.begin(), forms.end(), form, later), form);
}

}  // namespace

const Form* Known::form(Form::Kind kind) const {
  const auto found = std::find_if(forms.begin(), forms.end(), [&](const Form& f) { return f.kind == kind; });
  return found == forms.end() ? nullptr : &*found;
}

void KeyRegistry::form(const std::string& pattern, const Form& form) {
  std::vector<Form>& forms = found_[pattern].forms;
  for (Form& known : forms) {
    if (!alike(known, form)) continue;
    known.least = std::min(known.least, form.least);
    known.most = std::max(known.most, form.most);
    return;
  }
  insert(form, forms);
}

void KeyRegistry::word(const std::string& pattern, const std::string& name, const std::string& description) {
  Known& known = found_[pattern];
  if (!known.form(Form::Kind::word)) insert({Form::Kind::word}, known.forms);
  const bool there = std::any_of(known.words.begin(), known.words.end(),
                                 [&](const KnownKeyword& word) { return word.name == name; });
  if (!there) known.words.push_back({name, description});
}

void KeyRegistry::key(const std::string& map, const std::string& child, bool needed,
                      const std::string& description) {
  const std::string name = child.substr(child.rfind('.') + 1);  // npos + 1 is 0
  std::vector<std::string>& keys = found_[map].keys;
  if (std::find(keys.begin(), keys.end(), name) == keys.end()) keys.push_back(name);
  Known& known = found_[child];
  known.needed = known.needed || needed;
  if (known.description.empty()) known.description = description;
}

void KeyRegistry::standard(const std::string& pattern, const std::string& text) {
  if (std::find(chosen_.begin(), chosen_.end(), pattern) != chosen_.end()) return;
  Known& known = found_[pattern];
  const auto same = [&](const std::string& before) {  // a vector has a component more in 3-D
    return text == before || (text.front() == '[' && text.starts_with(before.substr(0, before.size() - 1)));
  };
  known.varies = known.varies || (known.standard && !same(*known.standard));
  if (!known.standard) known.standard = text;
}

bool KeyRegistry::describes(const std::string& map, const std::string& key, bool needed) const {
  const auto holder = found_.find(map), value = found_.find(map + "." + key);
  if (holder == found_.end() || value == found_.end()) return false;
  const auto& keys = holder->second.keys;
  const bool there = std::find(keys.begin(), keys.end(), key) != keys.end();
  return there && (value->second.needed || !needed);
}

bool KeyRegistry::has_groups(const std::string& map, const KeyGroups& groups) const {
  const auto holder = found_.find(map);
  return holder != found_.end() && holder->second.one_of == groups;
}

}  // namespace mpmfast
