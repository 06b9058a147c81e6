#pragma once

/// @file From numbers to colours and labels: robust ranges, colour maps, round ticks, units of a sensible
/// size.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/canvas.hpp"

namespace mpmfast {

struct Range {
  double lower = 0, upper = 1;
  double width() const { return upper - lower; }
};

/// From the 1st to the 99th percentile of the finite values, so that outliers do not hide the rest; of all of
/// them where most are one value.
Range robust_range(std::span<const double> values);

/// A linear scale of colours: sequential, or diverging and symmetric about zero when the values take both
/// signs.
class ColourScale {
 public:
  explicit ColourScale(Range values);
  Range range() const { return range_; }
  bool has_one_value() const { return one_value_; }
  Colour operator()(double value) const;  ///< grey for NaN; the end colours beyond the range

 private:
  Range range_;
  bool diverging_ = false, one_value_ = false;
};

/// The colour of a body: neighbours in the list of bodies differ strongly.
Colour body_colour(std::size_t body);

/// The unit of the same quantity in which `size` is written with one to three digits before the point.
struct DisplayUnit {
  std::string name;
  double in_si = 1;  ///< one such unit in the SI unit
};
DisplayUnit display_unit(double size, std::string_view si_unit);

/// Round numbers (1, 2, 5 × 10ⁿ apart) within a range, about `wanted` of them.
std::vector<double> round_ticks(Range range, int wanted);

/// The text of a tick without the noise of rounding: −0 and 0.30000000000000004 read 0 and 0.3.
std::string tick_label(double tick, double spacing);

}  // namespace mpmfast
