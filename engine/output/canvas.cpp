#include "engine/output/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <new>
#include <numbers>

#include "engine/errors.hpp"
#include "engine/output/files.hpp"
#include "engine/quantities/code_point.hpp"

namespace mpmfast {
namespace {

using CairoSurface = CairoPointer<cairo_surface_t>;

constexpr double kFontSize = 18, kCapital = 0.73 * kFontSize;  // pixels
constexpr double kPointsOfPixel = 0.5;                         // in a PDF: as wide as a page of text
constexpr int kMostOfPath = 10000;
constexpr double kFar = 100000;  // pixels: Cairo's numbers end at some millions of samples

/// Where their bytes lie in the four of one of Cairo's pixels.
constexpr std::array<std::size_t, 3> kRedGreenBlue{2, 1, 0};
static_assert(std::endian::native == std::endian::little);

void require(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS)
    throw FileError(fmt::format("cannot draw a picture: {}", cairo_status_to_string(status)));
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned size) {
  try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::bad_alloc&) {  // no exception may pass through Cairo
    return CAIRO_STATUS_NO_MEMORY;
  }
}

CairoSurface open_surface(int width, int height, PictureFormat format, std::string* bytes) {
  if (format == PictureFormat::png)
    return CairoSurface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, width * Canvas::kSamples, height * Canvas::kSamples));
  if (format == PictureFormat::svg) {
    CairoSurface surface(cairo_svg_surface_create_for_stream(append, bytes, width, height));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
    return surface;
  }
  CairoSurface surface(
      cairo_pdf_surface_create_for_stream(append, bytes, width * kPointsOfPixel, height * kPointsOfPixel));
  // Of one run always the same bytes.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  return surface;
}

CairoPointer<cairo_font_face_t> font_face() {
  return CairoPointer<cairo_font_face_t>(
      cairo_toy_font_face_create("sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL));
}

/// Letters that are as wide at any size.
CairoPointer<cairo_font_options_t> font_options() {
  CairoPointer<cairo_font_options_t> options(cairo_font_options_create());
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  return options;
}

/// Cairo's own font, where none is installed. It has ASCII alone, and PDF viewers show black boxes of it.
bool is_own(cairo_scaled_font_t* font) { return cairo_scaled_font_get_type(font) == CAIRO_FONT_TYPE_USER; }

/// Cairo and XML take no code points that are no characters.
std::string readable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint point = code_point(text, at);
    const bool control = point.code < 0x20 || (point.code >= 0x7F && point.code < 0xA0);
    const bool none = (point.code & 0xFFFE) == 0xFFFE || (point.code >= 0xFDD0 && point.code <= 0xFDEF);
    if (point.bytes == 0 || none)
      out += "\uFFFD";
    else if (control)
      out += ' ';
    else
      out += text.substr(at, point.bytes);
    at += std::max<std::size_t>(point.bytes, 1);
  }
  return out;
}

std::string in_xml(std::string_view text) {
  std::string out;
  for (const char letter : text)
    out += letter == '&' ? "&amp;" : letter == '<' ? "&lt;" : letter == '>' ? "&gt;" : std::string(1, letter);
  return out;
}

}  // namespace

std::optional<PictureFormat> picture_format(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".png") return PictureFormat::png;
  if (extension == ".pdf") return PictureFormat::pdf;
  return extension == ".svg" ? std::optional(PictureFormat::svg) : std::nullopt;
}

Canvas::Canvas(int width, int height, PictureFormat format)
    : width_(width),
      height_(height),
      format_(format),
      bytes_(std::make_unique<std::string>()),
      context_(cairo_create(open_surface(width, height, format, bytes_.get()).get())) {
  cairo_t* c = context_.get();
  const double scale = format == PictureFormat::png   ? kSamples
                       : format == PictureFormat::pdf ? kPointsOfPixel
                                                      : 1;
  cairo_scale(c, scale, scale);
  if (!is_vector()) {
    cairo_set_antialias(c, CAIRO_ANTIALIAS_NONE);
    cairo_set_tolerance(c, 0.3);  // samples
  }
  cairo_set_font_face(c, font_face().get());
  cairo_set_font_size(c, kFontSize);
  cairo_set_font_options(c, font_options().get());
  take({255, 255, 255});
  cairo_paint(c);
  require(cairo_status(c));
}

/// Fills the polygons that wait, and takes the colour for what comes next.
void Canvas::take(Colour colour) {
  if (waiting_ > 0) cairo_fill(context_.get());
  waiting_ = 0;
  colour_ = colour;
  cairo_set_source_rgb(context_.get(), colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
}

void Canvas::fill_convex(std::span<const PixelPoint> corners, Colour colour) {
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PixelPoint &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += a.x * b.y - a.y * b.x;
  }
  if (!std::isfinite(area)) return;
  if (waiting_ == kMostOfPath || colour != colour_) take(colour);
  ++waiting_;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    // All turn the same way: where they overlap in one path, nothing cancels.
    const PixelPoint& corner = area < 0 ? corners[corners.size() - 1 - i] : corners[i];
    const double x = std::clamp(corner.x, -kFar, kFar), y = std::clamp(corner.y, -kFar, kFar);
    if (i == 0)
      cairo_move_to(context_.get(), x, y);
    else
      cairo_line_to(context_.get(), x, y);
  }
  cairo_close_path(context_.get());
}

void Canvas::fill_disc(PixelPoint centre, double radius, Colour colour) {
  if (!(std::abs(centre.x) < kFar && std::abs(centre.y) < kFar && radius < kFar)) return;
  take(colour);
  cairo_arc(context_.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(context_.get());
}

void Canvas::line(PixelPoint from, PixelPoint to, double width, Colour colour) {
  take(colour);
  cairo_move_to(context_.get(), from.x, from.y);
  cairo_line_to(context_.get(), to.x, to.y);
  cairo_set_line_width(context_.get(), width);
  cairo_stroke(context_.get());
}

void Canvas::frame(PixelPoint upper_left, PixelPoint lower_right, double width, Colour colour) {
  take(colour);
  cairo_rectangle(context_.get(), upper_left.x - width / 2, upper_left.y - width / 2,
                  lower_right.x - upper_left.x + width, lower_right.y - upper_left.y + width);
  cairo_set_line_width(context_.get(), width);
  cairo_stroke(context_.get());
}

double Canvas::text_width(std::string_view text) {
  cairo_matrix_t size, unscaled;
  cairo_matrix_init_scale(&size, kFontSize, kFontSize);
  cairo_matrix_init_identity(&unscaled);
  const CairoPointer<cairo_scaled_font_t> font(
      cairo_scaled_font_create(font_face().get(), &size, &unscaled, font_options().get()));
  cairo_text_extents_t extents;
  const std::string letters = readable(text);
  cairo_scaled_font_text_extents(font.get(), (is_own(font.get()) ? plain_spelling(letters) : letters).c_str(),
                                 &extents);
  require(cairo_scaled_font_status(font.get()));
  return extents.x_advance;
}

void Canvas::text(PixelPoint anchor, Align align, std::string_view text, Colour colour) {
  const std::string letters = readable(text);
  const double width = text_width(letters);
  const double left = anchor.x - (align == Align::left ? 0 : align == Align::centre ? width / 2 : width);
  const double line = anchor.y + kCapital / 2;
  if (format_ == PictureFormat::svg) {  // Cairo would draw outlines, which nobody can search or edit
    svg_text_ += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" textLength=\"{:.2f}\" lengthAdjust=\"spacingAndGlyphs\" "
        "fill=\"#{:02x}{:02x}{:02x}\">{}</text>\n",
        left, line, width, colour.red, colour.green, colour.blue, in_xml(letters));
    return;
  }
  take(colour);
  cairo_move_to(context_.get(), left, line);
  if (is_own(cairo_get_scaled_font(context_.get()))) {
    cairo_text_path(context_.get(), plain_spelling(letters).c_str());
    cairo_fill(context_.get());
  } else
    cairo_show_text(context_.get(), letters.c_str());
}

void Canvas::set_title(std::string_view title) {
  if (format_ == PictureFormat::pdf)
    cairo_pdf_surface_set_metadata(cairo_get_target(context_.get()), CAIRO_PDF_METADATA_TITLE,
                                   readable(title).c_str());
  svg_title_ = in_xml(readable(title));
}

std::vector<std::uint8_t> Canvas::pixels() {
  assert(!is_vector());
  take({});
  require(cairo_status(context_.get()));
  cairo_surface_t* samples = cairo_get_target(context_.get());
  cairo_surface_flush(samples);
  const auto row = static_cast<std::size_t>(cairo_image_surface_get_stride(samples));
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  constexpr unsigned kCount = kSamples * kSamples;
  std::vector<std::uint16_t> sum(row);  // of a column of samples, by channel
  std::vector<std::uint8_t> out(3 * width * height);
  std::uint8_t* to = out.data();
  const unsigned char* from = cairo_image_surface_get_data(samples);
  for (std::size_t y = 0; y < height; ++y) {
    std::fill(sum.begin(), sum.end(), 0);
    for (int j = 0; j < kSamples; ++j, from += row)
      for (std::size_t k = 0; k < row; ++k) sum[k] = static_cast<std::uint16_t>(sum[k] + from[k]);
    for (std::size_t x = 0; x < width; ++x)
      for (const std::size_t channel : kRedGreenBlue) {
        unsigned of_pixel = kCount / 2;
        for (std::size_t i = 0; i < kSamples; ++i) of_pixel += sum[4 * (kSamples * x + i) + channel];
        *to++ = static_cast<std::uint8_t>(of_pixel / kCount);
      }
  }
  return out;
}

void Canvas::write(const std::filesystem::path& path) {
  if (!is_vector()) {
    const std::vector<std::uint8_t> rgb = pixels();
    std::vector<unsigned char> pixel(rgb.size() / 3 * 4);
    for (std::size_t k = 0; k < rgb.size(); ++k) pixel[k / 3 * 4 + kRedGreenBlue[k % 3]] = rgb[k];
    const CairoSurface surface(
        cairo_image_surface_create_for_data(pixel.data(), CAIRO_FORMAT_RGB24, width_, height_, 4 * width_));
    require(cairo_surface_write_to_png_stream(surface.get(), append, bytes_.get()));
  } else {
    take({});
    require(cairo_status(context_.get()));
    cairo_surface_finish(cairo_get_target(context_.get()));
    require(cairo_surface_status(cairo_get_target(context_.get())));
  }
  if (format_ == PictureFormat::svg) {
    bytes_->insert(
        bytes_->rfind("</svg>"),
        fmt::format("<g font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"{}\">\n{}</g>\n",
                    kFontSize, svg_text_));
    if (!svg_title_.empty())  // the first in its element
      bytes_->insert(bytes_->find('>', bytes_->find("<svg")) + 1,
                     fmt::format("\n<title>{}</title>", svg_title_));
  }
  write_aside(path, *bytes_);
}

}  // namespace mpmfast
