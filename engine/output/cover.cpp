#include "engine/output/cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace mpmfast {
namespace {

/// The first of the samples whose centre lies at x or behind it.
std::ptrdiff_t first_sample(double x, int count) {
  return static_cast<std::ptrdiff_t>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(count)));
}

}  // namespace

Cover::Cover(int width, int height)
    : columns_(width * Canvas::kSamples),
      rows_(height * Canvas::kSamples),
      covered_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

bool Cover::add(PixelPoint centre, double radius) {
  const double x = centre.x * Canvas::kSamples, y = centre.y * Canvas::kSamples;
  const double r = radius * Canvas::kSamples;
  bool shows = false;
  for (std::ptrdiff_t row = first_sample(y - r, rows_); row < first_sample(y + r, rows_); ++row) {
    const double dy = static_cast<double>(row) + 0.5 - y, half = std::sqrt(std::max(0.0, r * r - dy * dy));
    const std::ptrdiff_t begin = first_sample(x - half, columns_), end = first_sample(x + half, columns_);
    const std::span of_row(covered_.data() + row * columns_ + begin, static_cast<std::size_t>(end - begin));
    shows = shows || std::memchr(of_row.data(), 0, of_row.size()) != nullptr;
    std::fill(of_row.begin(), of_row.end(), std::uint8_t{1});
  }
  return shows;
}

}  // namespace mpmfast
