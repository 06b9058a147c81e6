#include "engine/output/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/output/text_lines.hpp"

namespace mpmfast {
namespace {

constexpr double kShortestBox = 260;  // pixels
constexpr double kLeft = 84, kBottom = 64, kRight = 30, kRightWithBar = 150;
constexpr double kMargin = 12, kFirstLine = 20, kLine = 24;
constexpr double kBelowTitles = 16;  // from where a next line would be to the box
constexpr double kTick = 6, kLineWidth = 1.5;
constexpr double kBeforeNumber = kTick + 6;  // of the left axis
constexpr double kBar = 22, kBarWidth = 20, kAfterBar = kTick + 5;
constexpr double kAboveBox = 18;  // to the middle of a unit: clear of a number at the box's upper end
constexpr std::size_t kMostTitleLines = 8;
constexpr Colour kInk{30, 30, 30};

void widen(Range& range, double width) {
  if (range.width() >= width) return;
  const double middle = 0.5 * (range.lower + range.upper);
  range = {middle - 0.5 * width, middle + 0.5 * width};
}

Range in_unit(const Range& range, const DisplayUnit& unit) {
  return {range.lower / unit.in_si, range.upper / unit.in_si};
}

/// Round numbers along a side of the box or the bar.
struct Ticks {
  /// @param range   in the unit that is shown
  /// @param length  pixels
  Ticks(const Range& range, double length, double apart, int fewest)
      : at(round_ticks(range, std::max(fewest, static_cast<int>(length / apart)))) {}
  std::string label(std::size_t k) const { return tick_label(at[k], at.size() > 1 ? at[1] - at[0] : 1); }
  /// Of the widest label, pixels.
  double width() const {
    double widest = 0;
    for (std::size_t k = 0; k < at.size(); ++k) widest = std::max(widest, Canvas::text_width(label(k)));
    return widest;
  }
  std::vector<double> at;
};

Ticks ticks_across(const Range& shown, double length) { return {shown, length, 110, 2}; }
Ticks ticks_up(const Range& shown, double length) { return {shown, length, 90, 2}; }
Ticks ticks_of_bar(const Range& shown, double length) { return {shown, length, 90, 3}; }

DisplayUnit bar_unit(const Range& bar, const std::string& si_unit) {
  return display_unit(std::max(std::abs(bar.lower), std::abs(bar.upper)), si_unit);
}

std::string axis_label(const Labels& labels, std::size_t axis) {
  return fmt::format("{} ({})", labels.axes[axis], labels.length.name);
}

double top_of(std::size_t lines) { return kFirstLine + kLine * static_cast<double>(lines) + kBelowTitles; }

/// Pixels beside the box that its labels need.
struct Margins {
  double left, right;
};

Margins margins_for(const Labels& labels, const Range& x, const Range& y, double scale) {
  Margins margins{kLeft, labels.bar ? kRightWithBar : kRight};
  if (!labels.axes.empty()) {
    const Range across = in_unit(x, labels.length);
    const Ticks ticks = ticks_across(across, x.width() * scale);
    for (std::size_t k = 0; k < ticks.at.size(); ++k) {
      const double half = 0.5 * Canvas::text_width(ticks.label(k)), pixels = scale * labels.length.in_si;
      margins.left = std::max(margins.left, half - (ticks.at[k] - across.lower) * pixels + kMargin);
      margins.right = std::max(margins.right, half - (across.upper - ticks.at[k]) * pixels + kMargin);
    }
    const double number = ticks_up(in_unit(y, labels.length), y.width() * scale).width();
    margins.left = std::max(margins.left, kBeforeNumber + number + kMargin);
  }
  if (labels.bar) {
    const DisplayUnit unit = bar_unit(*labels.bar, labels.bar_unit);
    const double number = ticks_of_bar(in_unit(*labels.bar, unit), y.width() * scale).width();
    margins.right = std::max({margins.right, kBar + kBarWidth + kAfterBar + number + kMargin,
                              kBar + Canvas::text_width(unit.name) + kMargin});
  }
  return margins;
}

/// Round-off makes no pixel more.
int whole_pixels(double length) { return static_cast<int>(std::ceil(length - 1e-6)); }

}  // namespace

double Picture::Layout::top() const { return top_of(lines); }

Picture::Layout Picture::make_layout(Range x, Range y, const Labels& labels) {
  Layout layout{};
  Margins margins{kLeft, labels.bar ? kRightWithBar : kRight};
  constexpr int kTries = 3;  // wider labels make a smaller box, whose labels need no more
  for (int k = 0; k < kTries; ++k) {
    layout.left = std::max(layout.left, margins.left);
    layout.right = std::max(layout.right, margins.right);
    const double space_x = kLongSide - layout.left - layout.right, space_y = kLongSide - top_of(2) - kBottom;
    const auto fit = [&] { layout.scale = std::min(space_x / layout.x.width(), space_y / layout.y.width()); };
    layout.x = x;
    layout.y = y;
    fit();
    widen(layout.x, kShortestBox / layout.scale);
    widen(layout.y, kShortestBox / layout.scale);
    fit();
    margins = margins_for(labels, layout.x, layout.y, layout.scale);
  }
  layout.width = whole_pixels(layout.left + layout.x.width() * layout.scale + layout.right);
  const double space = layout.width - 2 * kMargin;
  const PictureText& longest = labels.longest;
  layout.note_below =
      !longest.note.empty() && Canvas::text_width(longest.subtitle + ", " + longest.note) > space;
  layout.title_lines = text_lines(longest.title, space, kMostTitleLines).size();
  layout.lines = layout.title_lines + text_lines(longest.subtitle, space, kMostTitleLines).size();
  if (layout.note_below) layout.lines += text_lines(longest.note, space, kMostTitleLines).size();
  layout.height = whole_pixels(layout.top() + layout.y.width() * layout.scale + kBottom);
  return layout;
}

Picture::Picture(Range x, Range y, const Labels& labels, PictureFormat format)
    : Picture(make_layout(x, y, labels), labels, format) {}

Picture::Picture(const Layout& layout, const Labels& labels, PictureFormat format)
    : layout_(layout),
      labels_(labels),
      box_upper_left_{layout.left, layout.top()},
      box_lower_right_{layout.left + layout.x.width() * layout.scale,
                       layout.top() + layout.y.width() * layout.scale},
      canvas_(layout.width, layout.height, format) {}

void Picture::write_titles(const PictureText& text) {
  canvas_.set_title(text.title);
  const double space = canvas_.width() - 2 * kMargin;
  std::vector<std::string> lines;
  const auto add = [&](const std::string& part, std::size_t most) {
    for (std::string& line : text_lines(part, space, std::max<std::size_t>(most, 1)))
      lines.push_back(std::move(line));
  };
  add(text.title, layout_.title_lines);
  const bool behind = !layout_.note_below && !text.note.empty();
  add(text.subtitle + (behind ? ", " + text.note : ""), layout_.lines - lines.size());
  if (layout_.note_below && !text.note.empty() && lines.size() < layout_.lines)
    add(text.note, layout_.lines - lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k)
    canvas_.text({kMargin, kFirstLine + kLine * static_cast<double>(k)}, Align::left, lines[k], kInk);
}

void Picture::draw_frame() { canvas_.frame(box_upper_left_, box_lower_right_, kLineWidth, kInk); }

void Picture::draw_axes() {
  const DisplayUnit& unit = labels_.length;
  const double width = box_lower_right_.x - box_upper_left_.x,
               height = box_lower_right_.y - box_upper_left_.y;
  const double bottom = box_lower_right_.y, left = box_upper_left_.x;
  const Ticks across = ticks_across(in_unit(layout_.x, unit), width);
  for (std::size_t k = 0; k < across.at.size(); ++k) {
    const double x = at(across.at[k] * unit.in_si, 0).x;
    canvas_.line({x, bottom}, {x, bottom + kTick}, kLineWidth, kInk);
    canvas_.text({x, bottom + kTick + 13}, Align::centre, across.label(k), kInk);
  }
  const Ticks up = ticks_up(in_unit(layout_.y, unit), height);
  for (std::size_t k = 0; k < up.at.size(); ++k) {
    const double y = at(0, up.at[k] * unit.in_si).y;
    canvas_.line({left - kTick, y}, {left, y}, kLineWidth, kInk);
    canvas_.text({left - kBeforeNumber, y}, Align::right, up.label(k), kInk);
  }
  canvas_.text({left + 0.5 * width, bottom + 46}, Align::centre, axis_label(labels_, 0), kInk);
  // Ends with the numbers below it, where there is space for all of it.
  const double end = std::max(left - kBeforeNumber, kMargin + Canvas::text_width(axis_label(labels_, 1)));
  canvas_.text({end, box_upper_left_.y - kAboveBox}, Align::right, axis_label(labels_, 1), kInk);
  draw_frame();
}

void Picture::draw_colour_bar(const ColourScale& scale) {
  const Range range = scale.range();
  const double left = box_lower_right_.x + kBar, right = left + kBarWidth;
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
  const DisplayUnit unit = bar_unit(range, labels_.bar_unit);
  const Range shown = in_unit(range, unit);
  const Ticks ticks = ticks_of_bar(shown, height);
  for (std::size_t k = 0; k < ticks.at.size(); ++k) {
    const double y = bottom - (ticks.at[k] - shown.lower) / shown.width() * height;
    canvas_.line({right, y}, {right + kTick, y}, kLineWidth, kInk);
    canvas_.text({right + kAfterBar, y}, Align::left, ticks.label(k), kInk);
  }
  canvas_.text({left, top - kAboveBox}, Align::left, unit.name, kInk);
}

}  // namespace mpmfast
