#include "usual_charts.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "handy_units.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kMostCurves = 16;    // more cannot be distinguished
constexpr double kRoundOff = 1e-9;         // of what is summed
constexpr std::string_view kAll = "all.";  // before columns of all bodies together
constexpr std::string_view kMass = ".mass_kg";

bool matches(const std::string& name, const std::string& part) {
  return part == "_J" ? unit_of_column(name) == "J" : name.find(part) != std::string::npos;
}

bool is_of_all(const std::string& name) { return name.starts_with(kAll); }

bool is_zero(const std::vector<double>& column) {
  return std::all_of(column.begin(), column.end(), [](double number) { return number == 0; });
}

/// But for the rounding of the file and of the average.
bool are_equal(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0, apart = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::fmax(largest, std::abs(a[k]));
    apart = std::fmax(apart, std::abs(a[k] - b[k]));
  }
  return apart <= kRoundOff * largest;
}

/// Those of one body and the same of all, which that body is.
bool repeats_the_only_body(const Table& history, const std::vector<std::string>& names) {
  std::vector<std::string> own, all;
  for (const std::string& name : names) (is_of_all(name) ? all : own).push_back(name);
  if (own.empty() || own.size() != all.size()) return false;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const std::string end = all[k].substr(kAll.size() - 1);
    const auto body = std::find_if(own.begin(), own.end(), [&](const auto& n) { return n.ends_with(end); });
    if (body == own.end() || !are_equal(*history.find(*body), *history.find(all[k]))) return false;
  }
  return true;
}

bool is_flat(const Table& history) {
  return std::none_of(history.names.begin(), history.names.end(),
                      [](const std::string& name) { return name.ends_with(".vz"); });
}

/// The most that all bodies together carry at a time, whichever way each goes, kg m/s.
double carried_momentum(const Table& history) {
  std::vector<double> carried(history.rows(), 0.0);
  for (const std::string& name : history.names) {
    if (!name.ends_with(kMass) || is_of_all(name)) continue;
    const std::vector<double>& mass = *history.find(name);
    const std::string body = name.substr(0, name.size() - kMass.size());
    for (const char* axis : {".vx", ".vy", ".vz"})
      if (const std::vector<double>* velocity = history.find(body + axis))
        for (std::size_t k = 0; k < carried.size(); ++k) carried[k] += std::abs(mass[k] * (*velocity)[k]);
  }
  double most = 0;
  for (const double momentum : carried)
    if (std::isfinite(momentum)) most = std::max(most, momentum);
  return most;
}

}  // namespace

std::vector<std::string> telling_columns(const Table& history, const std::string& part) {
  std::vector<std::string> named, out;
  for (const std::string& name : history.names)
    if (matches(name, part) && !(name == "momentum_z" && is_flat(history))) named.push_back(name);
  for (const std::string& name : named)
    if (!is_zero(*history.find(name))) out.push_back(name);
  if (out.empty()) out = named;
  const bool repeats = repeats_the_only_body(history, out);
  std::vector<std::string> together, apart;
  for (const std::string& name : out) (is_of_all(name) ? together : apart).push_back(name);
  if (repeats) out = apart;
  if (out.size() <= kMostCurves) return out;
  if (!together.empty()) return together;
  out.resize(kMostCurves);
  return out;
}

void clear_round_off(Table& history) {
  const double least = kRoundOff * carried_momentum(history);
  for (std::size_t k = 0; k < history.names.size(); ++k)
    if (history.names[k].starts_with("momentum_"))
      for (double& number : history.columns[k])
        if (std::abs(number) < least) number = 0;
}

}  // namespace mpmfast
