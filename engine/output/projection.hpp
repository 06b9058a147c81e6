#pragma once

/// @file The fixed orthographic view of 3-D pictures: from the front right and above, z up.

#include <array>
#include <string>
#include <vector>

#include "engine/output/picture.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// To the right of the picture, up in it, and towards the eye.
Vec<3> to_view(const Vec<3>& point);

/// The box around the particles: its outline behind them and coordinates along its edges.
class ViewBox {
 public:
  /// @param box   of the particles, m
  /// @param unit  of its coordinates
  ViewBox(const std::array<Range, 3>& box, const DisplayUnit& unit);
  Range across() const { return across_; }
  Range up() const { return up_; }
  void draw_edges(Picture& picture) const;
  void draw_labels(Picture& picture) const;

 private:
  PixelPoint pixel_of(const Picture& picture, const Vec<3>& point) const;

  /// A text at a place of the box, so many pixels beside it.
  struct Label {
    Vec<3> at;
    PixelPoint shift;
    Align align;
    std::string text;
  };
  std::vector<Label> labels() const;

  Vec<3> lower_, upper_;
  DisplayUnit unit_;
  Range across_, up_;
};

}  // namespace mpmfast
