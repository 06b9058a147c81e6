#include "pack.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace mpmfast {

namespace {

constexpr int kQuick = 1, kThorough = 6;  // 9 takes three times as long for 1 % less

std::string deflated_at(int effort, std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), effort) != Z_OK)
    throw std::runtime_error("zlib could not compress a column of the report");
  out.resize(size);
  return out;
}

/// Differences that wrap round, so that nothing is lost.
std::vector<std::uint16_t> differences(const std::vector<std::uint16_t>& levels, std::size_t width,
                                       const Packed& how) {
  std::vector<std::uint16_t> out(levels);
  const std::size_t frames = width > 0 ? levels.size() / width : 0;
  for (std::size_t f = 1; f < frames && how.time_order > 0; ++f)
    for (std::size_t i = f * width; i < (f + 1) * width; ++i) {
      const int before = levels[i - width];
      const int expected = how.time_order == 1 || f == 1 ? before : 2 * before - levels[i - 2 * width];
      out[i] = static_cast<std::uint16_t>(levels[i] - expected);
    }
  for (std::size_t f = 0; f < frames && how.space_order > 0; ++f)
    for (std::size_t i = (f + 1) * width; i-- > f * width + 1;)
      out[i] = static_cast<std::uint16_t>(out[i] - out[i - 1]);
  return out;
}

std::string as_bytes(const std::vector<std::uint16_t>& levels, int bits) {
  std::string bytes;
  bytes.reserve(levels.size() * static_cast<std::size_t>(bits) / 8);
  for (const std::uint16_t level : levels) bytes += static_cast<char>(level & 0xff);
  if (bits == 16)
    for (const std::uint16_t level : levels) bytes += static_cast<char>(level >> 8);
  return bytes;
}

}  // namespace

Levels Levels::even(double lower, double upper, int bits) {
  const double steps = bits == 8 ? 0xfe : 0xfffe;
  return spaced(lower, upper > lower ? (upper - lower) / steps : 1, bits);
}

Levels Levels::spaced(double lower, double spacing, int bits) {
  Levels levels;
  levels.bits_ = bits;
  levels.lower_ = lower;
  levels.spacing_ = spacing;
  return levels;
}

Levels Levels::crowded(std::vector<double> sample, double lower, double upper) {
  constexpr std::size_t kEven = 128, kCrowded = 127;
  std::sort(sample.begin(), sample.end());
  Levels levels;
  levels.bits_ = 8;
  auto& table = levels.table_;
  for (std::size_t k = 0; k < kEven; ++k)
    table.push_back(lower + (upper - lower) * static_cast<double>(k) / (kEven - 1));
  for (std::size_t k = 0; k < kCrowded; ++k)
    table.push_back(sample[(2 * k + 1) * (sample.size() - 1) / (2 * kCrowded)]);
  std::sort(table.begin(), table.end());
  if (lower <= 0 && upper >= 0)  // what rests, or is rigid, shows exactly that
    *std::min_element(table.begin(), table.end(),
                      [](double a, double b) { return std::abs(a) < std::abs(b); }) = 0;
  table.erase(std::unique(table.begin(), table.end()), table.end());
  return levels;
}

std::uint16_t Levels::nearest(double value) const {
  if (!std::isfinite(value)) return none();
  if (table_.empty()) {
    const double level = std::round((value - lower_) / spacing_);
    return static_cast<std::uint16_t>(std::clamp(level, 0.0, static_cast<double>(none()) - 1));
  }
  const auto above = std::lower_bound(table_.begin(), table_.end(), value);
  if (above == table_.begin()) return 0;
  const auto below = above - 1;
  const bool up = above != table_.end() && *above - value < value - *below;
  return static_cast<std::uint16_t>((up ? above : below) - table_.begin());
}

double Levels::value(std::uint16_t level) const {
  return table_.empty() ? lower_ + spacing_ * level : table_[level];
}

Packed pack_levels(const std::vector<std::uint16_t>& levels, std::size_t width, int bits) {
  // Which differences are smallest depends on the column: three frames in the middle tell.
  constexpr std::size_t kTried = 3;
  const std::size_t frames = width > 0 ? levels.size() / width : 0;
  const std::size_t tried = std::min(kTried, frames), first = (frames - tried) / 2 * width;
  const auto from = levels.begin() + static_cast<std::ptrdiff_t>(first);
  const std::vector<std::uint16_t> sample(from, from + static_cast<std::ptrdiff_t>(tried * width));
  Packed best;
  std::size_t least = std::string::npos;
  for (int time = 0; time <= (frames > 1 ? 2 : 0); ++time)
    for (int space = 0; space <= 1; ++space) {
      const Packed how{time, space, ""};
      const std::size_t size = deflated_at(kQuick, as_bytes(differences(sample, width, how), bits)).size();
      if (size >= least) continue;
      least = size;
      best = how;
    }
  best.bytes = deflated(as_bytes(differences(levels, width, best), bits));
  return best;
}

std::string deflated(std::string_view bytes) { return deflated_at(kThorough, bytes); }

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= std::min<std::size_t>(3, bytes.size() - i) ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace mpmfast
