#pragma once

/// @file From columns of numbers to few bytes for a page: 8 or 16 bits a value, differences in time and along
/// the particles, deflate.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mpmfast {

/// The numbers that the whole numbers 0, 1, 2 … stand for; the largest one of the bits stands for no number.
class Levels {
 public:
  /// Evenly spaced from the lower to the upper end, which both are levels. Values beyond are moved to them.
  static Levels even(double lower, double upper, int bits);
  /// With a spacing of their own, from `lower` on.
  static Levels spaced(double lower, double spacing, int bits);
  /// 8 bits, where half of the levels lie as the values do: outliers do not take them from the rest. Zero is
  /// a level when values of both signs, or zeros, are there. @param sample  finite, not empty
  static Levels crowded(std::vector<double> sample, double lower, double upper);

  std::uint16_t nearest(double value) const;
  double value(std::uint16_t level) const;
  std::uint16_t none() const { return static_cast<std::uint16_t>(bits_ == 8 ? 0xff : 0xffff); }
  int bits() const { return bits_; }
  double lower() const { return table_.empty() ? lower_ : table_.front(); }
  double spacing() const { return spacing_; }
  /// Ascending; empty for even levels.
  const std::vector<double>& table() const { return table_; }

 private:
  int bits_ = 16;
  double lower_ = 0, spacing_ = 1;
  std::vector<double> table_;
};

/// How a column was made small: differences of this order in time, then along the particles.
struct Packed {
  int time_order = 0, space_order = 0;
  std::string bytes;  ///< of zlib
};

/// @param levels  of all frames, those of a frame together
/// @param width   of a frame; the columns of 16 bits are split into low and high bytes
Packed pack_levels(const std::vector<std::uint16_t>& levels, std::size_t width, int bits);

/// zlib's format.
std::string deflated(std::string_view bytes);

std::string base64(std::string_view bytes);

}  // namespace mpmfast
