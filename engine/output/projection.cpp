#include "engine/output/projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mpmfast {
namespace {

constexpr double kAzimuth = 0.6, kElevation = 0.45;  // rad, of the eye from −y and above the horizon
constexpr Colour kEdge{170, 170, 170}, kInk{30, 30, 30};

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

ViewBox::ViewBox(const Vec<3>& lower, const Vec<3>& upper) : lower_(lower), upper_(upper) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  across_ = up_ = {kInfinity, -kInfinity};
  for (int c = 0; c < 8; ++c) {
    const Vec<3> view = to_view(corner(lower_, upper_, c));
    across_ = {std::min(across_.lower, view[0]), std::max(across_.upper, view[0])};
    up_ = {std::min(up_.lower, view[1]), std::max(up_.upper, view[1])};
  }
  const double margin = 0.14 * std::max(across_.width(), up_.width());  // room for the labels
  across_ = {across_.lower - margin, across_.upper + margin};
  up_ = {up_.lower - margin, up_.upper + margin};
}

PixelPoint ViewBox::place(const Picture& picture, const Vec<3>& point) const {
  const Vec<3> view = to_view(point);
  return picture.at(view[0], view[1]);
}

void ViewBox::draw_edges(Picture& picture) const {
  for (int c = 0; c < 8; ++c)
    for (int d = 0; d < 3; ++d)
      if ((c >> d & 1) == 0)
        picture.canvas().line(place(picture, corner(lower_, upper_, c)),
                              place(picture, corner(lower_, upper_, c | 1 << d)), 1.5, kEdge);
}

void ViewBox::draw_labels(Picture& picture, const DisplayUnit& unit) const {
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  constexpr std::array<int, 3> kFrom{0, 1, 0};  // the edges that are free of particles from this side
  constexpr std::array<PixelPoint, 3> kShift{{{-8, 16}, {10, 12}, {-10, 0}}};
  constexpr std::array<PixelPoint, 3> kNameShift{{{-24, 48}, {30, 36}, {14, -20}}};
  constexpr int kTicksOfEdge = 4;
  constexpr std::array<Align, 3> kAlign{Align::right, Align::left, Align::right};
  for (std::size_t d = 0; d < 3; ++d) {
    const int axis = static_cast<int>(d);
    const Vec<3> from = corner(lower_, upper_, kFrom[d]), to = corner(lower_, upper_, kFrom[d] | 1 << axis);
    const auto write = [&](double at, const PixelPoint& shift, const std::string& text) {
      Vec<3> point = from;
      point[axis] = at;
      const PixelPoint p = place(picture, point);
      picture.canvas().text({p.x + shift.x, p.y + shift.y}, kAlign[d], text, kInk);
    };
    const std::vector<double> ticks =
        round_ticks({from[axis] / unit.in_si, to[axis] / unit.in_si}, kTicksOfEdge);
    const double spacing = ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
    for (const double tick : ticks) write(tick * unit.in_si, kShift[d], tick_label(tick, spacing));
    const double name_at = axis == 2 ? to[axis] : 0.5 * (from[axis] + to[axis]);  // z: above its numbers
    write(name_at, kNameShift[d], fmt::format("{} ({})", kAxes[d], unit.name));
  }
}

}  // namespace mpmfast
