#pragma once

/// @file Arithmetic over names: columns of a table, "-all.mean_stress_yy_Pa / 1e6", or variables of a scene,
/// "2*length/speed".

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/quantities/quantity.hpp"

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
  /// Names that stand behind a unit, as h in "5 mm/h": where they are units too, they are ambiguous.
  const std::vector<std::string>& names_after_units() const { return after_units_; }

  /// In SI, without a look at units.
  /// @param of_names a value for each of names()
  double value(std::span<const double> of_names) const;
  /// With its units, or what is wrong with them. Finite.
  std::variant<Amount, std::string> amount(std::span<const Amount> of_names) const;

 private:
  friend class ExpressionParser;
  enum class Kind : std::uint8_t { number, name, negate, add, subtract, multiply, divide, power, call };
  /// One instruction of a stack machine.
  struct Code {
    Kind kind;
    double number = 0;
    std::size_t index{};  ///< of the name or of the function
    Dimensions dimensions{};
  };

  template <class Number, class Arithmetic>
  Number run(std::span<const Number> of_names, Arithmetic& arithmetic) const;

  std::string text_;
  std::vector<std::string> names_, after_units_;
  std::vector<Code> codes_;
};

std::vector<std::string> expression_functions();

}  // namespace mpmfast
