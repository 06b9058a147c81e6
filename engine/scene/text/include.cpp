#include "engine/scene/text/include.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "engine/geometry/read_regular.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 64;

/// `from` wins where both say something.
void merge(Node& into, Node from) {
  if (into.kind != Node::Kind::map || from.kind != Node::Kind::map) {
    into = std::move(from);
    return;
  }
  into.location = from.location;
  for (std::size_t k = 0; k < from.keys.size(); ++k) {
    const int index = index_of(into, from.keys[k].text);
    if (index < 0) {
      into.keys.push_back(std::move(from.keys[k]));
      into.items.push_back(std::move(from.items[k]));
    } else {
      into.keys[static_cast<std::size_t>(index)] = std::move(from.keys[k]);
      merge(into.items[static_cast<std::size_t>(index)], std::move(from.items[k]));
    }
  }
}

/// A path that is to count from `folder`, wherever the reader counts from.
void anchor(Node* path, const fs::path& folder) {
  if (!path || path->kind != Node::Kind::scalar || fs::path(path->scalar).is_absolute()) return;
  std::string from = fs::absolute(folder).lexically_normal().string();
  for (std::size_t at = from.find("${"); at != std::string::npos; at = from.find("${", at + 3))
    from.insert(at, "$");
  path->written = path->scalar;
  path->scalar = (fs::path(from) / path->scalar).string();
}

/// Pictures and surfaces of the bodies.
void anchor_paths(Node& root, const fs::path& folder) {
  Node* bodies = find_value(root, "bodies");
  if (!bodies || bodies->kind != Node::Kind::list) return;
  for (Node& body : bodies->items) {
    for (const char* kind : {"bitmap", "stl"}) {
      Node* shape = find_value(body, kind);
      anchor(shape && shape->kind == Node::Kind::map ? find_value(*shape, "file") : shape, folder);
    }
  }
}

class Includer {
 public:
  Includer(const fs::path& file, Problems& problems) : problems_(problems) {
    open_.push_back(known_as(file));
  }

  /// @param folder  of the file that the tree was read from
  void resolve(Node& root, const fs::path& folder, const std::string& path = "include") {
    const int index = index_of(root, "include");
    if (index < 0) return;
    const Node names = std::move(root.items[static_cast<std::size_t>(index)]);
    root.items.erase(root.items.begin() + index);
    root.keys.erase(root.keys.begin() + index);
    Node merged;
    merged.kind = Node::Kind::map;
    if (names.kind == Node::Kind::list) {
      for (std::size_t k = 0; k < names.items.size(); ++k)
        take(names.items[k], join(path, std::to_string(k)), folder, merged);
    } else {
      take(names, path, folder, merged);
    }
    const SourceLocation location = root.location;
    merge(merged, std::move(root));
    root = std::move(merged);
    root.location = location;
  }

 private:
  static constexpr std::size_t kDeepestInclude = 8;

  static std::string known_as(const fs::path& file) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(file, error);
    return (error ? file : whole).string();
  }

  void take(const Node& name, const std::string& path, const fs::path& folder, Node& merged) {
    if (name.kind != Node::Kind::scalar || name.scalar.empty())
      return problems_.add(name.location, path,
                           "not a file name or a list of file names, got " + describe(name));
    const fs::path file = (folder / name.scalar).lexically_normal();
    const auto refuse = [&](const std::string& why, const std::string& hint = "") {
      problems_.add(name.location, path, fmt::format("cannot include {}: {}", file.string(), why), hint);
    };
    const std::string known = known_as(file);
    if (std::find(open_.begin(), open_.end(), known) != open_.end())
      return refuse("it includes this file, or is it");
    if (open_.size() > kDeepestInclude)
      return refuse(fmt::format("nested too deeply (at most {} files within each other)", kDeepestInclude));
    if (++files_ > kMostFiles) return refuse(fmt::format("too many files (at most {})", kMostFiles));
    std::string why_not;
    const auto text = read(file, why_not);
    if (!text)
      return refuse(why_not,
                    name.scalar.find("${") == std::string::npos ? "" : "Its name takes no variables");
    auto root = parse_tree(*text, problems_.add_file(file.string()), problems_,
                           "empty (a map of sections was expected)");
    if (!root) return;
    if (root->kind != Node::Kind::map)
      return problems_.add(root->location, "",
                           "not a map of sections such as materials, got " + describe(*root));
    const TreeSize size = size_of(*root);
    nodes_ += size.nodes;
    bytes_ += size.text;
    if (nodes_ > kMostNodes || bytes_ > kMostText)
      return refuse(fmt::format("too much in all (at most {} values, {} bytes)", kMostNodes, kMostText));
    open_.push_back(known);
    anchor_paths(*root, file.parent_path());
    resolve(*root, file.parent_path());
    open_.pop_back();
    merge(merged, std::move(*root));
  }

  std::optional<std::string> read(const fs::path& file, std::string& why_not) {
    std::error_code error;
    const auto size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
    if (!error && (read_ += size) > kMostText) {
      why_not = "larger than 16 MiB, with the files before it";
      return std::nullopt;
    }
    return read_regular(file, kMostText, why_not);
  }

  Problems& problems_;
  std::vector<std::string> open_;  ///< the files around this one, the scene first
  std::size_t files_ = 0, nodes_ = 0, bytes_ = 0;
  std::uintmax_t read_ = 0;  ///< bytes
};

}  // namespace

void merge_includes(Node& root, const fs::path& file, Problems& problems) {
  if (root.kind == Node::Kind::map) Includer(file, problems).resolve(root, file.parent_path());
}

}  // namespace mpmfast
