#pragma once

/// @file A table of numbers with a header, and curves made of expressions over its columns.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/quantities/expression.hpp"

namespace mpmfast {

struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  std::size_t rows() const { return columns.empty() ? 0 : columns[0].size(); }
  /// Nothing when there is no such column.
  const std::vector<double>* find(const std::string& name) const;
};

/// A last line that does not end: one like the others in a table that a person wrote, torn in the history of
/// a run that goes on or was killed.
enum class Unended { whole, torn };

/// Reads a CSV file with a header (cells may be quoted). A torn line is left out. Throws FileError.
Table read_table(const std::filesystem::path& file, Unended last);
/// The same of the text of a file. @param name  of the file, for messages
Table parse_table(std::string text, const std::string& name, Unended last);

/// Names that an expression may use beside the columns.
using Constants = std::map<std::string, double>;

/// The expression for every row. Throws FileError, naming the column, when a name is neither a column nor a
/// constant.
std::vector<double> evaluate(const Expression& expression, const Table& table, const Constants& constants);

/// The expression of constants alone.
double evaluate(const Expression& expression, const Constants& constants);

struct Curve {
  std::vector<double> x, y;
};

/// Linear between the points; not a number outside.
double value_at(const Curve& curve, double x);

}  // namespace mpmfast
