#include "engine/scene/recorder.hpp"

#include <algorithm>
#include <cctype>

namespace mpmfast {

namespace {

bool is_index(const std::string& part) {
  return !part.empty() && std::all_of(part.begin(), part.end(),
                                      [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
}

bool alike(const Form& a, const Form& b) {
  const bool counted = a.kind == Form::Kind::vector || a.kind == Form::Kind::list;
  return a.kind == b.kind && a.measure == b.measure && a.limit.same(b.limit) &&
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

std::string Recorder::pattern(const std::string& path) const {
  std::string out, so_far;
  const auto add_conditions = [&] {
    const auto found = conditions_.find(so_far);
    if (found == conditions_.end()) return;
    for (const std::string& condition : found->second) out += "<" + condition + ">";
  };
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string part = path.substr(begin, end - begin);
    so_far = path.substr(0, end);
    const auto word = words_.find(so_far);
    if (word == words_.end() && is_index(part)) {
      out += "[]";
    } else {
      out += (out.empty() ? "" : ".") + (word == words_.end() ? part : word->second);
    }
    add_conditions();
    begin = end + 1;
  }
  return out;
}

void Recorder::note(const std::string& path, const Form& form) {
  if (silent_) return;
  std::vector<Form>& forms = found_[pattern(path)].forms;
  for (Form& known : forms) {
    if (!alike(known, form)) continue;
    known.least = std::min(known.least, form.least);
    known.most = std::max(known.most, form.most);
    return;
  }
  insert(form, forms);
}

void Recorder::note_word(const std::string& path, const std::string& name, const std::string& says) {
  if (silent_) return;
  Known& known = found_[pattern(path)];
  if (!known.form(Form::Kind::word)) insert({Form::Kind::word}, known.forms);
  for (KnownWord& word : known.words) {
    if (word.name != name) continue;
    if (word.says.empty()) word.says = says;
    return;
  }
  known.words.push_back({name, says});
}

void Recorder::note_key(const std::string& map, const std::string& path, bool needed) {
  if (silent_) return;
  const std::string child = pattern(path);
  const std::string key = child.substr(child.rfind('.') + 1);  // npos + 1 is 0
  std::vector<std::string>& keys = found_[pattern(map)].keys;
  const std::string plain = unconditional(key);
  if (std::find(keys.begin(), keys.end(), plain) == keys.end()) keys.push_back(plain);
  Known& known = found_[child];
  known.needed = known.needed || needed;
}

void Recorder::note_standard(const std::string& path, const std::string& text) {
  if (silent_) return;
  Known& known = found_[pattern(path)];
  const auto same = [&](const std::string& before) {  // a vector has a component more in 3-D
    return text == before || (text.front() == '[' && text.starts_with(before.substr(0, before.size() - 1)));
  };
  known.varies = known.varies || (known.standard && !same(*known.standard));
  if (!known.standard) known.standard = text;
}

void Recorder::note_closed(const std::string& map) {
  if (!silent_) found_[pattern(map)].closed = true;
}

void Recorder::note_groups(const std::string& map, const KeyGroups& groups) {
  if (!silent_) found_[pattern(map)].one_of = groups;
}

void Recorder::rename(const std::string& path, const std::string& word) { words_[path] = word; }

void Recorder::enter(const std::string& path, const std::string& condition) {
  conditions_[path].push_back(condition);
}

void Recorder::leave(const std::string& path) { conditions_[path].pop_back(); }

std::string unconditional(const std::string& pattern) {
  std::string out;
  bool inside = false;
  for (const char c : pattern) {
    if (c == '<') inside = true;
    if (!inside) out += c;
    if (c == '>') inside = false;
  }
  return out;
}

}  // namespace mpmfast
