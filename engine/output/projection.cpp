#include "engine/output/projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mpmfast {
namespace {

constexpr double kAzimuth = 0.6, kElevation = 0.45;  // rad, of the eye from −y and above the horizon
constexpr double kLeastMargin = 0.14;                // of the longer side of the view, beside the box
constexpr double kMostBox = 700;  // pixels of a picture's side with its own margins and a bar taken off
constexpr Colour kBoxEdge{170, 170, 170}, kLabelInk{30, 30, 30};

/// Corner c has the upper coordinate along axis d where bit d is set.
Vec<3> corner(const Vec<3>& lower, const Vec<3>& upper, int c) {
  Vec<3> point;
  for (int d = 0; d < 3; ++d) point[d] = (c >> d & 1) != 0 ? upper[d] : lower[d];
  return point;
}

}  // namespace

Vec<3> to_view(const Vec<3>& point) {
  const double ca = std::cos(kAzimuth), sa = std::sin(kAzimuth);
  const double ce = std::cos(kElevation), se = std::sin(kElevation);
  const double right = ca * point[0] + sa * point[1], away = ca * point[1] - sa * point[0];
  return {right, ce * point[2] + se * away, se * point[2] - ce * away};
}

ViewBox::ViewBox(const std::array<Range, 3>& box, const DisplayUnit& unit)
    : lower_(box[0].lower, box[1].lower, box[2].lower),
      upper_(box[0].upper, box[1].upper, box[2].upper),
      unit_(unit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  across_ = up_ = {kInfinity, -kInfinity};
  for (int c = 0; c < 8; ++c) {
    const Vec<3> view = to_view(corner(lower_, upper_, c));
    across_ = {std::min(across_.lower, view[0]), std::max(across_.upper, view[0])};
    up_ = {std::min(up_.lower, view[1]), std::max(up_.upper, view[1])};
  }
  double beside = 0;  // pixels
  for (const Label& label : labels())
    beside = std::max(beside, Canvas::text_width(label.text) + std::abs(label.shift.x));
  // Of kMostBox pixels the space beside the box on both sides; kLeastMargin has space for usual numbers.
  const double margin = std::max(kLeastMargin, beside / std::max(beside, kMostBox - 2 * beside)) *
                        std::max(across_.width(), up_.width());
  across_ = {across_.lower - margin, across_.upper + margin};
  up_ = {up_.lower - margin, up_.upper + margin};
}

PixelPoint ViewBox::pixel_of(const Picture& picture, const Vec<3>& point) const {
  const Vec<3> view = to_view(point);
  return picture.at(view[0], view[1]);
}

void ViewBox::draw_edges(Picture& picture) const {
  for (int c = 0; c < 8; ++c)
    for (int d = 0; d < 3; ++d)
      if ((c >> d & 1) == 0)
        picture.canvas().line(pixel_of(picture, corner(lower_, upper_, c)),
                              pixel_of(picture, corner(lower_, upper_, c | 1 << d)), 1.5, kBoxEdge);
}

std::vector<ViewBox::Label> ViewBox::labels() const {
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  constexpr std::array<int, 3> kFrom{0, 1, 0};  // the edges that are free of particles from this side
  constexpr std::array<PixelPoint, 3> kShift{{{-8, 16}, {10, 12}, {-10, 0}}};
  constexpr std::array<PixelPoint, 3> kNameShift{{{-24, 48}, {30, 36}, {14, -20}}};
  constexpr int kTicksOfEdge = 4;
  constexpr std::array<Align, 3> kAlign{Align::right, Align::left, Align::right};
  std::vector<Label> out;
  for (std::size_t d = 0; d < 3; ++d) {
    const int axis = static_cast<int>(d);
    const Vec<3> from = corner(lower_, upper_, kFrom[d]), to = corner(lower_, upper_, kFrom[d] | 1 << axis);
    const auto write = [&](double at, const PixelPoint& shift, const std::string& text) {
      Vec<3> point = from;
      point[axis] = at;
      out.push_back({point, shift, kAlign[d], text});
    };
    const std::vector<double> ticks =
        round_ticks({from[axis] / unit_.in_si, to[axis] / unit_.in_si}, kTicksOfEdge);
    const double spacing = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    for (const double tick : ticks) write(tick * unit_.in_si, kShift[d], tick_label(tick, spacing));
    const double name_at = axis == 2 ? to[axis] : 0.5 * (from[axis] + to[axis]);  // z: above its numbers
    write(name_at, kNameShift[d], fmt::format("{} ({})", kAxes[d], unit_.name));
  }
  return out;
}

void ViewBox::draw_labels(Picture& picture) const {
  for (const Label& label : labels()) {
    const PixelPoint p = pixel_of(picture, label.at);
    picture.canvas().text({p.x + label.shift.x, p.y + label.shift.y}, label.align, label.text, kLabelInk);
  }
}

}  // namespace mpmfast
