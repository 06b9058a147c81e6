#include "engine/quantities/expression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numbers>

#include "engine/quantities/closest.hpp"
#include "engine/quantities/expression_functions.hpp"

namespace mpmfast {

namespace {

constexpr int kDeepest = 64;  // parentheses, signs and powers within each other

}  // namespace

/// Recursive descent: sum → product → power → atom; emits the operands before the operation.
class ExpressionParser {
 public:
  explicit ExpressionParser(const std::string& text) : text_(text) { out_.text_ = text; }

  std::variant<Expression, std::string> parse() {
    sum();
    skip();
    if (wrong_.empty() && at_ < text_.size()) fail("an operator was expected");
    if (!wrong_.empty()) return wrong_;
    return out_;
  }

 private:
  using Kind = Expression::Kind;

  void sum() {
    product();
    while (wrong_.empty()) {
      if (take('+')) {
        product();
        emit(Kind::add);
      } else if (take('-')) {
        product();
        emit(Kind::subtract);
      } else {
        return;
      }
    }
  }

  void product() {
    sign();
    while (wrong_.empty()) {
      if (take('*')) {
        sign();
        emit(Kind::multiply);
      } else if (take('/')) {
        sign();
        emit(Kind::divide);
      } else {
        return;
      }
    }
  }

  /// −x^y is −(x^y).
  void sign() {
    if (++depth_ > kDeepest) return fail("nested too deeply");
    if (take('-')) {
      sign();
      emit(Kind::negate);
    } else if (take('+')) {
      sign();
    } else {
      atom();
      if (wrong_.empty() && take('^')) {
        sign();
        emit(Kind::power);
      }
    }
    --depth_;
  }

  void atom() {
    skip();
    if (at_ >= text_.size()) return fail("a number or a name was expected");
    const char c = text_[at_];
    if (take('(')) {
      sum();
      if (!take(')')) fail("a ')' is missing");
    } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
      number();
    } else if (c == '`') {
      const std::size_t end = text_.find('`', at_ + 1);
      if (end == std::string::npos) return fail("a closing '`' is missing");
      name(text_.substr(at_ + 1, end - at_ - 1));
      at_ = end + 1;
    } else if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') {
      word();
    } else {
      fail("a number or a name was expected");
    }
  }

  void number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) return fail("not a number");
    at_ = static_cast<std::size_t>(end - text_.data());
    Dimensions dimensions{};
    skip();
    std::size_t last = at_;
    while (last < text_.size() && std::isalpha(static_cast<unsigned char>(text_[last]))) ++last;
    if (last > at_) {  // "5 mm"
      const auto unit = parse_unit(text_.substr(at_, last - at_), Measure::number);
      if (!std::holds_alternative<Unit>(unit)) return fail("an operator or a unit was expected");
      value = value * std::get<Unit>(unit).multiplier / std::get<Unit>(unit).divisor;
      dimensions = std::get<Unit>(unit).dimensions;
      at_ = last;
      skip();  // "5 mm^2" is meant as an area, but would be (5 mm)^2
      if (at_ < text_.size() && text_[at_] == '^') return fail("a unit takes no power (write (5 mm)^2)");
      note_unit_like_name();
    }
    out_.codes_.push_back({Kind::number, value, 0, dimensions});
  }

  /// "5 mm/h": is h a name or the hour? Kept for those who know the names.
  void note_unit_like_name() {
    if (at_ >= text_.size() || (text_[at_] != '/' && text_[at_] != '*')) return;
    std::size_t last = at_ + 1;
    while (last < text_.size() && std::isalpha(static_cast<unsigned char>(text_[last]))) ++last;
    out_.after_units_.push_back(text_.substr(at_ + 1, last - at_ - 1));
  }

  void word() {
    const std::size_t first = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == '.'))
      ++at_;
    const std::string found = text_.substr(first, at_ - first);
    if (take('(')) return call(found);
    if (found == "pi") {
      out_.codes_.push_back({Kind::number, std::numbers::pi});
    } else {
      name(found);
    }
  }

  void name(const std::string& found) {
    const auto known = std::find(out_.names_.begin(), out_.names_.end(), found);
    const auto index = static_cast<std::size_t>(known - out_.names_.begin());
    if (known == out_.names_.end()) out_.names_.push_back(found);
    out_.codes_.push_back({Kind::name, 0, index});
  }

  void call(const std::string& found) {
    const auto function = std::find_if(kFunctions.begin(), kFunctions.end(),
                                       [&](const Function& f) { return found == f.name; });
    if (function == kFunctions.end()) {
      const std::vector<std::string> known = expression_functions();
      const std::string hint = closest_hint(found, known);
      wrong_ = fmt::format("no function '{}' (one of {}){}", found, fmt::join(known, ", "),
                           hint.empty() ? "" : ". " + hint);
      return;
    }
    for (int k = 0; k < function->arguments && wrong_.empty(); ++k) {
      if (k > 0 && !take(',')) return fail(fmt::format("{} takes {} arguments", found, function->arguments));
      sum();
    }
    if (!take(')')) return fail(fmt::format("a ')' is missing after the argument of {}", found));
    out_.codes_.push_back({Kind::call, 0, static_cast<std::size_t>(function - kFunctions.begin())});
  }

  void emit(Kind kind) {
    if (wrong_.empty()) out_.codes_.push_back({kind});
  }
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void fail(const std::string& what) {
    if (!wrong_.empty()) return;
    wrong_ =
        at_ < text_.size() ? fmt::format("{} at '{}'", what, text_.substr(at_, 20)) : what + " at the end";
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string wrong_;
  Expression out_;
};

std::variant<Expression, std::string> Expression::parse(const std::string& text) {
  return ExpressionParser(text).parse();
}

std::vector<std::string> expression_functions() {
  std::vector<std::string> out;
  for (const Function& function : kFunctions) out.emplace_back(function.name);
  return out;
}

}  // namespace mpmfast
