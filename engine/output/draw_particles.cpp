#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/output/output.hpp"
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
  bool empty() const { return !(lower < upper); }
  Range with_margin(double margin) const { return {lower - margin, upper + margin}; }
};

PictureText picture_text(const Scene& scene, const std::string& label, double time) {
  const DisplayUnit unit = display_unit(std::abs(time), "s");
  return {scene.title, fmt::format("{} at {:.4g} {}", label, time / unit.in_si, time == 0 ? "s" : unit.name)};
}

/// The colour of every particle, and the bar that explains it.
struct Colouring {
  explicit Colouring(const FieldValues& field)
      : by_body(field.unit.empty()), scale(robust_range(field.value)), value(&field.value) {}
  Colour operator()(std::size_t p) const {
    return by_body ? body_colour(static_cast<std::size_t>((*value)[p])) : scale((*value)[p]);
  }
  bool by_body;
  ColourScale scale;
  const std::vector<double>* value;
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
  // The particle does not know its undeformed shape: nearly always it is a square or a cube.
  double volume =
      particles.has(Quantity::initial_volume) ? particles.column(Quantity::initial_volume)[p] : 0.0;
  if (scene.space == Space::axisymmetric)  // of a ring, to the square that is turned
    volume *= particles.column(Quantity::out_of_plane_stretch)[p] /
              (kFullTurn * particles.column(Quantity::position, 0)[p]);
  return edges * (0.5 * (Dim == 2 ? std::sqrt(volume / scene.thickness) : std::cbrt(volume)));
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

void draw(const std::filesystem::path& png, const Particles<2>& particles, const Scene& scene,
          const FieldValues& field, double time) {
  const auto shape = [&](std::size_t p) {
    return parallelogram(particles.vector(Quantity::position, p), half_edges(particles, scene, p));
  };
  Extent x, y;
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (const auto& corner : shape(p)) {
      x.include(corner.x);
      y.include(corner.y);
    }
  if (x.empty() || y.empty()) {
    x = {scene.grid.origin[0], scene.grid.origin[0] + std::max(scene.grid.size[0], 1e-9)};
    y = {scene.grid.origin[1], scene.grid.origin[1] + std::max(scene.grid.size[1], 1e-9)};
  }
  const double margin = 0.02 * std::max(x.upper - x.lower, y.upper - y.lower);
  const Colouring colour(field);
  Picture picture(x.with_margin(margin), y.with_margin(margin), !colour.by_body);
  for (const std::uint32_t p : order_by_id(particles)) {
    Corners corners = shape(p);
    for (auto& corner : corners) corner = picture.at(corner.x, corner.y);
    picture.canvas().fill_convex(corners, colour(p));
  }
  picture.write_titles(picture_text(scene, field.label, time));
  picture.draw_axes();
  if (!colour.by_body) picture.draw_colour_bar(colour.scale, field.unit);
  picture.canvas().write_png(png);
}

/// A disc of the particle's present volume with a dark rim, so that a surface of them shows its relief.
void draw_ball(Picture& picture, PixelPoint centre, double radius, Colour colour) {
  const auto darker = [](std::uint8_t c) { return static_cast<std::uint8_t>(c * 7 / 10); };
  const Colour rim{darker(colour.red), darker(colour.green), darker(colour.blue)};
  picture.canvas().fill_disc(centre, radius, rim);
  picture.canvas().fill_disc({centre.x - 0.08 * radius, centre.y - 0.08 * radius}, 0.84 * radius, colour);
}

void draw(const std::filesystem::path& png, const Particles<3>& particles, const Scene& scene,
          const FieldValues& field, double time) {
  struct Ball {
    Vec<3> view;  ///< right, up, towards the eye
    double radius;
    std::uint32_t particle;
  };
  std::vector<Ball> balls;
  std::array<Extent, 3> box;
  for (const std::uint32_t p : order_by_id(particles)) {
    const Vec<3> centre = particles.vector(Quantity::position, p);
    const double radius = std::cbrt(std::abs(half_edges(particles, scene, p).determinant()));
    if (!centre.allFinite() || !std::isfinite(radius)) continue;
    balls.push_back({to_view(centre), 1.15 * radius, p});
    for (int d = 0; d < 3; ++d)
      for (double side : {-radius, radius}) box[static_cast<std::size_t>(d)].include(centre[d] + side);
  }
  for (std::size_t d = 0; d < 3; ++d)
    if (box[d].empty())
      box[d] = {scene.grid.origin[d], scene.grid.origin[d] + std::max(scene.grid.size[d], 1e-9)};
  const ViewBox view({box[0].lower, box[1].lower, box[2].lower}, {box[0].upper, box[1].upper, box[2].upper});
  const Colouring colour(field);
  Picture picture(view.across(), view.up(), !colour.by_body);
  view.draw_edges(picture);
  std::stable_sort(balls.begin(), balls.end(),
                   [](const Ball& a, const Ball& b) { return a.view[2] < b.view[2]; });
  for (const Ball& ball : balls)
    draw_ball(picture, picture.at(ball.view[0], ball.view[1]), ball.radius * picture.pixels_per_metre(),
              colour(ball.particle));
  view.draw_labels(picture);
  picture.write_titles(picture_text(scene, field.label, time));
  picture.draw_frame();
  if (!colour.by_body) picture.draw_colour_bar(colour.scale, field.unit);
  picture.canvas().write_png(png);
}

}  // namespace

template <int Dim>
void draw_particles(const std::filesystem::path& png, const Particles<Dim>& particles, const Scene& scene,
                    const std::string& field, double time) {
  draw(png, particles, scene, field_values(particles, field), time);
}

template void draw_particles(const std::filesystem::path&, const Particles<2>&, const Scene&,
                             const std::string&, double);
template void draw_particles(const std::filesystem::path&, const Particles<3>&, const Scene&,
                             const std::string&, double);

}  // namespace mpmfast
