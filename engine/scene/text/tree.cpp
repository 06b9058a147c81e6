#include "engine/scene/text/tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <utility>

#include "engine/scene/text/text_check.hpp"
#include "engine/scene/text/yaml_fault.hpp"

namespace mpmfast {

namespace {

/// Thrown inside the parser to leave it; the problem is already noted.
struct StopParsing {};

// yaml-cpp would take the braces and commas of `${min(a, b)}` for those of a map. Text has no control
// characters (text_check), so three of them stand in until the parser is past.
constexpr std::array<std::pair<char, char>, 3> kShields{{{'{', '\1'}, {'}', '\2'}, {',', '\3'}}};

std::string shielded(std::string text) {
  for (std::size_t at = text.find("${"); at != std::string::npos; at = text.find("${", at + 2)) {
    const std::size_t end = text.find_first_of("{}\n\"#", at + 2);
    if (end == std::string::npos || text[end] != '}') continue;
    for (std::size_t k = at + 1; k <= end; ++k)
      for (const auto& [mark, shield] : kShields)
        if (text[k] == mark) text[k] = shield;
  }
  return text;
}

std::string unshielded(std::string text) {
  for (char& c : text)
    for (const auto& [mark, shield] : kShields)
      if (c == shield) c = mark;
  return text;
}

/// Builds the tree from the parser's events. Aliases become copies of what they name.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(int source, Problems& problems) : source_(source), problems_(problems) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ > 0) stop(at(mark), "a second document begins here (a scene is one YAML document)");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(make(Node::Kind::null, mark), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    count({0, value.size(), 0}, at(mark));
    Node node = make(Node::Kind::scalar, mark);
    node.scalar = unshielded(value);
    quoted_ = tag == "!";
    finish(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) {
      problems_.add(at(mark), path(), "an alias may not stand inside its own anchor");
      throw StopParsing();
    }
    count(size_of(known->second), at(mark));
    finish(known->second, YAML::NullAnchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(Node::Kind::list, mark, tag, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(Node::Kind::map, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

  const Node& root() const { return root_; }

 private:
  /// A list or map whose end has not come yet.
  struct Frame {
    Node node;
    YAML::anchor_t anchor = YAML::NullAnchor;
    std::optional<Key> key;            ///< read, its value not yet
    std::map<std::string, int> lines;  ///< of all keys so far
    bool drop = false;                 ///< that value belongs to a refused key
  };

  SourceLocation at(const YAML::Mark& mark) const { return {mark.line + 1, mark.column + 1, source_}; }

  Node make(Node::Kind kind, const YAML::Mark& mark) {
    count({1, 0, 0}, at(mark));
    quoted_ = false;
    Node node;
    node.kind = kind;
    node.location = at(mark);
    return node;
  }

  /// Of what begins at the mark, inside all that is open.
  void count(const TreeSize& more, const SourceLocation& location) {
    nodes_ += more.nodes;
    text_ += more.text;
    if (nodes_ > kMostNodes)
      stop(location, fmt::format("too many values (at most {}, aliases expanded)", kMostNodes));
    if (text_ > kMostText)
      stop(location, fmt::format("too much text (at most {} bytes, aliases expanded)", kMostText));
    if (frames_.size() + more.levels > kDeepest)
      stop(location, fmt::format("nested too deeply (at most {} levels, aliases expanded)", kDeepest));
  }

  [[noreturn]] void stop(const SourceLocation& location, std::string why) {
    problems_.add(location, "", std::move(why));
    throw StopParsing();
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    problems_.add(at(mark), path(), fmt::format("tags are not supported, got '{}'", unshielded(tag)));
  }

  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    refuse_tag(mark, tag);
    count({0, 0, 1}, at(mark));
    Frame frame;
    frame.node = make(kind, mark);
    frame.anchor = anchor;
    frames_.push_back(std::move(frame));
  }

  void close() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    quoted_ = false;
    finish(std::move(frame.node), frame.anchor);
  }

  /// Hands a complete node to what encloses it.
  void finish(Node node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) {
      count(size_of(node), node.location);
      anchors_[anchor] = node;
    }
    if (frames_.empty()) {
      root_ = std::move(node);
      return;
    }
    Frame& frame = frames_.back();
    if (frame.node.kind == Node::Kind::list) {
      frame.node.items.push_back(std::move(node));
    } else if (!frame.key) {
      take_key(frame, node);
    } else {
      if (!frame.drop) {
        frame.node.keys.push_back(std::move(*frame.key));
        frame.node.items.push_back(std::move(node));
      }
      frame.key.reset();
    }
  }

  void take_key(Frame& frame, const Node& node) {
    const std::string parent = path();
    frame.key = Key{node.scalar, node.location};
    frame.drop = true;
    if (node.kind != Node::Kind::scalar) {
      problems_.add(node.location, parent, "a key must be a word, got " + describe(node));
    } else if (node.scalar == "<<" && !quoted_) {
      problems_.add(node.location, join(parent, "<<"), "merge keys are not supported",
                    "Put the anchor on a whole value, or use --set");
    } else if (const auto [first, fresh] = frame.lines.emplace(node.scalar, node.location.line); !fresh) {
      problems_.add(node.location, join(parent, node.scalar),
                    fmt::format("already given on line {}", first->second));
    } else {
      frame.drop = false;
    }
  }

  /// Dotted path of the place that the parser has reached.
  std::string path() const {
    std::string out;
    for (const Frame& frame : frames_) {
      if (frame.node.kind == Node::Kind::list) out = join(out, std::to_string(frame.node.items.size()));
      if (frame.key) out = join(out, frame.key->text);
    }
    return out;
  }

  int source_;
  Problems& problems_;
  Node root_;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, Node> anchors_;
  std::size_t nodes_ = 0, text_ = 0;
  int documents_ = 0;
  bool quoted_ = false;  ///< the scalar just read stood in quotes
};

}  // namespace

int index_of(const Node& node, const std::string& key) {
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    if (node.keys[i].text == key) return static_cast<int>(i);
  }
  return -1;
}

const Node* find_value(const Node& node, const std::string& key) {
  const int index = index_of(node, key);
  return index < 0 ? nullptr : &node.items[static_cast<std::size_t>(index)];
}

Node* find_value(Node& node, const std::string& key) {
  return const_cast<Node*>(find_value(std::as_const(node), key));
}

namespace {

/// On one line, cut where it is long.
std::string shown(const std::string& whole) {
  constexpr std::size_t kShown = 60;
  std::string text = whole.substr(0, kShown);
  for (char& c : text) {
    if (c == '\n' || c == '\t') c = ' ';
  }
  return whole.size() > kShown ? text + "…" : text;
}

}  // namespace

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::list:
      return fmt::format("a list of {}", node.items.size());
    case Node::Kind::map:
      return "a map";
    case Node::Kind::scalar:
      break;
  }
  if (node.written.empty()) return fmt::format("'{}'", shown(node.scalar));
  return fmt::format("'{}', which is '{}'", shown(node.written), shown(node.scalar));
}

TreeSize size_of(const Node& node) {
  TreeSize size{1 + node.keys.size(), node.scalar.size(), 0};
  for (const Key& key : node.keys) size.text += key.text.size();
  for (const Node& item : node.items) {
    const TreeSize inner = size_of(item);
    size.nodes += inner.nodes;
    size.text += inner.text;
    size.levels = std::max(size.levels, inner.levels);
  }
  if (node.kind == Node::Kind::list || node.kind == Node::Kind::map) ++size.levels;
  return size;
}

std::string join(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

std::optional<Node> parse_tree(const std::string& text, int source, Problems& problems,
                               const std::string& empty) {
  if (!check_text(text, source, problems)) return std::nullopt;
  TreeBuilder builder(source, problems);
  try {
    std::istringstream stream(shielded(text));
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) {
      problems.add({0, 0, source}, "", empty);
      return std::nullopt;
    }
    Node root = builder.root();
    parser.HandleNextDocument(builder);  // a second one is refused by the builder
    return root;
  } catch (const StopParsing&) {
    return std::nullopt;
  } catch (const YAML::Exception& error) {
    const YamlFault fault = yaml_fault(text, error.mark.line + 1, error.mark.column + 1, error.msg);
    problems.add({fault.line, fault.column, source}, "", fault.message, fault.hint);
    return std::nullopt;
  }
}

}  // namespace mpmfast
