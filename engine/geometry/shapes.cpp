#include "engine/geometry/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/geometry/polygon.hpp"
#include "engine/geometry/surface.hpp"

namespace mpmfast {

namespace {

/// Of a point on a surface: does a step of (ε, ε², ε³) lead inside? So exactly one of two touching shapes
/// holds it.
bool on_lower_side(const Vec3& outward) {
  for (const double component : outward) {
    if (component != 0) return component < 0;
  }
  return false;
}

/// A shape without thickness is 2-D: it holds every z.
bool within_z(double lower, double upper, double z) { return lower == upper || (z >= lower && z < upper); }

bool inside(const BoxShape& box, const Vec3& point) {
  return point[0] >= box.lower[0] && point[0] < box.upper[0] && point[1] >= box.lower[1] &&
         point[1] < box.upper[1] && within_z(box.lower[2], box.upper[2], point[2]);
}

bool inside(const EllipsoidShape& shape, const Vec3& point) {
  const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
  const double x = point[0] - shape.centre[0], y = point[1] - shape.centre[1];
  const double u = (cosine * x + sine * y) / shape.radii[0];
  const double v = (cosine * y - sine * x) / shape.radii[1];
  const double w = shape.radii[2] > 0 ? (point[2] - shape.centre[2]) / shape.radii[2] : 0;
  const double level = u * u + v * v + w * w;
  if (level != 1) return level < 1;
  const double gu = u / shape.radii[0], gv = v / shape.radii[1];
  return on_lower_side({cosine * gu - sine * gv, sine * gu + cosine * gv, w});
}

bool inside(const RingShape& ring, const Vec3& point) {
  const auto within = [&](double radius) {
    return radius > 0 && inside(EllipsoidShape{ring.centre, {radius, radius, 0}, 0}, point);
  };
  return within_z(ring.centre[2] - ring.half_length, ring.centre[2] + ring.half_length, point[2]) &&
         within(ring.outer) && !within(ring.inner);
}

bool inside(const PolygonShape& shape, const Vec3& point) {
  return within_z(shape.z_lower, shape.z_upper, point[2]) &&
         polygon_contains(shape.points, point[0], point[1]);
}

/// The pixel that holds the point; row 0 is the top one.
bool inside(const BitmapShape& shape, const Vec3& point) {
  if (!shape.image || shape.image->width <= 0 || shape.image->height <= 0) return false;
  if (!(point[0] >= shape.lower[0] && point[0] < shape.upper[0])) return false;
  if (!(point[1] >= shape.lower[1] && point[1] < shape.upper[1])) return false;
  const GreyImage& image = *shape.image;
  const auto pixel_at = [&](std::size_t k, int count) {
    const double share = (point[k] - shape.lower[k]) / (shape.upper[k] - shape.lower[k]);
    return std::min(static_cast<int>(share * count), count - 1);
  };
  const int column = pixel_at(0, image.width);
  const int row = image.height - 1 - pixel_at(1, image.height);
  const auto index = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(column);
  return image.pixel[index] == shape.grey;
}

bool inside(const StlShape& shape, const Vec3& point) {
  std::vector<Crossing> crossings;
  shape.surface->crossings(point[1], point[2], crossings);
  return wound_round(crossings, point[0]);
}

Bounds extent(const BoxShape& box) { return {box.lower, box.upper}; }

Bounds extent(const EllipsoidShape& shape) {
  const double cosine = std::cos(shape.angle), sine = std::sin(shape.angle);
  const Vec3 half{std::hypot(shape.radii[0] * cosine, shape.radii[1] * sine),
                  std::hypot(shape.radii[0] * sine, shape.radii[1] * cosine), shape.radii[2]};
  Bounds out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lower[k] = shape.centre[k] - half[k];
    out.upper[k] = shape.centre[k] + half[k];
  }
  return out;
}

Bounds extent(const RingShape& ring) {
  return extent(EllipsoidShape{ring.centre, {ring.outer, ring.outer, ring.half_length}, 0});
}

Bounds extent(const PolygonShape& shape) {
  Bounds out;
  if (shape.points.empty()) return out;
  out.lower = {shape.points[0][0], shape.points[0][1], shape.z_lower};
  out.upper = {shape.points[0][0], shape.points[0][1], shape.z_upper};
  for (const auto& point : shape.points) {
    for (std::size_t k = 0; k < 2; ++k) {
      out.lower[k] = std::min(out.lower[k], point[k]);
      out.upper[k] = std::max(out.upper[k], point[k]);
    }
  }
  return out;
}

/// Of the pixels of the grey level alone: twenty bodies of one image then cost one image, not twenty.
Bounds extent(const BitmapShape& shape) {
  if (!shape.image || shape.image->pixel.empty()) return {shape.lower, shape.upper};
  const GreyImage& image = *shape.image;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::size_t left = width, right = 0, top = height, bottom = 0;  // right, bottom: one past the last
  for (std::size_t row = 0; row < height; ++row) {
    const unsigned char* const line = image.pixel.data() + row * width;
    const void* const hit = std::memchr(line, shape.grey, width);
    if (!hit) continue;
    std::size_t last = width;
    while (line[last - 1] != shape.grey) --last;
    left = std::min(left, static_cast<std::size_t>(static_cast<const unsigned char*>(hit) - line));
    right = std::max(right, last);
    top = std::min(top, row);
    bottom = row + 1;
  }
  if (right == 0) return {shape.lower, shape.lower};
  const double pixel_x = (shape.upper[0] - shape.lower[0]) / image.width;
  const double pixel_y = (shape.upper[1] - shape.lower[1]) / image.height;
  Bounds out{shape.lower, shape.upper};
  out.lower[0] = shape.lower[0] + pixel_x * static_cast<double>(left);
  out.upper[0] = right == width ? shape.upper[0] : shape.lower[0] + pixel_x * static_cast<double>(right);
  out.lower[1] = shape.lower[1] + pixel_y * static_cast<double>(height - bottom);
  out.upper[1] = top == 0 ? shape.upper[1] : shape.lower[1] + pixel_y * static_cast<double>(height - top);
  return out;
}

Bounds extent(const StlShape& shape) { return shape.surface->bounds(); }

}  // namespace

std::optional<Vec3> unit_vector(const Vec3& vector) {
  const double longest = std::max({std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2])});
  if (longest == 0) return std::nullopt;
  Vec3 scaled = vector;
  if (longest < 1e-100 || longest > 1e100) {
    for (double& component : scaled) component /= longest;  // its square would under- or overflow
  }
  const double square = scaled[0] * scaled[0] + scaled[1] * scaled[1] + scaled[2] * scaled[2];
  constexpr double kRoundOff = 4e-15;
  if (std::abs(square - 1) > kRoundOff) {
    for (double& component : scaled) component /= std::sqrt(square);
  }
  return scaled;
}

std::array<bool, 256> GreyImage::levels() const {
  std::array<bool, 256> present{};
  for (const unsigned char grey : pixel) present[grey] = true;
  return present;
}

bool contains(const Shape& shape, const Vec3& point) {
  return std::visit([&](const auto& known) { return inside(known, point); }, shape);
}

Bounds bounds(const Shape& shape) {
  return std::visit([](const auto& known) { return extent(known); }, shape);
}

}  // namespace mpmfast
