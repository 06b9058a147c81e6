#pragma once

/// @file A small anti-aliased painter: filled polygons, discs and text on white, written as PNG.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace mpmfast {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  static constexpr Colour hex(unsigned rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16 & 255), static_cast<std::uint8_t>(rgb >> 8 & 255),
            static_cast<std::uint8_t>(rgb & 255)};
  }
};

/// Pixels from the upper left corner, y down.
struct PixelPoint {
  double x = 0, y = 0;
};

enum class Align { left, centre, right };

/// Draws at kSamples × kSamples the resolution of the picture it writes. Whatever is outside, or not a
/// number, is cut.
class Canvas {
 public:
  Canvas(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }

  void fill_convex(std::span<const PixelPoint> corners, Colour colour);
  void fill_rectangle(PixelPoint upper_left, PixelPoint lower_right, Colour colour);
  void fill_disc(PixelPoint centre, double radius, Colour colour);
  void line(PixelPoint from, PixelPoint to, double width, Colour colour);
  void frame(PixelPoint upper_left, PixelPoint lower_right, double width, Colour colour);

  static constexpr double kTextHeight = 14;  ///< pixels of a capital letter
  static double text_width(std::string_view text);
  /// @param anchor left, middle or right end of the text, at mid height
  void text(PixelPoint anchor, Align align, std::string_view text, Colour colour = {});

  /// Red, green and blue of every pixel, row by row.
  std::vector<std::uint8_t> pixels() const;
  /// Written to a temporary name and renamed; throws FileError.
  void write_png(const std::filesystem::path& path) const;

 private:
  static constexpr int kSamples = 3;
  void fill_row(int row, double from, double to, Colour colour);

  int width_, height_;
  std::vector<Colour> sample_;
};

}  // namespace mpmfast
