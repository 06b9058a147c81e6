#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "engine/scene/text/parts.hpp"
#include "engine/scene/text/tree.hpp"

namespace mpmfast {

namespace {

/// The entry of a list or map that one part of the path names; a missing key of a map is added, and the
/// reader says whether it may be there.
Node* descend(Node& node, const std::string& part, const std::string& parent, const SourceLocation& location,
              Problems& problems) {
  if (node.kind == Node::Kind::null) node.kind = Node::Kind::map;
  if (node.kind == Node::Kind::map) {
    if (Node* known = find_value(node, part)) return known;
    node.keys.push_back({part, location});
    node.items.emplace_back().location = location;
    return &node.items.back();
  }
  const std::string label = parent.empty() ? "the scene" : parent;
  if (node.kind == Node::Kind::scalar) {
    problems.add(location, join(parent, part), fmt::format("no such key ({} is {})", label, describe(node)));
    return nullptr;
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc() && end == part.data() + part.size() && index < node.items.size()) {
    return &node.items[index];
  }
  std::string hint;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    const Node* name = find_value(node.items[k], "name");
    if (name && name->scalar == part)
      hint = fmt::format("Did you mean '{}'?", join(parent, std::to_string(k)));
  }
  problems.add(location, join(parent, part),
               fmt::format("no such entry ({} is a list, its entries are 0 to {})", label,
                           static_cast<long>(node.items.size()) - 1),
               hint);
  return nullptr;
}

}  // namespace

void apply_override(Node& root, const std::string& path, const std::string& value, int source,
                    Problems& problems) {
  const SourceLocation location{0, 0, source};
  const std::vector<std::string_view> parts = parts_of(path, '.');
  if (parts.empty() || std::find(parts.begin(), parts.end(), "") != parts.end())
    return problems.add(location, path,
                        "not a path (words joined by points were expected, such as time.cfl)");
  std::optional<Node> parsed = parse_tree(value, source, problems, "no value after '='");
  if (!parsed) return;
  Node* node = &root;
  std::string parent;
  for (const std::string_view part : parts) {
    const std::string key(part);
    node = descend(*node, key, parent, location, problems);
    if (!node) return;
    parent = join(parent, key);
  }
  *node = std::move(*parsed);
}

}  // namespace mpmfast
