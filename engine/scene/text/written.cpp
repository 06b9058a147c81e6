#include "engine/scene/text/written.hpp"

#include <fmt/format.h>

namespace mpmfast {

namespace {

bool holds_maps(const Written& list) {
  return list.kind == Written::Kind::list && !list.items.empty() &&
         list.items[0].value.kind == Written::Kind::map;
}

/// "key: value" and, where the value has lines of its own, those below.
void entry(const std::string& key, const Written& value, int level, std::string& out) {
  const std::string before(static_cast<std::size_t>(2 * level), ' ');
  if (holds_maps(value)) {
    out += fmt::format("{}{}:\n", before, key);
    for (const auto& [none, map] : value.items) {
      if (level > 0) {
        out += fmt::format("{}  - {}\n", before, map.flow());
        continue;
      }
      std::string lines;
      for (const auto& [name, inner] : map.items) entry(name, inner, level + 2, lines);
      const auto indented = static_cast<std::size_t>(2 * level + 2);
      out += lines.replace(indented, 1, "-");
    }
  } else if (value.kind == Written::Kind::map && level == 0) {
    out += fmt::format("{}{}:\n", before, key);
    for (const auto& [name, inner] : value.items) entry(name, inner, level + 1, out);
  } else {
    out += fmt::format("{}{}: {}\n", before, key, value.flow());
  }
}

}  // namespace

std::string Written::flow() const {
  if (kind == Kind::scalar) return text;
  std::string out;
  for (const auto& [key, value] : items) {
    if (!out.empty()) out += ", ";
    if (kind == Kind::map) out += key + ": ";
    out += value.flow();
  }
  return kind == Kind::map ? "{" + out + "}" : "[" + out + "]";
}

std::string layout(const Written& scene) {
  std::string out;
  for (const auto& [key, value] : scene.items) entry(key, value, 0, out);
  return out;
}

std::string quoted_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else if (c == '{' && out.back() == '$') {
      out += "${";  // "$${" is read as "${"
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string name_text(const std::string& name) {
  const bool null = name == "null" || name == "Null" || name == "NULL";
  return null || name.front() == '-' ? quoted_text(name) : name;
}

}  // namespace mpmfast
