#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "engine/scene/catalogue.hpp"
#include "engine/scene/schema/known_keys.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "engine/scene/sections/describe.hpp"
#include "reference_page.hpp"

namespace mpmfast {

namespace {

/// A line of the page that is replaced by generated text:
///   @about KEY         its form and its meaning
///   @keys MAP KEY …    a table of these keys (the map of all is `scene`)
///   @rest MAP          a table of the keys of a map that no @keys has
///   @units, @models, @shapes, @laws
struct Directive {
  std::string verb, map;
  std::vector<std::string> keys;
};

Directive directive_of(const std::string& line) {
  Directive out;
  std::istringstream words(line);
  words >> out.verb >> out.map;
  if (out.map == "scene") out.map.clear();
  for (std::string key; words >> key;) out.keys.push_back(key);
  return out;
}

std::vector<std::string> page_lines() {
  std::vector<std::string> out;
  std::istringstream page{std::string(kReferencePage)};
  for (std::string line; std::getline(page, line);) out.push_back(line);
  return out;
}

/// All tables of keys.
const std::vector<Directive>& tables() {
  static const std::vector<Directive> kTables = [] {
    std::vector<Directive> out;
    for (const std::string& line : page_lines())
      if (line.starts_with("@keys") || line.starts_with("@rest")) out.push_back(directive_of(line));
    return out;
  }();
  return kTables;
}

const std::string& description_at(const std::string& pattern) { return known_at(pattern).description; }

/// The third column.
std::string default_column(const KnownKey& key) {
  const Known& known = known_at(key.pattern);
  if (known.needed) return "*needed*";
  return known.standard ? fmt::format("`{}`", *known.standard) : "";
}

/// The rows of a table, and below it what the words of its keys mean.
class KeyRows {
 public:
  explicit KeyRows(const std::string& caption) : caption_(caption) {}

  /// The keys of a map inside follow with their path, unless they have a table of their own.
  void add(const KnownKey& key, const std::string& path) {
    text_ += fmt::format("| {} | {} | {} | {}{} |\n", path == "FACE" ? face_names() : "`" + path + "`",
                         form_text(key.pattern, false), default_column(key), condition(key),
                         description_at(key.pattern));
    add_words(key, path);
    if (has_table(key.pattern)) return;
    for (const KnownKey& inner : all_keys(key.pattern)) add(inner, path + "." + inner.name);
  }
  void add(const KnownKeyword& early) {
    text_ += fmt::format("| `{}` | {} | | {} |\n", early.name,
                         early.name == "include" ? "text, or list of texts" : "map", early.description);
  }
  std::string text() const {
    return "| key | form | default | meaning |\n|---|---|---|---|\n" + text_ + words_;
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
  static bool has_table(const std::string& pattern) {
    return std::any_of(tables().begin(), tables().end(),
                       [&](const Directive& table) { return pattern == table.map; });
  }
  void add_words(const KnownKey& key, const std::string& path) {
    const auto& words = known_at(key.pattern).words;
    const bool described = std::any_of(words.begin(), words.end(),
                                       [](const KnownKeyword& word) { return !word.description.empty(); });
    const bool listed = path == "law";
    constexpr std::size_t kFew = 3;  // the form names them
    if (words.empty() || listed || (!described && words.size() <= kFew)) return;
    words_ += path == "FACE" ? "\nThe words:\n\n" : fmt::format("\n`{}`{}", path, described ? ":\n\n" : ": ");
    for (const KnownKeyword& word : words) {
      if (described)
        words_ +=
            fmt::format("- `{}`{}{}\n", word.name, word.description.empty() ? "" : ": ", word.description);
      else
        words_ += fmt::format("{}`{}`", &word == &words.front() ? "" : ", ", word.name);
    }
    if (!described) words_ += "\n";
  }

  std::string caption_, text_, words_;
};

std::string units() {
  std::string out = "| kind | units | a bare number is in |\n|---|---|---|\n";
  for (int k = 1; k < kMeasures; ++k) {
    const QuantityKind& kind = kind_of(static_cast<Measure>(k));
    out += fmt::format("| {} | {} | {} |\n", noun_of(static_cast<Measure>(k)), kind.units, kind.si);
  }
  return out;
}

/// A key that several maps may have.
struct SharedKey {
  std::string name, form, description;
  std::vector<std::string> owners;
};

/// Is it the same key? In the plane it has 2 components, and 3 in a solid.
bool merge(SharedKey& known, const SharedKey& other) {
  if (known.name != other.name || known.description != other.description) return false;
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
    const SharedKey row{key.name, form_text(key.pattern, false), description_at(key.pattern), {owner}};
    const bool known = std::any_of(rows.begin(), rows.end(), [&](SharedKey& r) { return merge(r, row); });
    const auto twin =
        std::find_if(rows.rbegin(), rows.rend(), [&](const SharedKey& r) { return r.name == row.name; });
    if (!known) rows.insert(twin == rows.rend() ? rows.end() : twin.base(), row);
    collect(owner, key.pattern, rows);
  }
}

/// Each key of these maps once; where its form or meaning differs among them, the exceptions follow with
/// their owners.
/// @param before, after  what stands around an owner in the pattern of its map
std::string shared_keys(const std::vector<CatalogueEntry>& owners, const std::string& before,
                        const std::string& after) {
  std::vector<SharedKey> rows;
  for (const CatalogueEntry& owner : owners) collect(owner.name, before + owner.name + after, rows);
  std::string out = "\n| key | form | meaning |\n|---|---|---|\n", last;
  for (const SharedKey& row : rows) {
    const std::string owner = row.name == last ? fmt::format(" ({})", fmt::join(row.owners, ", ")) : "";
    out += fmt::format("| `{}`{} | {} | {} |\n", row.name, owner, row.form, row.description);
    last = row.name;
  }
  return out;
}

std::string entries(const char* head, const std::vector<CatalogueEntry>& all) {
  std::string out = fmt::format("| {} | its keys | |\n|---|---|---|\n", head);
  for (const CatalogueEntry& entry : all)
    out += fmt::format("| `{}` | {} | {} |\n", entry.name, entry.keys, entry.description);
  return out;
}

/// Shapes have a list: their keys stand in no table of bodies.
bool is_listed(const std::string& map) { return map == "bodies[]"; }

/// Does a table name the key, or does a list show it?
bool is_elsewhere(const std::string& map, const std::string& key) {
  for (const auto& group : known_at(map).one_of)
    if (is_listed(map) && group.front() == key) return true;
  return std::any_of(tables().begin(), tables().end(), [&](const Directive& table) {
    return table.map == map && std::find(table.keys.begin(), table.keys.end(), key) != table.keys.end();
  });
}

/// "Exactly one of `box`, `node` must be there."
std::string choice_text(const std::string& map) {
  std::string keys;
  for (const auto& group : known_at(map).one_of)
    keys += fmt::format("{}`{}`", keys.empty() ? "" : ", ", group.front());
  return keys.empty() || is_listed(map) ? "" : fmt::format("Exactly one of {} must be there.\n\n", keys);
}

/// @param caption  the line above the table
std::string table_text(const Directive& table, const std::string& caption) {
  KeyRows rows(caption);
  const std::vector<KnownKey> keys = all_keys(table.map);
  for (const std::string& name : table.keys) {
    for (const KnownKey& key : keys)
      if (key.name == name) rows.add(key, key.name);
    for (const KnownKeyword& early : early_keys())
      if (early.name == name) rows.add(early);
  }
  for (const KnownKey& key : keys)
    if (table.verb == "@rest" && !is_elsewhere(table.map, key.name)) rows.add(key, key.name);
  return choice_text(table.map) + rows.text();
}

/// "`grid` (map, needed): The grid of cubic cells …".
std::string about(const std::string& key) {
  return fmt::format("`{}` ({}{}): {}\n", key, form_text(key, false), known_at(key).needed ? ", needed" : "",
                     description_at(key));
}

/// @param caption  the line of text before it
std::string described(const Directive& directive, const std::string& caption) {
  if (directive.verb == "@about") return about(directive.map);
  if (directive.verb == "@units") return units();
  if (directive.verb == "@laws") return entries("law", catalogue("laws"));
  const auto models = catalogue("materials"), shapes = catalogue("shapes");
  if (directive.verb == "@models")
    return entries("model", models) + shared_keys(models, "materials.NAME<model=", ">");
  if (directive.verb == "@shapes") return entries("shape", shapes) + shared_keys(shapes, "bodies[].", "");
  return table_text(directive, caption);
}

}  // namespace

std::string write_reference() {
  std::string out, caption;
  for (const std::string& line : page_lines()) {
    out += line.starts_with('@') ? described(directive_of(line), caption) : line + "\n";
    if (!line.empty()) caption = line;
  }
  return out;
}

}  // namespace mpmfast
