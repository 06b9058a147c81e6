#pragma once

/// @file The fixed orthographic view of 3-D pictures: from the front right and above, z up.

#include "engine/output/picture.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// To the right of the picture, up in it, and towards the eye.
Vec<3> to_view(const Vec<3>& point);

/// The box around the particles: its outline behind them and coordinates along its edges.
class ViewBox {
 public:
  ViewBox(const Vec<3>& lower, const Vec<3>& upper);
  Range across() const { return across_; }
  Range up() const { return up_; }
  void draw_edges(Picture& picture) const;
  void draw_labels(Picture& picture, const DisplayUnit& unit) const;

 private:
  PixelPoint place(const Picture& picture, const Vec<3>& point) const;

  Vec<3> lower_, upper_;
  Range across_, up_;
};

}  // namespace mpmfast
