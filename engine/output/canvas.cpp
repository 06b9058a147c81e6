#include "engine/output/canvas.hpp"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "engine/output/files.hpp"
#include "engine/output/font.hpp"

namespace mpmfast {
namespace {

constexpr double kDot = 2;  // pixels a font dot
constexpr double kAdvance = kDot * (kGlyphWidth + 1);

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width),
      height_(height),
      sample_(static_cast<std::size_t>(width * kSamples) * static_cast<std::size_t>(height * kSamples),
              Colour{255, 255, 255}) {}

/// Fills the samples of one row whose centres lie in [from, to), in samples.
void Canvas::fill_row(int row, double from, double to, Colour colour) {
  const int columns = width_ * kSamples;
  const double first = std::ceil(from - 0.5), last = std::ceil(to - 0.5);
  if (!(first < last) || !(last > 0) || !(first < columns)) return;
  const auto begin = static_cast<std::ptrdiff_t>(std::max(first, 0.0));
  const auto end = static_cast<std::ptrdiff_t>(std::min(last, static_cast<double>(columns)));
  const auto start = sample_.begin() + static_cast<std::ptrdiff_t>(row) * columns;
  std::fill(start + begin, start + end, colour);
}

void Canvas::fill_convex(std::span<const PixelPoint> corners, Colour colour) {
  double top = std::numeric_limits<double>::infinity(), bottom = -top;
  for (const auto& corner : corners) {
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) return;
    top = std::min(top, corner.y * kSamples);
    bottom = std::max(bottom, corner.y * kSamples);
  }
  const double rows = height_ * kSamples;
  if (!(bottom > 0) || !(top < rows)) return;
  const int first = static_cast<int>(std::max(0.0, std::ceil(top - 0.5)));
  const int last = static_cast<int>(std::min(rows, std::ceil(bottom - 0.5)));
  for (int row = first; row < last; ++row) {
    const double y = row + 0.5;
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const PixelPoint& a = corners[i];
      const PixelPoint& b = corners[(i + 1) % corners.size()];
      const double ya = a.y * kSamples, yb = b.y * kSamples;
      if ((ya <= y) == (yb <= y)) continue;
      const double x = kSamples * (a.x + (b.x - a.x) * (y - ya) / (yb - ya));
      left = std::min(left, x);
      right = std::max(right, x);
    }
    fill_row(row, left, right, colour);
  }
}

void Canvas::fill_rectangle(PixelPoint upper_left, PixelPoint lower_right, Colour colour) {
  const std::array<PixelPoint, 4> corners{
      {upper_left, {lower_right.x, upper_left.y}, lower_right, {upper_left.x, lower_right.y}}};
  fill_convex(corners, colour);
}

void Canvas::fill_disc(PixelPoint centre, double radius, Colour colour) {
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y) || !std::isfinite(radius)) return;
  const double x = centre.x * kSamples, y = centre.y * kSamples, r = radius * kSamples;
  const double rows = height_ * kSamples;
  if (!(y + r > 0) || !(y - r < rows)) return;
  const int first = static_cast<int>(std::max(0.0, std::ceil(y - r - 0.5)));
  const int last = static_cast<int>(std::min(rows, std::ceil(y + r - 0.5)));
  for (int row = first; row < last; ++row) {
    const double dy = row + 0.5 - y, half = std::sqrt(std::max(0.0, r * r - dy * dy));
    fill_row(row, x - half, x + half, colour);
  }
}

void Canvas::line(PixelPoint from, PixelPoint to, double width, Colour colour) {
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  if (!(length > 0)) return;
  const double nx = -dy / length * width / 2, ny = dx / length * width / 2;
  const std::array<PixelPoint, 4> corners{{{from.x + nx, from.y + ny},
                                           {to.x + nx, to.y + ny},
                                           {to.x - nx, to.y - ny},
                                           {from.x - nx, from.y - ny}}};
  fill_convex(corners, colour);
}

void Canvas::frame(PixelPoint upper_left, PixelPoint lower_right, double width, Colour colour) {
  const double left = upper_left.x, top = upper_left.y, right = lower_right.x, bottom = lower_right.y;
  fill_rectangle({left - width, top - width}, {right + width, top}, colour);
  fill_rectangle({left - width, bottom}, {right + width, bottom + width}, colour);
  fill_rectangle({left - width, top}, {left, bottom}, colour);
  fill_rectangle({right, top}, {right + width, bottom}, colour);
}

double Canvas::text_width(std::string_view text) {
  return kAdvance * static_cast<double>(printable(text).size()) - kDot;
}

void Canvas::text(PixelPoint anchor, Align align, std::string_view text, Colour colour) {
  const double width = text_width(text);
  double left = std::round(anchor.x - (align == Align::left     ? 0
                                       : align == Align::centre ? width / 2
                                                                : width));
  const double top = std::round(anchor.y - kTextHeight / 2);
  for (const char letter : printable(text)) {
    for (int row = 0; row < kGlyphRows; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph_dot(letter, row, column)) {
          const double x = left + kDot * column, y = top + kDot * row;
          fill_rectangle({x, y}, {x + kDot, y + kDot}, colour);
        }
    left += kAdvance;
  }
}

std::vector<std::uint8_t> Canvas::pixels() const {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  constexpr std::size_t kSide = kSamples;
  std::vector<std::uint8_t> pixel(3 * width * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      unsigned red = 0, green = 0, blue = 0;
      for (std::size_t j = 0; j < kSide; ++j)
        for (std::size_t i = 0; i < kSide; ++i) {
          const Colour& c = sample_[(kSide * y + j) * kSide * width + kSide * x + i];
          red += c.red;
          green += c.green;
          blue += c.blue;
        }
      std::uint8_t* out = &pixel[3 * (width * y + x)];
      constexpr unsigned kCount = kSide * kSide;
      out[0] = static_cast<std::uint8_t>((red + kCount / 2) / kCount);
      out[1] = static_cast<std::uint8_t>((green + kCount / 2) / kCount);
      out[2] = static_cast<std::uint8_t>((blue + kCount / 2) / kCount);
    }
  return pixel;
}

void Canvas::write_png(const std::filesystem::path& path) const {
  const std::vector<std::uint8_t> pixel = pixels();
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(append, &bytes, width_, height_, 3, pixel.data(), 3 * width_) == 0)
    throw_file_error("encode", path, ENOMEM);
  write_aside(path, bytes);
}

}  // namespace mpmfast
