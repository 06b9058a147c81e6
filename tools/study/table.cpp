#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "engine/errors.hpp"
#include "engine/geometry/read_regular.hpp"

namespace mpmfast {

namespace {

/// The cells of one line; a quoted cell may hold commas and doubled quotes (RFC 4180).
std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"') {
      cells.back() += line[++k];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

double number_of(std::string cell, const std::string& where) {
  cell.erase(0, cell.find_first_not_of(' '));
  while (!cell.empty() && cell.back() == ' ') cell.pop_back();
  const bool plus = cell.size() > 1 && cell[0] == '+' && cell[1] != '-';  // from_chars takes no plus
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data() + (plus ? 1 : 0), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || cell.empty())
    throw FileError(fmt::format("{}: not a number, got '{}'", where, cell));
  return value;
}

}  // namespace

const std::vector<double>* Table::find(const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? nullptr : &columns[static_cast<std::size_t>(at - names.begin())];
}

Table read_table(const std::filesystem::path& file, Unended last) {
  constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 40;  // bytes
  std::string why_not;
  auto whole = read_regular(file, kLargestFile, why_not);
  if (!whole) throw FileError(fmt::format("{}: cannot read the table: {}", file.string(), why_not));
  return parse_table(*std::move(whole), file.string(), last);
}

Table parse_table(std::string text, const std::string& name, Unended last) {
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; text.starts_with(kByteOrderMark))
    text.erase(0, kByteOrderMark.size());
  if (last == Unended::whole && !text.empty() && text.back() != '\n') text += '\n';
  Table table;
  std::size_t line = 0, first = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', first)) {
    const std::vector<std::string> cells = split_cells(text.substr(first, end - first));
    first = end + 1;
    if (line++ == 0) {
      table.names = cells;
      table.columns.resize(cells.size());
      continue;
    }
    const std::string where = fmt::format("{}:{}", name, line);
    if (cells.size() != table.names.size())
      throw FileError(
          fmt::format("{}: {} cells, but {} in the header", where, cells.size(), table.names.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) table.columns[k].push_back(number_of(cells[k], where));
  }
  if (line == 0) throw FileError(fmt::format("{}: no header", name));
  return table;
}

std::vector<double> evaluate(const Expression& expression, const Table& table, const Constants& constants) {
  std::vector<double> values(expression.names().size());
  std::vector<const std::vector<double>*> columns(values.size(), nullptr);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& name = expression.names()[k];
    const auto constant = constants.find(name);
    if (constant != constants.end()) {
      values[k] = constant->second;
    } else if (!(columns[k] = table.find(name))) {
      throw FileError(fmt::format("no column '{}' for '{}'", name, expression.text()));
    }
  }
  std::vector<double> out(table.rows());
  for (std::size_t row = 0; row < out.size(); ++row) {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (columns[k]) values[k] = (*columns[k])[row];
    out[row] = expression.value(values);
  }
  return out;
}

double evaluate(const Expression& expression, const Constants& constants) {
  return evaluate(expression, Table{{""}, {{0}}}, constants).front();
}

double value_at(const Curve& curve, double x) {
  const auto upper = std::lower_bound(curve.x.begin(), curve.x.end(), x);
  const auto k = static_cast<std::size_t>(upper - curve.x.begin());
  if (k == curve.x.size()) return std::numeric_limits<double>::quiet_NaN();
  if (curve.x[k] == x) return curve.y[k];
  if (k == 0) return std::numeric_limits<double>::quiet_NaN();
  const double share = (x - curve.x[k - 1]) / (curve.x[k] - curve.x[k - 1]);
  return curve.y[k - 1] + share * (curve.y[k] - curve.y[k - 1]);
}

}  // namespace mpmfast
