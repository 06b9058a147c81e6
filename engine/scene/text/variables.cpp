#include "engine/scene/text/variables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "engine/quantities/expression.hpp"
#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kMostVariables = 1000;
constexpr std::size_t kLongestChain = 32;         // of variables that name each other
constexpr std::size_t kLongestExpression = 1000;  // characters

struct Variable {
  Key key;
  Node* node = nullptr;
  std::string path;
  enum class State { written, open, good, bad } state = State::written;
  bool used = false;
};

bool may_name_variable(const std::string& text) {
  const auto good = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  return !text.empty() && std::all_of(text.begin(), text.end(), good) &&
         !std::isdigit(static_cast<unsigned char>(text[0])) && text != "pi";
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

class Expander {
 public:
  Expander(Node& root, Problems& problems, const std::set<std::string>& used)
      : root_(root), problems_(problems), used_(used) {}

  void all() {
    collect();
    for (Variable& variable : variables_) settle(variable);
    for (std::size_t k = 0; k < root_.items.size(); ++k)
      if (root_.keys[k].text != "variables") walk(root_.items[k], root_.keys[k].text);
    report_unused();
  }

 private:
  void collect() {
    Node* const found = find_value(root_, "variables");
    if (!found) return;
    Node& section = *found;
    if (section.kind != Node::Kind::map) {
      return problems_.add(section.location, "variables",
                           "not a map of names and values such as {dx: 0.5 mm}, got " + describe(section));
    }
    if (section.items.size() > kMostVariables) {
      return problems_.add(section.location, "variables",
                           fmt::format("{} variables (at most {})", section.items.size(), kMostVariables));
    }
    for (std::size_t k = 0; k < section.items.size(); ++k) {
      const Key& key = section.keys[k];
      Variable variable{key, &section.items[k], join("variables", key.text)};
      variable.used = used_.contains(key.text);
      if (!may_name_variable(key.text)) {
        variable.used = true;  // one complaint is enough
        problems_.add(key.location, variable.path,
                      key.text == "pi"
                          ? "pi is known already"
                          : "not a name for a variable (letters, digits and '_', no digit first)");
      }
      index_[key.text] = variables_.size();
      names_.push_back(key.text);
      variables_.push_back(std::move(variable));
    }
  }

  /// Computes a variable, once; those that it names first.
  void settle(Variable& variable) {
    using State = Variable::State;
    if (variable.state != State::written) return;
    variable.state = State::open;
    chain_.push_back(variable.key.text);
    const std::size_t before = problems_.count();
    Node& node = *variable.node;
    if (node.kind != Node::Kind::scalar)
      problems_.add(node.location, variable.path, "not a number, a quantity or text, got " + describe(node));
    else
      expand(node, variable.path);
    variable.state = problems_.count() > before || node.faulty ? State::bad : State::good;
    chain_.pop_back();
  }

  void walk(Node& node, const std::string& path) {
    for (std::size_t k = 0; k < node.items.size(); ++k)
      walk(node.items[k], join(path, node.kind == Node::Kind::map ? node.keys[k].text : std::to_string(k)));
    if (node.kind == Node::Kind::scalar) expand(node, path);
  }

  void fault(Node& node, const std::string& path, const std::string& what, const std::string& hint = "") {
    if (!node.faulty)
      problems_.add(node.location, path, fmt::format("{}, got {}", what, describe(node)), hint);
    node.faulty = true;
  }

  /// The value of a node, piece by piece.
  void expand(Node& node, const std::string& path) {
    const std::string& text = node.scalar;
    if (text.find("${") == std::string::npos) return;
    std::string out;
    std::size_t at = 0;
    while (at < text.size() && !node.faulty) {
      if (text.compare(at, 3, "$${") == 0) {
        out += "${";
        at += 3;
      } else if (text.compare(at, 2, "${") == 0) {
        const std::size_t end = text.find('}', at);
        if (end == std::string::npos) return fault(node, path, "a '}' is missing after '${'");
        const bool whole = at == 0 && end + 1 == text.size();
        out += compute(node, path, text.substr(at + 2, end - at - 2), whole);
        at = end + 1;
      } else {
        out += text[at++];
      }
    }
    total_ += out.size();
    if (total_ > kMostText)
      fault(node, path, fmt::format("too much text (at most {} bytes, expressions expanded)", kMostText));
    if (node.faulty) return;
    if (node.written.empty()) node.written = std::move(node.scalar);
    node.scalar = std::move(out);
  }

  /// What stands for one `${…}`; nothing when the node has become faulty.
  std::string compute(Node& node, const std::string& path, const std::string& inside, bool whole) {
    const std::string text = trimmed(inside);
    const auto refuse = [&](const std::string& what, const std::string& hint = "") {
      fault(node, path, whole ? what : fmt::format("{} in '${{{}}}'", what, inside), hint);
      return std::string();
    };
    if (text.empty()) return refuse("nothing between '${' and '}'");
    if (text.size() > kLongestExpression)
      return refuse(fmt::format("too long an expression (at most {} characters)", kLongestExpression));
    if (Variable* variable = find(text)) {
      if (!use(*variable, node, path)) return "";
      return variable->node->scalar;
    }
    const auto parsed = Expression::parse(text);
    if (const auto* wrong = std::get_if<std::string>(&parsed)) return refuse("not an expression: " + *wrong);
    const Expression& expression = std::get<Expression>(parsed);
    for (const std::string& name : expression.names_after_units())
      if (find(name) && unit_named(name))
        return refuse(fmt::format("'{}' is a variable and a unit", name),
                      "Put brackets round the quantity before it, (5 mm)/" + name);
    std::vector<Amount> values;
    for (const std::string& name : expression.names()) {
      std::string wrong, hint;
      const auto value = value_of(name, node, path, wrong, hint);
      if (!value) return node.faulty ? "" : refuse(wrong, hint);
      values.push_back(*value);
    }
    const auto result = expression.amount(values);
    if (const auto* wrong = std::get_if<std::string>(&result)) return refuse(*wrong);
    return amount_text(std::get<Amount>(result));
  }

  /// A variable or, where none has its name, a unit. Nothing: the node is faulty, or `wrong` says why.
  std::optional<Amount> value_of(const std::string& name, Node& node, const std::string& path,
                                 std::string& wrong, std::string& hint) {
    Variable* variable = find(name);
    if (!variable) {
      if (const auto unit = unit_named(name)) return unit;
      wrong = names_.empty() ? fmt::format("no variable '{}' (the scene has no variables)", name)
                             : fmt::format("no variable '{}' (one of {})", name, known());
      hint = hint_for(name);
      return std::nullopt;
    }
    if (!use(*variable, node, path)) return std::nullopt;
    const auto parsed = parse_amount(variable->node->scalar);
    if (const auto* amount = std::get_if<Amount>(&parsed)) return *amount;
    wrong = fmt::format("'{}' is no number but {}", name, describe(*variable->node));
    hint = "Arithmetic stands in ${…}, also in variables";
    return std::nullopt;
  }

  /// Marks and computes a variable that a node names. False: it has none to give, and the node is faulty.
  bool use(Variable& variable, Node& node, const std::string& path) {
    variable.used = true;
    if (variable.state == Variable::State::open) {
      const auto first = std::find(chain_.begin(), chain_.end(), variable.key.text);
      const std::vector<std::string> circle(first, chain_.end());
      fault(node, path,
            fmt::format("a variable may not refer to itself ({} → {})", fmt::join(circle, " → "),
                        variable.key.text));
      return false;
    }
    if (variable.state == Variable::State::written && chain_.size() >= kLongestChain)
      fault(node, path, fmt::format("variables refer to each other over more than {} steps", kLongestChain));
    else
      settle(variable);
    if (variable.state != Variable::State::good) node.faulty = true;  // reported where it is defined
    return variable.state == Variable::State::good;
  }

  Variable* find(const std::string& name) {
    const auto found = index_.find(name);
    return found == index_.end() ? nullptr : &variables_[found->second];
  }

  static std::optional<Amount> unit_named(const std::string& name) {
    const auto parsed = parse_unit(name, Measure::number);
    const auto* unit = std::get_if<Unit>(&parsed);
    if (!unit) return std::nullopt;
    return Amount{unit->multiplier / unit->divisor, unit->dimensions};
  }

  std::string known() const {
    constexpr std::size_t kShown = 20;
    const std::span<const std::string> all(names_);
    return fmt::format("{}{}", fmt::join(all.first(std::min(kShown, all.size())), ", "),
                       all.size() > kShown ? ", …" : "");
  }

  /// Of the first hundred problems: a hint looks at every name.
  std::string hint_for(const std::string& name) const {
    constexpr std::size_t kMostHints = 100;
    return problems_.count() < kMostHints ? did_you_mean(name, names_) : "";
  }

  /// A misspelt variable is as bad as a misspelt key; but a file that others include may hold more than one
  /// of them needs.
  void report_unused() {
    for (const Variable& variable : variables_) {
      if (variable.used || problems_.is_included(variable.key.location.source)) continue;
      problems_.add(variable.key.location, variable.path, "nobody uses this variable",
                    hint_for(variable.key.text));
    }
  }

  Node& root_;
  Problems& problems_;
  const std::set<std::string>& used_;
  std::vector<Variable> variables_;
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> index_;
  std::vector<std::string> chain_;  ///< of the variables that are being computed
  std::size_t total_ = 0;           ///< bytes made so far
};

}  // namespace

void expand_variables(Node& root, Problems& problems, const std::set<std::string>& used) {
  Expander(root, problems, used).all();
}

std::set<std::string> names_in_expressions(const Node& root) {
  std::set<std::string> names;
  for (const Node& item : root.items) names.merge(names_in_expressions(item));
  const std::string& text = root.scalar;
  std::size_t end = 0;
  for (std::size_t at = text.find("${"); at != std::string::npos; at = text.find("${", end)) {
    end = text.find('}', at);
    if (end == std::string::npos) break;
    if (at > 0 && text[at - 1] == '$') continue;  // $${ stands for itself
    const std::string inside = trimmed(text.substr(at + 2, end - at - 2));
    if (inside.size() > kLongestExpression) continue;
    names.insert(inside);
    const auto parsed = Expression::parse(inside);
    if (const auto* good = std::get_if<Expression>(&parsed))
      names.insert(good->names().begin(), good->names().end());
  }
  return names;
}

}  // namespace mpmfast
