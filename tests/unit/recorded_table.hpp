#pragma once

/// @file Tables of scenes in tests/recorded, and of what is said of each: README.md there has their format.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "engine/quantities/quantity.hpp"
#include "scene_helpers.hpp"
#include "tests/source_folder.hpp"

namespace mpmfast::test::recorded {

/// What is shown of a good scene, line by line.
using Shown = std::function<std::vector<std::string>(const Scene&)>;
/// Are the warnings of a good scene shown too?
enum class Warnings { shown, hidden };

inline constexpr double kShare = 1e-6;

inline std::filesystem::path folder() { return source_folder() / "tests" / "recorded"; }

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Where the number that begins here ends: "1.5e-07", "0"; here, where none begins.
inline std::size_t end_of_number(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  if (end == at) return at;
  if (end + 1 < text.size() && text[end] == '.' && is_digit(text[end + 1]))
    for (++end; end < text.size() && is_digit(text[end]);) ++end;
  if (end < text.size() && text[end] == 'e') {
    std::size_t digits = end + 1;
    if (digits < text.size() && (text[digits] == '-' || text[digits] == '+')) ++digits;
    if (digits < text.size() && is_digit(text[digits]))
      for (end = digits; end < text.size() && is_digit(text[end]);) ++end;
  }
  return end;
}

inline std::string with_breaks(std::string text) {
  for (std::size_t at = text.find("\\n"); at != std::string::npos; at = text.find("\\n", at + 1))
    text.replace(at, 2, "\n");
  return text;
}

/// One entry of a table: a scene, what is changed in it, and what is said of it.
struct Entry {
  std::string scene, from;
  std::vector<std::pair<std::string, std::string>> edits;
  std::vector<Override> overrides;
  std::vector<std::string> expected;
  std::vector<std::string> written;  ///< its lines but for what is said
};

struct RecordedTable {
  std::map<std::string, std::string> scenes;
  std::vector<Entry> entries;
  std::vector<std::string> head;  ///< the lines before the entries
};

inline RecordedTable read_table(const std::filesystem::path& file) {
  RecordedTable table;
  std::ifstream stream(file);
  REQUIRE_MESSAGE(stream.good(), file.string());
  std::string scene, naming;
  bool begun = false;
  const auto entry = [&]() -> Entry& {
    if (!begun) table.entries.push_back({scene, "", {}, {}, {}, {}});
    begun = true;
    return table.entries.back();
  };
  for (std::string line; std::getline(stream, line);) {
    const std::string kind = line.substr(0, 2), rest = line.size() > 2 ? line.substr(2) : "";
    if (line.empty()) {
      if (table.entries.empty()) table.head.push_back(line);
      begun = false;
    } else if (kind == "# ") {
      table.entries.empty() ? table.head.push_back(line) : entry().written.push_back(line);
    } else if (kind == "* ") {  // a scene that entries change
      naming = rest;
      table.head.push_back(line);
    } else if (kind == "| ") {
      table.scenes[naming] += rest + "\n";
      table.head.push_back(line);
    } else if (kind == "> ") {
      entry().expected.push_back(rest);
    } else {
      Entry& now = entry();
      now.written.push_back(line);
      if (kind == "@ ") {  // this scene, and those of the entries that follow
        now.scene = scene = rest;
      } else if (kind == "- ") {
        now.from = with_breaks(rest);
      } else if (kind == "+ " || kind == "+") {
        now.edits.emplace_back(now.from, with_breaks(rest));
      } else {
        REQUIRE_MESSAGE(kind == "$ ", line);
        const std::size_t equals = rest.find('=');
        now.overrides.emplace_back(rest.substr(0, equals), with_breaks(rest.substr(equals + 1)));
      }
    }
  }
  return table;
}

/// The lines of one that the other lacks; a line that is there twice is lacked once.
inline std::vector<std::string> beyond(const std::vector<std::string>& one, std::vector<std::string> other,
                                       const char* mark) {
  std::vector<std::string> out;
  for (const std::string& line : one) {
    const auto known = std::find(other.begin(), other.end(), line);
    if (known != other.end())
      other.erase(known);
    else
      out.push_back(mark + line);
  }
  return out;
}

/// What is gone, but for what has another value now.
inline std::vector<std::string> without_keys_of(const std::vector<std::string>& now,
                                                std::vector<std::string> gone) {
  const auto key_of = [](const std::string& line) { return line.substr(2, line.find(": ") - 1); };
  std::multiset<std::string> keys;
  for (const std::string& line : now) keys.insert(key_of(line));
  std::erase_if(gone, [&](const std::string& line) {
    const auto known = keys.find(key_of(line));
    if (known == keys.end()) return false;
    keys.erase(known);
    return true;
  });
  return gone;
}

/// No path of this machine, and no place of an override that its key tells already.
inline std::string without_paths(std::string text, const std::vector<Override>& overrides) {
  const auto remove = [&](const std::string& part, const std::string& by) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size()))
      text.replace(at, part.size(), by);
  };
  remove(folder().string(), "RECORDED");
  for (const auto& [path, value] : overrides) remove(fmt::format("--set {}={}: ", path, value), "");
  return text;
}

struct Said {
  std::vector<std::string> faults, shown;
};

inline Said said_of(const std::string& text, const std::vector<Override>& overrides, const Shown& shown,
                    Warnings warnings_are) {
  Said said;
  std::vector<Diagnostic> warnings;
  try {
    const Scene scene = parse_scene(text, folder() / "scene.yaml", overrides, &warnings);
    if (warnings_are == Warnings::shown)
      for (const Diagnostic& warning : warnings)
        said.shown.push_back(without_paths(warning.warning(), overrides));
    for (const std::string& line : shown(scene)) said.shown.push_back(without_paths(line, overrides));
  } catch (const SceneError& error) {
    for (const Diagnostic& fault : error.diagnostics())
      said.faults.push_back(without_paths(fault.text(), overrides));
  }
  for (auto* lines : {&said.faults, &said.shown})
    for (std::string& line : *lines) line = line.starts_with("RECORDED/scene.yaml:") ? line.substr(20) : line;
  return said;
}

/// Do two lines agree? Their words must, and their numbers to a share of 1e-6.
inline bool same_line(const std::string& one, const std::string& other) {
  std::size_t i = 0, j = 0;
  while (i < one.size() && j < other.size()) {
    const std::size_t end = end_of_number(one, i), other_end = end_of_number(other, j);
    if (end == i || other_end == j) {
      if (one[i++] != other[j++]) return false;
      continue;
    }
    const auto a = parse_number(one.substr(i, end - i)), b = parse_number(other.substr(j, other_end - j));
    if (!a || !b) {
      if (one.substr(i, end - i) != other.substr(j, other_end - j)) return false;
    } else if (std::abs(*a - *b) > kShare * std::max(std::abs(*a), std::abs(*b))) {
      return false;
    }
    i = end;
    j = other_end;
  }
  return i == one.size() && j == other.size();
}

/// What is said of each scene of a table is what stands there. With MPMFAST_RECORD=FOLDER in the environment
/// the table is written into that folder as it would have to be, to be read before it is taken over.
inline void check_table(const std::string& name, const Shown& shown, Warnings warnings = Warnings::hidden) {
  RecordedTable table = read_table(folder() / name);
  if (table.scenes.empty()) table.scenes = read_table(folder() / "reader_scenes.txt").scenes;
  const char* const record = std::getenv("MPMFAST_RECORD");
  std::string out;
  for (const std::string& line : table.head) out += line + "\n";
  std::map<std::string, std::vector<std::string>> plain;
  for (const Entry& entry : table.entries) {
    std::string text = table.scenes.at(entry.scene), what;
    for (const std::string& line : entry.written) what += line + "\n";
    CAPTURE(what);
    for (const auto& [from, to] : entry.edits) {
      REQUIRE_MESSAGE(text.find(from) != std::string::npos, from);
      text = replaced(text, from, to);
    }
    const bool changed = !entry.edits.empty() || !entry.overrides.empty();
    if (changed && !plain.contains(entry.scene))
      plain[entry.scene] = said_of(table.scenes.at(entry.scene), {}, shown, warnings).shown;
    const Said said = said_of(text, entry.overrides, shown, warnings);
    std::vector<std::string> lines = said.faults;
    if (said.faults.empty() && !changed) lines = said.shown;
    if (said.faults.empty() && changed) {
      lines = beyond(said.shown, plain[entry.scene], "+ ");
      const auto gone = without_keys_of(lines, beyond(plain[entry.scene], said.shown, "- "));
      lines.insert(lines.end(), gone.begin(), gone.end());
    }
    out += what;
    for (const std::string& line : lines) out += "> " + line + "\n";
    out += "\n";
    if (record) continue;
    CHECK(lines.size() == entry.expected.size());
    for (std::size_t k = 0; k < std::min(lines.size(), entry.expected.size()); ++k)
      CHECK_MESSAGE(same_line(lines[k], entry.expected[k]), lines[k], "\nwas expected to be\n",
                    entry.expected[k]);
  }
  if (record) std::ofstream(std::filesystem::path(record) / name) << out;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// These lines are those of a file, in which nothing else stands.
inline void check_lines_of(const std::string& name, const std::vector<std::string>& lines) {
  if (const char* const record = std::getenv("MPMFAST_RECORD")) {
    std::ofstream out(std::filesystem::path(record) / name);
    for (const std::string& line : lines) out << line << "\n";
    return;
  }
  std::ifstream stream(folder() / name);
  std::vector<std::string> expected;
  for (std::string line; std::getline(stream, line);) expected.push_back(line);
  CHECK(lines.size() == expected.size());
  for (std::size_t k = 0; k < std::min(lines.size(), expected.size()); ++k)
    CHECK_MESSAGE(same_line(lines[k], expected[k]), lines[k], "\nwas expected to be\n", expected[k]);
}

}  // namespace mpmfast::test::recorded
