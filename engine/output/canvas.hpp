#pragma once

/// @file Cairo in a few words: polygons, discs, lines and text on white, as pixels or as vectors.

#include <cairo.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mpmfast {

struct Colour {
  std::uint8_t red{}, green{}, blue{};
  static constexpr Colour hex(unsigned rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16 & 255), static_cast<std::uint8_t>(rgb >> 8 & 255),
            static_cast<std::uint8_t>(rgb & 255)};
  }
  auto operator<=>(const Colour&) const = default;
};

/// Pixels from the upper left corner, y down.
struct PixelPoint {
  double x{}, y{};
};

enum class Align { left, centre, right };

enum class PictureFormat { png, pdf, svg };

/// That of the file's name; nothing where it is no picture's.
std::optional<PictureFormat> picture_format(const std::filesystem::path& file);

struct CairoDelete {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_font_face_t* face) const { cairo_font_face_destroy(face); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
  void operator()(cairo_scaled_font_t* font) const { cairo_scaled_font_destroy(font); }
};
template <class T>
using CairoPointer = std::unique_ptr<T, CairoDelete>;

/// Pixels are the mean of kSamples × kSamples samples, each of one shape, so that neighbours that share an
/// edge show no seam. What is not a number is left out. Throws FileError where Cairo fails.
class Canvas {
 public:
  static constexpr int kSamples = 3;  ///< a pixel's side

  Canvas(int width, int height, PictureFormat format = PictureFormat::png);
  Canvas(Canvas&&) = default;
  Canvas& operator=(Canvas&&) = delete;  // Cairo ends a file, into bytes_, when its context goes
  int width() const { return width_; }
  int height() const { return height_; }

  void fill_convex(std::span<const PixelPoint> corners, Colour colour);
  void fill_disc(PixelPoint centre, double radius, Colour colour);
  void line(PixelPoint from, PixelPoint to, double width, Colour colour);
  /// Around the rectangle.
  void frame(PixelPoint upper_left, PixelPoint lower_right, double width, Colour colour);

  static double text_width(std::string_view text);
  /// @param text    UTF-8; what is none, and control characters, show as such
  /// @param anchor  left, middle or right end of the text, at mid height
  void text(PixelPoint anchor, Align align, std::string_view text, Colour colour = {});
  /// What a viewer of the file calls it.
  void set_title(std::string_view title);

  /// Red, green and blue of every pixel, row by row; of a PNG.
  std::vector<std::uint8_t> pixels();
  /// Written to a temporary name and renamed, and done with; throws FileError.
  void write(const std::filesystem::path& path);

 private:
  bool is_vector() const { return format_ != PictureFormat::png; }
  void take(Colour colour);

  int width_, height_;
  PictureFormat format_;
  std::unique_ptr<std::string> bytes_;  ///< what Cairo wrote of a vector file, where Cairo knows it to be
  std::string svg_text_, svg_title_;
  Colour colour_;
  int waiting_ = 0;  ///< polygons of that colour, in one path: vector files are a third so
  CairoPointer<cairo_t> context_;
};

}  // namespace mpmfast
