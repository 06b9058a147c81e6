#pragma once

/// @file A picture of a field: a titled box of equal axes, with a colour bar where the field is a number.

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/output/canvas.hpp"
#include "engine/output/scales.hpp"

namespace mpmfast {

/// What a picture shows beside the particles.
struct PictureText {
  std::string title, subtitle;
  std::string note;  ///< behind the subtitle, or below it in a narrow picture
};

/// The plot box and what is written around it. Lengths in m, y up.
class Picture {
 public:
  /// Widened about its middle where it is too narrow for labels.
  /// @param longest  the longest subtitle with its note that this picture or another of its series may have
  Picture(Range x, Range y, bool room_for_bar, std::string_view longest, PictureFormat format);

  PixelPoint at(double x, double y) const {
    return {box_upper_left_.x + (x - x_.lower) * scale_, box_lower_right_.y - (y - y_.lower) * scale_};
  }
  double pixels_per_metre() const { return scale_; }
  Canvas& canvas() { return canvas_; }

  void write_titles(const PictureText& text);
  /// @param unit   of lengths
  /// @param names  a letter for each axis
  void draw_axes(const DisplayUnit& unit, std::string_view names);
  void draw_frame();
  void draw_colour_bar(const ColourScale& scale, const std::string& si_unit);

 private:
  struct Layout {
    Range x, y;
    double scale;
    int width, height;
    bool note_below;
    double top() const;  ///< of the box, pixels
  };
  static Layout make_layout(Range x, Range y, bool room_for_bar, std::string_view longest);
  Picture(const Layout& layout, PictureFormat format);

  Range x_, y_;
  double scale_;
  bool note_below_;
  PixelPoint box_upper_left_, box_lower_right_;
  Canvas canvas_;
};

}  // namespace mpmfast
