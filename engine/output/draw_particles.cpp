#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/output/cover.hpp"
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

/// The longest subtitle with a note that pictures of the field can have: as many digits as there may be.
std::string longest_subtitle(const FieldValues& field) {
  const std::string value = "-8.888 M" + field.unit;
  return fmt::format("{} at 888.8 ms, values from {} to {}", field.label, value, value);
}

std::string value_text(double value, const std::string& si_unit) {
  const DisplayUnit unit = display_unit(std::abs(value), si_unit);
  return fmt::format("{:.4g} {}", value / unit.in_si + 0.0, unit.name);  // no -0
}

/// The colour of every particle, and the bar that explains it.
struct Colouring {
  Colouring(const FieldValues& field, const Framing& framing)
      : by_body(field.names),
        scale(framing.values.value_or(Range{})),
        value(&field.value),
        longest(has_bar() ? longest_subtitle(field) : "") {}
  Colour operator()(std::size_t p) const {
    return by_body ? body_colour(static_cast<std::size_t>((*value)[p])) : scale((*value)[p]);
  }
  bool has_bar() const { return !by_body && !scale.has_one_value(); }
  bool by_body;
  ColourScale scale;
  const std::vector<double>* value;
  std::string longest;
};

/// Columns j: half-edge vectors of a particle's domain, m.
template <int Dim>
Mat<Dim> half_edges(const Particles<Dim>& particles, const Scene& scene, std::size_t p) {
  Mat<Dim> edges = Mat<Dim>::Identity();
  if (particles.has(Quantity::domain_edges)) {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) edges(i, j) = particles.column(Quantity::domain_edges, Dim * i + j)[p];
    return edges;
  }
  if (particles.has(Quantity::deformation_gradient)) edges = particles.deformation_gradient(p);
  // The particle does not know its undeformed shape: its share of a cell, or of the width of a ring.
  double volume =
      particles.has(Quantity::initial_volume) ? particles.column(Quantity::initial_volume)[p] : 0.0;
  if (scene.space == Space::axisymmetric)  // of a ring, to the square that is turned
    volume *= particles.column(Quantity::out_of_plane_stretch)[p] /
              (kFullTurn * particles.column(Quantity::position, 0)[p]);
  const double size = 0.5 * (Dim == 2 ? std::sqrt(volume / scene.thickness) : std::cbrt(volume));
  const auto& per_cell = scene.bodies[particles.body()[p]].particles_per_cell;
  double mean = 1;
  for (std::size_t d = 0; d < Dim; ++d) mean *= per_cell[d];
  mean = Dim == 2 ? std::sqrt(mean) : std::cbrt(mean);
  double share = 1;
  for (int d = 0; d < Dim; ++d) share *= particles.domain_share(p, d);
  const double whole = size / (Dim == 2 ? std::sqrt(share) : std::cbrt(share));
  for (int d = 0; d < Dim; ++d)
    edges.col(d) *= whole * particles.domain_share(p, d) * mean / per_cell[static_cast<std::size_t>(d)];
  return edges;
}

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
  Mat<2> edges = half_edges(particles, scene, p);
  for (int d = 0; d < 2; ++d) edges.col(d) *= 1 + beyond / edges.col(d).norm();
  return parallelogram(particles.vector(Quantity::position, p), edges);
}

std::array<Extent, 3> extents_of(const Particles<2>& particles, const Scene& scene) {
  std::array<Extent, 3> box;
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (const auto& corner : shape_of(particles, scene, p)) {
      box[0].include(corner.x);
      box[1].include(corner.y);
    }
  return box;
}

/// Of a ball with the particle's volume, m.
double radius_of(const Particles<3>& particles, const Scene& scene, std::size_t p) {
  return std::cbrt(std::abs(half_edges(particles, scene, p).determinant()));
}

std::array<Extent, 3> extents_of(const Particles<3>& particles, const Scene& scene) {
  std::array<Extent, 3> box;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec<3> centre = particles.vector(Quantity::position, p);
    const double radius = radius_of(particles, scene, p);
    if (!centre.allFinite() || !std::isfinite(radius)) continue;
    for (int d = 0; d < 3; ++d)
      for (double side : {-radius, radius}) box[static_cast<std::size_t>(d)].include(centre[d] + side);
  }
  return box;
}

/// Within a box.
void draw_lines(Picture& picture, const Polylines& lines, const Range& x, const Range& y) {
  constexpr Colour kDark{20, 20, 20};
  const auto holds = [&](const Vec<2>& at) {
    return at[0] >= x.lower && at[0] <= x.upper && at[1] >= y.lower && at[1] <= y.upper;
  };
  for (const auto& points : lines)
    for (std::size_t k = 1; k < points.size(); ++k)
      if (holds(points[k - 1]) && holds(points[k]))
        picture.canvas().line(picture.at(points[k - 1][0], points[k - 1][1]),
                              picture.at(points[k][0], points[k][1]), 1.2, kDark);
}

Picture paint(const Particles<2>& particles, const Scene& scene, const Colouring& colour,
              const Framing& framing, PictureFormat format, const Polylines& lines) {
  const Range x = box_range(framing, scene, 0), y = box_range(framing, scene, 1);
  const double margin = 0.02 * std::max(x.width(), y.width());
  const auto wider = [&](Range r) { return Range{r.lower - margin, r.upper + margin}; };
  Picture picture(wider(x), wider(y), colour.has_bar(), colour.longest, format);
  std::vector<std::uint32_t> order = order_by_id(particles);
  double beyond = 0;
  if (format != PictureFormat::png) {
    // Viewers smooth each shape by itself: between neighbours that only meet the page would show.
    beyond = 0.4 / picture.pixels_per_metre();
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return colour(a) < colour(b); });
  }
  for (const std::uint32_t p : order) {
    Corners corners = shape_of(particles, scene, p, beyond);
    for (auto& corner : corners) corner = picture.at(corner.x, corner.y);
    picture.canvas().fill_convex(corners, colour(p));
  }
  draw_lines(picture, lines, wider(x), wider(y));
  picture.draw_axes(length_unit(scene), scene.space == Space::axisymmetric ? "rz" : "xy");
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
  const Range x = box_range(framing, scene, 0), y = box_range(framing, scene, 1),
              z = box_range(framing, scene, 2);
  const ViewBox view({x.lower, y.lower, z.lower}, {x.upper, y.upper, z.upper});
  Picture picture(view.across(), view.up(), colour.has_bar(), colour.longest, format);
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
    const Vec<3> view_of = to_view(particles.vector(Quantity::position, p));
    const double radius = 1.15 * picture.pixels_per_metre() * radius_of(particles, scene, p);
    if (!view_of.allFinite() || !std::isfinite(radius)) continue;
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
  view.draw_labels(picture, length_unit(scene));
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
  const Colouring colour(values, framing);
  Picture picture = paint(particles, scene, colour, framing, format, lines);
  PictureText text = picture_text(scene, values.label, time);
  if (colour.has_bar()) {
    picture.draw_colour_bar(colour.scale, values.unit);
    text.note = beyond_text(values, *framing.values);
  } else if (!colour.by_body && framing.values)
    text.subtitle += fmt::format(": {} everywhere", value_text(framing.values->lower, values.unit));
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
