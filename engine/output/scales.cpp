#include "engine/output/scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace mpmfast {
namespace {

/// Dark violet over blue and green to yellow: lightness rises evenly (after viridis, CC0).
constexpr std::array<unsigned, 9> kSequential{0x440154, 0x472d7b, 0x3b518b, 0x2c718e, 0x21918d,
                                              0x27ad81, 0x5cc863, 0xaadc32, 0xfde725};
/// Blue over near white to red: lightness is symmetric about the middle.
constexpr std::array<unsigned, 9> kDiverging{0x16315f, 0x2f63a8, 0x6f9fd0, 0xb5cfe6, 0xf2f1ee,
                                             0xecc3ae, 0xd98870, 0xb54646, 0x70162e};
/// Each as far as can be, in OKLab, from all before it and from black and white.
constexpr std::array<unsigned, 28> kBodies{
    0x1e69b4, 0xe15a0f, 0x00c369, 0xe187f0, 0x78004b, 0x0f4b00, 0xffc300, 0x4bc3ff, 0x78785a, 0x2dffe1,
    0x964bb4, 0xd2b4b4, 0x3c1e96, 0x008700, 0x7887ff, 0x3c3c4b, 0x963c1e, 0xa5f069, 0xb49600, 0xff7896,
    0x00a5a5, 0xc33c78, 0xa587b4, 0x006969, 0xff965a, 0xffc3ff, 0x96d2a5, 0x875a78};

template <std::size_t N>
Colour interpolate(const std::array<unsigned, N>& points, double position) {
  const double x = std::clamp(position, 0.0, 1.0) * (N - 1);
  const auto i = std::min(static_cast<std::size_t>(x), N - 2);
  const double t = x - static_cast<double>(i);
  const Colour a = Colour::hex(points[i]), b = Colour::hex(points[i + 1]);
  const auto mix = [t](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + t * (to - from)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

}  // namespace

Range robust_range(std::span<const double> values) {
  std::vector<double> finite;
  for (double v : values)
    if (std::isfinite(v)) finite.push_back(v);
  if (finite.empty()) return {0, 1};
  const auto percentile = [&](double share) {
    const auto nth = finite.begin() + std::lround(share * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), nth, finite.end());
    return *nth;
  };
  const Range most{percentile(0.01), percentile(0.99)};
  return most.width() > 0 ? most : Range{percentile(0), percentile(1)};
}

ColourScale::ColourScale(Range values) : range_(values) {
  const double size = std::max(std::abs(values.lower), std::abs(values.upper));
  one_value_ = values.width() <= 1e-9 * size;
  if (one_value_) {  // any range that holds it and is wider than its rounding
    const double margin = size > 0 ? 0.05 * size : 1;
    range_ = {values.lower - margin, values.upper + margin};
    return;
  }
  // A trace of the other sign (noise about zero) would waste half of the colours.
  constexpr double kTrace = 0.1;
  diverging_ = values.lower < -kTrace * size && values.upper > kTrace * size;
  if (diverging_) range_ = {-size, size};
}

Colour ColourScale::operator()(double value) const {
  if (std::isnan(value)) return {150, 150, 150};
  const double position = (value - range_.lower) / range_.width();
  return diverging_ ? interpolate(kDiverging, position) : interpolate(kSequential, position);
}

Colour body_colour(std::size_t body) { return Colour::hex(kBodies[body % kBodies.size()]); }

DisplayUnit display_unit(double size, std::string_view si_unit) {
  const std::string unit(si_unit);
  if (unit.empty() || unit == "-" || unit == "K" || unit == "m/s") return {unit, 1};
  constexpr std::array<std::pair<std::string_view, double>, 8> prefixes{
      {{"T", 1e12}, {"G", 1e9}, {"M", 1e6}, {"k", 1e3}, {"", 1}, {"m", 1e-3}, {"µ", 1e-6}, {"n", 1e-9}}};
  const auto usual = [&](std::string_view prefix) {  // nobody writes ks, Mm or mPa
    if (unit == "Pa")
      return prefix == "T" || prefix == "G" || prefix == "M" || prefix == "k" || prefix.empty();
    if (unit == "m" && prefix == "k") return true;
    return prefix.empty() || prefix == "m" || prefix == "µ" || prefix == "n";
  };
  DisplayUnit smallest{unit, 1};
  if (!(size > 0) || !std::isfinite(size)) return smallest;
  for (const auto& [prefix, factor] : prefixes) {
    if (!usual(prefix)) continue;
    smallest = {std::string(prefix) + unit, factor};
    if (size >= 0.9995 * factor) break;
  }
  return smallest;
}

std::vector<double> round_ticks(Range range, int wanted) {
  if (!(range.width() > 0) || !std::isfinite(range.width())) return {};
  const double raw = range.width() / wanted, decade = std::pow(10.0, std::floor(std::log10(raw)));
  double spacing = 10 * decade;
  for (double step : {5.0, 2.0, 1.0})
    if (step * decade >= 0.7 * raw) spacing = step * decade;
  std::vector<double> ticks;
  constexpr double kSlack = 1e-9;  // a tick on the very end counts
  for (double n = std::ceil(range.lower / spacing - kSlack); n <= range.upper / spacing + kSlack; ++n)
    ticks.push_back(n * spacing);
  return ticks.size() < 2 && wanted < 16 ? round_ticks(range, wanted + 1) : ticks;  // one has no scale
}

std::string tick_label(double tick, double spacing) {
  if (std::abs(tick) < 1e-6 * spacing) return "0";
  if (spacing < 1e-4 || std::abs(tick) >= 1e6) return fmt::format("{:.6g}", tick);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(spacing) + 1e-9)));
  return fmt::format("{:.{}f}", tick, decimals);
}

}  // namespace mpmfast
