#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "engine/scene/schema/known_keys.hpp"
#include "engine/scene/schema/reference_parts.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

constexpr const char* kIntroduction =
    "# Scenes, key by key\n\n"
    "This page is what `mpmfast schema --markdown` prints: do not edit it. The fragments of its sections, "
    "put "
    "together, are a scene that runs. `mpmfast check SCENE` says all that is wrong with one, with line and "
    "key; "
    "unknown keys are errors.\n\n"
    "An editor that knows JSON Schema completes and explains all keys as you type, with the YAML language "
    "server for "
    "instance: write the schema once, `mpmfast schema > mpmfast-scene.schema.json`, and begin a scene with "
    "the "
    "line\n\n"
    "```\n# yaml-language-server: $schema=mpmfast-scene.schema.json\n```\n";

const std::string& sentence_on(const std::string& pattern) { return known_at(pattern).says; }

/// The third column.
std::string default_column(const KnownKey& key) {
  const Known& known = known_at(key.pattern);
  if (known.needed) return "*needed*";
  return known.standard ? fmt::format("`{}`", *known.standard) : "";
}

/// The rows of a table, and below it what the words of its keys mean.
class KeyRows {
 public:
  KeyRows(const ReferencePart& part, const KeyTable& table) : part_(part), caption_(table.says) {}

  /// The keys of a map inside follow with their path, unless they have a table or a list of their own.
  void add(const KnownKey& key, const std::string& path) {
    text_ += fmt::format("| {} | {} | {} | {}{} |\n", path == "FACE" ? face_names() : "`" + path + "`",
                         form_text(key.pattern, false), default_column(key), condition(key),
                         sentence_on(key.pattern));
    add_words(key, path);
    if (has_table(key.pattern)) return;
    for (const KnownKey& inner : all_keys(key.pattern)) add(inner, path + "." + inner.name);
  }
  void add(const KnownWord& early) {
    text_ += fmt::format("| `{}` | {} | | {} |\n", early.name,
                         early.name == "include" ? "text, or list of texts" : "map", early.says);
  }
  std::string text() const {
    return "\n| key | form | default | meaning |\n|---|---|---|---|\n" + text_ + words_;
  }

 private:
  /// Under which condition the key is there at all, unless the line above the table says so.
  std::string condition(const KnownKey& key) const {
    if (key.condition == "3d") return "3-D: ";
    const bool said = caption_.find("`" + key.condition + "`") != std::string::npos;
    return key.condition.empty() || key.condition[0] == '!' || said ? "" : "With `" + key.condition + "`: ";
  }
  static std::string face_names() {
    std::string out;
    for (const FaceName& face : kFaces) out += fmt::format("{}`{}`", out.empty() ? "" : ", ", face.name);
    return out;
  }
  bool has_table(const std::string& pattern) const {
    return std::any_of(part_.tables.begin(), part_.tables.end(),
                       [&](const KeyTable& table) { return pattern == table.map; });
  }
  void add_words(const KnownKey& key, const std::string& path) {
    const auto& words = known_at(key.pattern).words;
    const bool told =
        std::any_of(words.begin(), words.end(), [](const KnownWord& word) { return !word.says.empty(); });
    const bool listed = part_.list != ReferencePart::List::none && (path == "model" || path == "law");
    constexpr std::size_t kFew = 3;  // the form names them
    if (words.empty() || listed || (!told && words.size() <= kFew)) return;
    words_ += path == "FACE" ? "\nThe words:\n\n" : fmt::format("\n`{}`{}", path, told ? ":\n\n" : ": ");
    for (const KnownWord& word : words) {
      if (told)
        words_ += fmt::format("- `{}`{}{}\n", word.name, word.says.empty() ? "" : ": ", word.says);
      else
        words_ += fmt::format("{}`{}`", &word == &words.front() ? "" : ", ", word.name);
    }
    if (!told) words_ += "\n";
  }

  const ReferencePart& part_;
  const std::string caption_;
  std::string text_, words_;
};

std::string units() {
  std::string out = "\n| kind | units | a bare number is in |\n|---|---|---|\n";
  for (int k = 1; k < kMeasures; ++k) {
    const QuantityKind& kind = kind_of(static_cast<Measure>(k));
    const std::string name = kind.name;
    out += fmt::format("| {} | {} | {} |\n", name.substr(name.find(' ') + 1), kind.units, kind.si);
  }
  return out;
}

/// A key that several maps may have.
struct SharedKey {
  std::string name, form, says;
  std::vector<std::string> owners;
};

/// Is it the same key? In the plane it has 2 components, and 3 in a solid.
bool merge(SharedKey& known, const SharedKey& other) {
  if (known.name != other.name || known.says != other.says) return false;
  if (known.form != other.form) {
    const bool counted = known.form.starts_with("2 ") && other.form.starts_with("3 ");
    const bool both = known.form.starts_with("2 or 3 ");
    if (!counted && !both) return false;
    const std::string rest = other.form.substr(2);
    if (known.form.substr(both ? 7 : 2) != rest) return false;
    known.form = "2 or 3 " + rest;
  }
  known.owners.push_back(other.owners.front());
  return true;
}

void collect(const std::string& owner, const std::string& map, std::vector<SharedKey>& rows) {
  for (const KnownKey& key : all_keys(map)) {
    const SharedKey row{key.name, form_text(key.pattern, false), sentence_on(key.pattern), {owner}};
    const bool known = std::any_of(rows.begin(), rows.end(), [&](SharedKey& r) { return merge(r, row); });
    const auto twin =
        std::find_if(rows.rbegin(), rows.rend(), [&](const SharedKey& r) { return r.name == row.name; });
    if (!known) rows.insert(twin == rows.rend() ? rows.end() : twin.base(), row);
    collect(owner, key.pattern, rows);
  }
}

/// Each key once; where its form or meaning differs among the maps, the exceptions follow with their owners.
std::string shared_keys(const std::vector<std::pair<std::string, std::string>>& named_maps) {
  std::vector<SharedKey> rows;
  for (const auto& [name, map] : named_maps) collect(name, map, rows);
  std::string out = "\n| key | form | meaning |\n|---|---|---|\n", before;
  for (const SharedKey& row : rows) {
    const std::string owner = row.name == before ? fmt::format(" ({})", fmt::join(row.owners, ", ")) : "";
    out += fmt::format("| `{}`{} | {} | {} |\n", row.name, owner, row.form, row.says);
    before = row.name;
  }
  return out;
}

template <class Kind>
std::string kinds(const char* head, const std::vector<Kind>& all, const std::string& before,
                  const std::string& after) {
  std::string out = fmt::format("\n| {} | its keys | |\n|---|---|---|\n", head);
  std::vector<std::pair<std::string, std::string>> maps;
  for (const Kind& kind : all) {
    const std::string map = before + kind.name + after;
    out += fmt::format("| `{}` | {} | {} |\n", kind.name, keys_text(map), kind.says);
    maps.emplace_back(kind.name, map);
  }
  return out + shared_keys(maps);
}

std::string laws() {
  std::string out = "\n| law | its keys | |\n|---|---|---|\n";
  for (const ContactLawKind& law : contact_laws()) {
    out += fmt::format("| `{}` | {} | {} |\n", law.name, law_keys_text(law), law.says);
  }
  return out;
}

std::string list_text(ReferencePart::List list) {
  switch (list) {
    case ReferencePart::List::units:
      return units();
    case ReferencePart::List::models:
      return kinds("model", material_kinds(), "materials.NAME<model=", ">");
    case ReferencePart::List::shapes:
      return kinds("shape", shape_kinds(), "bodies[].", "");
    case ReferencePart::List::laws:
      return laws();
    case ReferencePart::List::none:
      break;
  }
  return "";
}

}  // namespace

namespace {

/// Does a table of this part name the key, or does a list show it?
bool is_elsewhere(const ReferencePart& part, const std::string& map, const std::string& key) {
  if (part.list == ReferencePart::List::shapes) {
    for (const auto& group : known_at(map).one_of)
      if (group.front() == key) return true;
  }
  return std::any_of(part.tables.begin(), part.tables.end(), [&](const KeyTable& table) {
    return table.map == map && std::find(table.keys.begin(), table.keys.end(), key) != table.keys.end();
  });
}

/// "Exactly one of `box`, `node` must be there."
std::string choice_text(const ReferencePart& part, const std::string& map) {
  std::string keys;
  for (const auto& group : known_at(map).one_of)
    keys += fmt::format("{}`{}`", keys.empty() ? "" : ", ", group.front());
  if (keys.empty() || part.list == ReferencePart::List::shapes) return "";
  return fmt::format("\nExactly one of {} must be there.\n", keys);
}

/// Lines of at most 120 bytes.
std::string wrapped(const std::string& text) {
  constexpr std::size_t kWidest = 120;
  std::string out, word;
  std::size_t width = 0;
  const auto flush = [&](char after) {
    if (width + word.size() > kWidest) {
      if (!out.empty() && out.back() == ' ') out.back() = '\n';
      width = 0;
    }
    out += word + after;
    width = after == '\n' ? 0 : width + word.size() + 1;
    word.clear();
  };
  for (const char c : text) c == ' ' || c == '\n' ? flush(c) : word.push_back(c);
  return out + word;
}

std::string table_text(const ReferencePart& part, const KeyTable& table) {
  KeyRows rows(part, table);
  const std::vector<KnownKey> keys = all_keys(table.map);
  for (const std::string_view name : table.keys) {
    for (const KnownKey& key : keys)
      if (key.name == name) rows.add(key, key.name);
    for (const KnownWord& early : early_keys())
      if (early.name == name) rows.add(early);
  }
  if (table.keys.empty())
    for (const KnownKey& key : keys)
      if (!is_elsewhere(part, table.map, key.name)) rows.add(key, key.name);
  return (*table.says ? fmt::format("\n{}\n", table.says) : "") + choice_text(part, table.map) + rows.text();
}

}  // namespace

std::string write_reference() {
  std::string out = wrapped(kIntroduction);
  for (const ReferencePart& part : reference_parts()) {
    out += fmt::format("\n## {}\n", part.title);
    if (*part.key)
      out += fmt::format("\n`{}` ({}{}): {}\n", part.key, form_text(part.key, false),
                         known_at(part.key).needed ? ", needed" : "", sentence_on(part.key));
    if (*part.says) out += wrapped(fmt::format("\n{}\n", part.says));
    if (*part.example) out += fmt::format("\n```yaml\n{}```\n", part.example);
    out += list_text(part.list);
    for (const KeyTable& table : part.tables) out += table_text(part, table);
  }
  return out;
}

}  // namespace mpmfast
