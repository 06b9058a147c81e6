#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/output/cover.hpp"
#include "engine/output/drawn.hpp"
#include "engine/output/output.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/picture.hpp"
#include "engine/output/projection.hpp"

namespace mpmfast {
namespace {

/// The least range that holds all that it is shown.
struct Extent {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  void include(double x) {
    if (!std::isfinite(x)) return;
    lower = std::min(lower, x);
    upper = std::max(upper, x);
  }
  std::optional<Range> range() const {
    return lower < upper ? std::optional(Range{lower, upper}) : std::nullopt;
  }
};

/// Of the framing; of the grid where it has none.
Range box_range(const Framing& framing, const Scene& scene, std::size_t d) {
  const double origin = scene.grid.origin[d];
  return framing.box[d].value_or(Range{origin, origin + std::max(scene.grid.size[d], 1e-9)});
}

PictureText picture_text(const Scene& scene, const std::string& label, double time) {
  const DisplayUnit unit = display_unit(std::abs(time), "s");
  return {scene.title, fmt::format("{} at {:.4g} {}", label, time / unit.in_si, time == 0 ? "s" : unit.name),
          ""};
}

std::string value_text(double value, const std::string& si_unit) {
  const DisplayUnit unit = display_unit(std::abs(value), si_unit);
  return fmt::format("{:.4g} {}", value / unit.in_si + 0.0, unit.name);  // no -0
}

/// Of a field that has one value.
std::string everywhere_text(const std::string& value) { return fmt::format(": {} everywhere", value); }

/// As many digits as there may be.
PictureText longest_text(const Scene& scene, const FieldValues& field, bool has_bar) {
  const bool prefixed = display_unit(1e6, field.unit).in_si != 1;
  const std::string value = (prefixed ? "-8.888 M" : "-8.888e+88 ") + field.unit;
  PictureText text{scene.title, field.label + " at 888.8 ms", ""};
  if (has_bar)
    text.note = fmt::format("values from {} to {}", value, value);
  else if (!field.names)
    text.subtitle += everywhere_text(value);
  return text;
}

/// The colour of every particle, and the labels that explain it.
struct Colouring {
  Colouring(const FieldValues& field, const Framing& framing, const Scene& scene)
      : by_body(field.names), scale(framing.values.value_or(Range{})), value(&field.value) {
    labels.longest = longest_text(scene, field, has_bar());
    labels.length = length_unit(scene);
    if (scene.dimension() == 2) labels.axes = scene.space == Space::axisymmetric ? "rz" : "xy";
    if (has_bar()) labels.bar = scale.range();
    labels.bar_unit = field.unit;
  }
  Colour operator()(std::size_t p) const {
    return by_body ? body_colour(static_cast<std::size_t>((*value)[p])) : scale((*value)[p]);
  }
  bool has_bar() const { return !by_body && !scale.has_one_value(); }
  bool by_body;
  ColourScale scale;
  const std::vector<double>* value;
  Labels labels;
};

using Corners = std::array<PixelPoint, 4>;  ///< m, though, until they are placed

Corners parallelogram(const Vec<2>& centre, const Mat<2>& edges) {
  Corners corners;
  constexpr std::array<std::array<int, 2>, 4> kSigns{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec<2> corner = centre + kSigns[c][0] * edges.col(0) + kSigns[c][1] * edges.col(1);
    corners[c] = {corner[0], corner[1]};
  }
  return corners;
}

/// @param beyond  how far it reaches beyond its edges, m
Corners shape_of(const Particles<2>& particles, const Scene& scene, std::size_t p, double beyond = 0) {
  Mat<2> edges = drawn_half_edges(particles, scene, p);
  for (int d = 0; d < 2; ++d) edges.col(d) *= 1 + beyond / edges.col(d).norm();
  return parallelogram(particles.vector(Quantity::position, p), edges);
}

void include(std::array<Extent, 3>& box, const Particles<2>& particles, const Scene& scene, std::size_t p) {
  for (const auto& corner : shape_of(particles, scene, p)) {
    box[0].include(corner.x);
    box[1].include(corner.y);
  }
}

void include(std::array<Extent, 3>& box, const Particles<3>& particles, const Scene& scene, std::size_t p) {
  const Vec<3> centre = particles.vector(Quantity::position, p);
  const double radius = drawn_radius(particles, scene, p);
  if (!centre.allFinite() || !std::isfinite(radius)) return;
  for (int d = 0; d < 3; ++d)
    for (double side : {-radius, radius}) box[static_cast<std::size_t>(d)].include(centre[d] + side);
}

/// Of the particles in and about the grid; of all where none is there.
template <int Dim>
std::array<Extent, 3> extents_of(const Particles<Dim>& particles, const Scene& scene) {
  const Viewed viewed(scene);
  std::array<Extent, 3> box;
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (viewed.holds(particles.vector(Quantity::position, p).data())) include(box, particles, scene, p);
  if (box[0].range()) return box;
  for (std::size_t p = 0; p < particles.size(); ++p) include(box, particles, scene, p);
  return box;
}

/// Widened by so much of the longest side in all.
constexpr double kWider = 0.05;
template <std::size_t Axes>
std::array<Range, Axes> frame_of(const Framing& framing, const Scene& scene) {
  std::array<Range, Axes> box;
  double longest = 0;
  for (std::size_t d = 0; d < Axes; ++d) {
    box[d] = box_range(framing, scene, d);
    longest = std::max(longest, box[d].width());
  }
  for (Range& side : box) side = {side.lower - 0.5 * kWider * longest, side.upper + 0.5 * kWider * longest};
  return box;
}

/// Also not a place that is no number.
template <int Dim, std::size_t Axes>
bool is_within(const std::array<Range, Axes>& frame, const Vec<Dim>& x) {
  for (std::size_t d = 0; d < Axes; ++d) {
    const double at = x[static_cast<int>(d)];
    if (!(at >= frame[d].lower && at <= frame[d].upper)) return false;
  }
  return true;
}

/// Within the frame.
void draw_lines(Picture& picture, const Polylines& lines, const std::array<Range, 2>& frame) {
  constexpr Colour kDark{20, 20, 20};
  for (const auto& points : lines)
    for (std::size_t k = 1; k < points.size(); ++k)
      if (is_within(frame, points[k - 1]) && is_within(frame, points[k]))
        picture.canvas().line(picture.at(points[k - 1][0], points[k - 1][1]),
                              picture.at(points[k][0], points[k][1]), 1.2, kDark);
}

Picture paint(const Particles<2>& particles, const Scene& scene, const Colouring& colour,
              const Framing& framing, PictureFormat format, const Polylines& lines) {
  const auto [x, y] = frame_of<2>(framing, scene);
  const std::array<Range, 2> frame{x, y};
  Picture picture(x, y, colour.labels, format);
  std::vector<std::uint32_t> order = order_by_id(particles);
  double beyond = 0;
  if (format != PictureFormat::png) {
    // Viewers smooth each shape by itself: between neighbours that only meet the page would show.
    beyond = 0.4 / picture.pixels_per_metre();
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return colour(a) < colour(b); });
  }
  for (const std::uint32_t p : order) {
    if (!is_within(frame, particles.vector(Quantity::position, p))) continue;
    Corners corners = shape_of(particles, scene, p, beyond);
    for (auto& corner : corners) corner = picture.at(corner.x, corner.y);
    picture.canvas().fill_convex(corners, colour(p));
  }
  draw_lines(picture, lines, frame);
  picture.draw_axes();
  return picture;
}

/// A disc of the particle's present volume with a dark rim, so that a surface of them shows its relief.
void draw_ball(Picture& picture, PixelPoint centre, double radius, Colour colour) {
  const auto darker = [](std::uint8_t c) { return static_cast<std::uint8_t>(c * 7 / 10); };
  const Colour rim{darker(colour.red), darker(colour.green), darker(colour.blue)};
  picture.canvas().fill_disc(centre, radius, rim);
  picture.canvas().fill_disc({centre.x - 0.08 * radius, centre.y - 0.08 * radius}, 0.84 * radius, colour);
}

Picture paint(const Particles<3>& particles, const Scene& scene, const Colouring& colour,
              const Framing& framing, PictureFormat format, const Polylines&) {
  const std::array<Range, 3> frame = frame_of<3>(framing, scene);
  const ViewBox view(frame, colour.labels.length);
  Picture picture(view.across(), view.up(), colour.labels, format);
  view.draw_edges(picture);
  struct Ball {
    double depth;  ///< towards the eye
    std::uint32_t particle;
    float x, y, radius;  ///< pixels
    PixelPoint centre() const { return {x, y}; }
  };
  std::vector<Ball> balls;
  balls.reserve(particles.size());
  for (const std::uint32_t p : order_by_id(particles)) {
    const Vec<3> x = particles.vector(Quantity::position, p), view_of = to_view(x);
    const double radius = 1.15 * picture.pixels_per_metre() * drawn_radius(particles, scene, p);
    if (!is_within(frame, x) || !std::isfinite(radius)) continue;
    const PixelPoint at = picture.at(view_of[0], view_of[1]);
    balls.push_back(
        {view_of[2], p, static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(radius)});
  }
  std::stable_sort(balls.begin(), balls.end(),
                   [](const Ball& a, const Ball& b) { return a.depth < b.depth; });
  Cover cover(picture.canvas().width(), picture.canvas().height());
  std::vector<Ball> shown;  // most balls of a body are inside it
  std::for_each(balls.rbegin(), balls.rend(), [&](const Ball& ball) {
    if (cover.add(ball.centre(), ball.radius)) shown.push_back(ball);
  });
  std::for_each(shown.rbegin(), shown.rend(), [&](const Ball& ball) {
    draw_ball(picture, ball.centre(), ball.radius, colour(ball.particle));
  });
  view.draw_labels(picture);
  picture.draw_frame();
  return picture;
}

}  // namespace

std::string beyond_text(const FieldValues& field, const Range& colours) {
  Extent all;
  for (const double value : field.value) all.include(value);
  const double margin = 0.005 * colours.width();
  const bool below = all.lower < colours.lower - margin;
  const bool above = all.upper > colours.upper + margin;
  const std::string least = value_text(all.lower, field.unit), most = value_text(all.upper, field.unit);
  if (below && above) return fmt::format("values from {} to {}", least, most);
  if (below) return fmt::format("values down to {}", least);
  return above ? fmt::format("values up to {}", most) : "";
}

DisplayUnit length_unit(const Scene& scene) {
  const auto& size = scene.grid.size;
  return display_unit(0.5 * *std::max_element(size.begin(), size.begin() + scene.dimension()), "m");
}

void Framing::include(const Framing& other) {
  const auto widen = [](std::optional<Range>& own, const std::optional<Range>& theirs) {
    if (!theirs) return;
    own = own ? Range{std::min(own->lower, theirs->lower), std::max(own->upper, theirs->upper)} : *theirs;
  };
  for (std::size_t d = 0; d < 3; ++d) widen(box[d], other.box[d]);
  widen(values, other.values);
}

template <int Dim>
Framing framing_of(const Particles<Dim>& particles, const Scene& scene, const std::string& field) {
  const FieldValues values = field_values(particles, scene, field);
  Framing framing;
  const auto extents = extents_of(particles, scene);
  for (std::size_t d = 0; d < 3; ++d) framing.box[d] = extents[d].range();
  if (!values.names) framing.values = robust_range(values.value);
  return framing;
}

template <int Dim>
Canvas paint_particles(const Particles<Dim>& particles, const Scene& scene, const std::string& field,
                       double time, const Framing& framing, PictureFormat format, const Polylines& lines) {
  const FieldValues values = field_values(particles, scene, field);
  const Colouring colour(values, framing, scene);
  Picture picture = paint(particles, scene, colour, framing, format, lines);
  PictureText text = picture_text(scene, values.label, time);
  if (colour.has_bar()) {
    picture.draw_colour_bar(colour.scale);
    text.note = beyond_text(values, *framing.values);
  } else if (!colour.by_body && framing.values)
    text.subtitle += everywhere_text(value_text(framing.values->lower, values.unit));
  picture.write_titles(text);
  return std::move(picture.canvas());  // of the size of many pictures: no copy
}

template <int Dim>
void draw_particles(const std::filesystem::path& png, const Particles<Dim>& particles, const Scene& scene,
                    const std::string& field, double time, const Polylines& lines) {
  paint_particles(particles, scene, field, time, framing_of(particles, scene, field), PictureFormat::png,
                  lines)
      .write(png);
}

template Framing framing_of(const Particles<2>&, const Scene&, const std::string&);
template Canvas paint_particles(const Particles<2>&, const Scene&, const std::string&, double, const Framing&,
                                PictureFormat, const Polylines&);
template void draw_particles(const std::filesystem::path&, const Particles<2>&, const Scene&,
                             const std::string&, double, const Polylines&);
template Framing framing_of(const Particles<3>&, const Scene&, const std::string&);
template Canvas paint_particles(const Particles<3>&, const Scene&, const std::string&, double, const Framing&,
                                PictureFormat, const Polylines&);
template void draw_particles(const std::filesystem::path&, const Particles<3>&, const Scene&,
                             const std::string&, double, const Polylines&);

}  // namespace mpmfast
