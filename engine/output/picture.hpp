#pragma once

/// @file A picture of a field: a titled box of equal axes, with a colour bar where the field is a number.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/canvas.hpp"
#include "engine/output/scales.hpp"

namespace mpmfast {

/// Titles of a picture.
struct PictureText {
  std::string title, subtitle;
  std::string note;  ///< behind the subtitle, or below it in a narrow picture
};

/// What is written around the box; there is space for all of it.
struct Labels {
  /// The longest texts that this picture or another of its series may have.
  PictureText longest;
  DisplayUnit length;        ///< of the axes
  std::string_view axes;     ///< a letter for each axis; none in 3-D, where they are in the box
  std::optional<Range> bar;  ///< values at the ends of the colour bar; nothing without a bar
  std::string bar_unit;      ///< SI
};

/// The plot box and what is written around it. Lengths in m, y up.
class Picture {
 public:
  static constexpr double kLongSide = 1000;  ///< pixels, of a picture with a title of one line

  /// Widened about its middle where it is too narrow for labels.
  Picture(Range x, Range y, const Labels& labels, PictureFormat format);

  PixelPoint at(double x, double y) const {
    return {box_upper_left_.x + (x - layout_.x.lower) * layout_.scale,
            box_lower_right_.y - (y - layout_.y.lower) * layout_.scale};
  }
  double pixels_per_metre() const { return layout_.scale; }
  Canvas& canvas() { return canvas_; }

  void write_titles(const PictureText& text);
  void draw_axes();
  void draw_frame();
  void draw_colour_bar(const ColourScale& scale);

 private:
  struct Layout {
    Range x, y;
    double scale;  ///< pixels per metre
    double left, right;
    int width, height;
    bool note_below;
    std::size_t title_lines, lines;  ///< of the title; of all
    double top() const;              ///< of the box, pixels
  };
  static Layout make_layout(Range x, Range y, const Labels& labels);
  Picture(const Layout& layout, const Labels& labels, PictureFormat format);

  Layout layout_;
  Labels labels_;
  PixelPoint box_upper_left_, box_lower_right_;
  Canvas canvas_;
};

}  // namespace mpmfast
