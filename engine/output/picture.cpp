#include "engine/output/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/quantities/code_point.hpp"

namespace mpmfast {
namespace {

constexpr double kLongSide = 1000;  // pixels
constexpr double kShortestBox = 260;
constexpr double kLeft = 84, kTop = 84, kBottom = 64, kRight = 30, kRightWithBar = 150;
constexpr double kMargin = 12, kFirstLine = 20, kLine = 24;
constexpr double kTick = 6, kLineWidth = 1.5;
constexpr double kAboveBox = 18;  // to the middle of a unit: clear of a number at the box's upper end
constexpr Colour kInk{30, 30, 30};

void widen(Range& range, double width) {
  if (range.width() >= width) return;
  const double middle = 0.5 * (range.lower + range.upper);
  range = {middle - 0.5 * width, middle + 0.5 * width};
}

/// The text, or as many of its letters as there is room for.
std::string fitted(const std::string& text, double room) {
  if (Canvas::text_width(text) <= room) return text;
  std::size_t end = 0;
  for (double width = Canvas::text_width("..."); end < text.size();) {
    const std::size_t bytes = std::max<std::size_t>(code_point(text, end).bytes, 1);
    width += Canvas::text_width(text.substr(end, bytes));
    if (width > room) break;
    end += bytes;
  }
  return text.substr(0, end) + "...";
}

double spacing_of(const std::vector<double>& ticks) { return ticks.size() > 1 ? ticks[1] - ticks[0] : 1; }

}  // namespace

double Picture::Layout::top() const { return kTop + (note_below ? kLine : 0); }

Picture::Layout Picture::make_layout(Range x, Range y, bool room_for_bar, std::string_view longest) {
  const double right = room_for_bar ? kRightWithBar : kRight;
  const double room_x = kLongSide - kLeft - right, room_y = kLongSide - kTop - kBottom;
  double scale = std::min(room_x / x.width(), room_y / y.width());
  widen(x, kShortestBox / scale);
  widen(y, kShortestBox / scale);
  scale = std::min(room_x / x.width(), room_y / y.width());
  const int width = static_cast<int>(std::ceil(kLeft + x.width() * scale + right));
  Layout layout{x, y, scale, width, 0, Canvas::text_width(longest) > width - 2 * kMargin};
  layout.height = static_cast<int>(std::ceil(layout.top() + y.width() * scale + kBottom));
  return layout;
}

Picture::Picture(Range x, Range y, bool room_for_bar, std::string_view longest, PictureFormat format)
    : Picture(make_layout(x, y, room_for_bar, longest), format) {}

Picture::Picture(const Layout& layout, PictureFormat format)
    : x_(layout.x),
      y_(layout.y),
      scale_(layout.scale),
      note_below_(layout.note_below),
      box_upper_left_{kLeft, layout.top()},
      box_lower_right_{kLeft + layout.x.width() * layout.scale,
                       layout.top() + layout.y.width() * layout.scale},
      canvas_(layout.width, layout.height, format) {}

void Picture::write_titles(const PictureText& text) {
  canvas_.set_title(text.title);
  std::vector<std::string> lines{text.title, text.subtitle};
  if (note_below_)
    lines.push_back(text.note);
  else if (!text.note.empty())
    lines.back() += ", " + text.note;
  const double room = canvas_.width() - 2 * kMargin;
  for (std::size_t k = 0; k < lines.size(); ++k)
    canvas_.text({kMargin, kFirstLine + kLine * static_cast<double>(k)}, Align::left, fitted(lines[k], room),
                 kInk);
}

void Picture::draw_frame() { canvas_.frame(box_upper_left_, box_lower_right_, kLineWidth, kInk); }

void Picture::draw_axes(const DisplayUnit& unit, std::string_view names) {
  const auto scaled = [&](Range r) { return Range{r.lower / unit.in_si, r.upper / unit.in_si}; };
  const double width = x_.width() * scale_, height = y_.width() * scale_;
  const double bottom = box_lower_right_.y, left = box_upper_left_.x;
  const std::vector<double> ticks_x = round_ticks(scaled(x_), std::max(2, static_cast<int>(width / 110)));
  for (double tick : ticks_x) {
    const double x = at(tick * unit.in_si, 0).x;
    canvas_.line({x, bottom}, {x, bottom + kTick}, kLineWidth, kInk);
    canvas_.text({x, bottom + kTick + 13}, Align::centre, tick_label(tick, spacing_of(ticks_x)), kInk);
  }
  const std::vector<double> ticks_y = round_ticks(scaled(y_), std::max(2, static_cast<int>(height / 90)));
  for (double tick : ticks_y) {
    const double y = at(0, tick * unit.in_si).y;
    canvas_.line({left - kTick, y}, {left, y}, kLineWidth, kInk);
    canvas_.text({left - kTick - 6, y}, Align::right, tick_label(tick, spacing_of(ticks_y)), kInk);
  }
  const auto label = [&](std::size_t axis) { return fmt::format("{} ({})", names[axis], unit.name); };
  canvas_.text({left + 0.5 * width, bottom + 46}, Align::centre, label(0), kInk);
  // Ends with the numbers below it, where there is room for all of it.
  const double end = std::max(left - kTick - 6, kMargin + Canvas::text_width(label(1)));
  canvas_.text({end, box_upper_left_.y - kAboveBox}, Align::right, label(1), kInk);
  draw_frame();
}

void Picture::draw_colour_bar(const ColourScale& scale, const std::string& si_unit) {
  const Range range = scale.range();
  const double left = box_lower_right_.x + 22, right = left + 20;
  const double top = box_upper_left_.y, bottom = box_lower_right_.y, height = bottom - top;
  const int steps = static_cast<int>(height);
  for (int i = 0; i < steps; ++i) {
    const double value = range.lower + (i + 0.5) / steps * range.width();
    const double from = bottom - i * height / steps;
    // Also under the next one: viewers of vectors would show seams between them.
    const double to = std::max(top, bottom - (i + 2) * height / steps);
    canvas_.fill_convex(std::array<PixelPoint, 4>{{{left, from}, {right, from}, {right, to}, {left, to}}},
                        scale(value));
  }
  canvas_.frame({left, top}, {right, bottom}, kLineWidth, kInk);
  const DisplayUnit unit = display_unit(std::max(std::abs(range.lower), std::abs(range.upper)), si_unit);
  const Range shown{range.lower / unit.in_si, range.upper / unit.in_si};
  const std::vector<double> ticks = round_ticks(shown, std::max(3, static_cast<int>(height / 90)));
  for (double tick : ticks) {
    const double y = bottom - (tick - shown.lower) / shown.width() * height;
    canvas_.line({right, y}, {right + kTick, y}, kLineWidth, kInk);
    canvas_.text({right + kTick + 5, y}, Align::left, tick_label(tick, spacing_of(ticks)), kInk);
  }
  canvas_.text({left, top - kAboveBox}, Align::left, unit.name, kInk);
}

}  // namespace mpmfast
