#pragma once

/// @file Arithmetic over the columns of a table: "-all.mean_stress_yy_Pa / 1e6".

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace mpmfast {

/// Numbers (with a simple unit, "5 mm", or in SI), names, + - * / ^, parentheses and the functions of
/// expression_functions(). A name is made of letters, digits, '_' and '.'; one that holds anything else
/// stands between backquotes. `pi` is known.
class Expression {
 public:
  /// The expression, or what is wrong with the text.
  static std::variant<Expression, std::string> parse(const std::string& text);

  const std::string& text() const { return text_; }
  /// Every name that the expression reads, each once.
  const std::vector<std::string>& names() const { return names_; }
  /// @param of_names a value for each of names()
  double value(std::span<const double> of_names) const;

 private:
  friend class ExpressionParser;
  enum class Kind : std::uint8_t { number, name, negate, add, subtract, multiply, divide, power, call };
  /// One instruction of a stack machine.
  struct Code {
    Kind kind;
    double number = 0;
    std::size_t index = 0;  ///< of the name or of the function
  };

  std::string text_;
  std::vector<std::string> names_;
  std::vector<Code> codes_;
};

std::vector<std::string> expression_functions();

}  // namespace mpmfast
