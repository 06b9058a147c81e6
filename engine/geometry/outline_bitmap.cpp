#include "engine/geometry/outline_bitmap.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace mpmfast {

namespace {

using Point = std::array<double, 2>;
using Loop = std::vector<Point>;

/// The level's share of the surrounding pixels, at pixel centres. A rim of zeros surrounds the picture.
class SmoothedShare {
 public:
  SmoothedShare(const GreyImage& image, int grey)
      : width_(image.width + 2 * kRim), height_(image.height + 2 * kRim), at_(width_ * height_, 0.0F) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        at(x + kRim, y + kRim) = image.pixel[static_cast<std::size_t>(image.height - 1 - y) *
                                                 static_cast<std::size_t>(image.width) +
                                             static_cast<std::size_t>(x)] == grey;
    for (int pass = 0; pass < kPasses; ++pass) {
      smooth(1, 0);
      smooth(0, 1);
    }
  }
  int width() const { return static_cast<int>(width_); }
  int height() const { return static_cast<int>(height_); }
  float operator()(int x, int y) const { return at_[index(x, y)]; }
  static constexpr int kPasses = 2;         ///< of smoothing: it reaches so many pixels
  static constexpr int kRim = kPasses + 1;  ///< pixels, of which the outermost stay zero

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x);
  }
  float& at(int x, int y) { return at_[index(x, y)]; }
  /// Weighted mean of three neighbours along a direction: ¼, ½, ¼.
  void smooth(int dx, int dy) {
    const std::vector<float> before = at_;
    for (int y = dy; y < height() - dy; ++y)
      for (int x = dx; x < width() - dx; ++x)
        at(x, y) = 0.25F * (before[index(x - dx, y - dy)] + before[index(x + dx, y + dy)]) +
                   0.5F * before[index(x, y)];
  }
  std::size_t width_, height_;
  std::vector<float> at_;
};

/// The line between two neighbouring pixels, from (x, y) to the right or upwards.
struct Edge {
  int x, y, up;
  auto operator<=>(const Edge&) const = default;
};

/// Where the share is one half along the edge, in pixels.
Point crossing(const SmoothedShare& share, const Edge& e) {
  const double a = share(e.x, e.y), b = share(e.x + 1 - e.up, e.y + e.up), t = (0.5 - a) / (b - a);
  return {e.x + (e.up ? 0 : t), e.y + (e.up ? t : 0)};
}

/// Successor of each edge that the line crosses, with the level on its left.
std::map<Edge, Edge> marching_squares(const SmoothedShare& share) {
  std::map<Edge, Edge> next;
  for (int y = 0; y + 1 < share.height(); ++y)
    for (int x = 0; x + 1 < share.width(); ++x) {
      const auto in = [&](int dx, int dy) { return share(x + dx, y + dy) > 0.5F; };
      // Corners and edges counter-clockwise from the lower left.
      const std::array<bool, 4> corner{in(0, 0), in(1, 0), in(1, 1), in(0, 1)};
      const std::array<Edge, 4> edge{Edge{x, y, 0}, Edge{x + 1, y, 1}, Edge{x, y + 1, 0}, Edge{x, y, 1}};
      const float mean = 0.25F * (share(x, y) + share(x + 1, y) + share(x + 1, y + 1) + share(x, y + 1));
      // The line enters a square over an edge that leads out of the level, and leaves it over the next edge
      // that leads into the level. At a saddle the mean decides whether the level is connected across the
      // square.
      for (std::size_t k = 0; k < 4; ++k) {
        if (!(corner[k] && !corner[(k + 1) % 4])) continue;  // edge k does not lead out of the level
        std::size_t leaves = k;
        const bool saddle = corner[(k + 2) % 4] && !corner[(k + 3) % 4];
        if (saddle && mean > 0.5F)
          leaves = (k + 1) % 4;
        else if (saddle)
          leaves = (k + 3) % 4;
        else
          while (!(!corner[leaves] && corner[(leaves + 1) % 4])) leaves = (leaves + 1) % 4;
        next[edge[k]] = edge[leaves];
      }
    }
  return next;
}

/// The same line with equidistant points.
Loop resample(const Loop& loop, double spacing) {
  std::vector<double> path{0};
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point &a = loop[k], &b = loop[(k + 1) % loop.size()];
    path.push_back(path.back() + std::hypot(b[0] - a[0], b[1] - a[1]));
  }
  const long count = std::lround(path.back() / spacing);
  Loop out;
  std::size_t at = 0;
  for (long k = 0; k < count; ++k) {
    const double wanted = path.back() * static_cast<double>(k) / static_cast<double>(count);
    while (path[at + 1] <= wanted) ++at;
    const Point &a = loop[at], &b = loop[(at + 1) % loop.size()];
    const double share = (wanted - path[at]) / (path[at + 1] - path[at]);
    out.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
  }
  return out;
}

}  // namespace

std::vector<Loop> bitmap_loops(const BitmapShape& shape, double spacing) {
  std::vector<Loop> loops;
  if (!shape.image || shape.image->width <= 0 || shape.image->height <= 0) return loops;
  constexpr std::size_t kLeastPoints = 4;  // smaller specks have no surface
  const SmoothedShare share(*shape.image, shape.grey);
  std::map<Edge, Edge> next = marching_squares(share);
  const double pixel_x = (shape.upper[0] - shape.lower[0]) / shape.image->width,
               pixel_y = (shape.upper[1] - shape.lower[1]) / shape.image->height;
  while (!next.empty()) {
    Loop loop;
    for (auto it = next.begin(); it != next.end();) {
      const Point p = crossing(share, it->first);
      loop.push_back({std::clamp(shape.lower[0] + (p[0] - SmoothedShare::kRim + 0.5) * pixel_x,
                                 shape.lower[0], shape.upper[0]),
                      std::clamp(shape.lower[1] + (p[1] - SmoothedShare::kRim + 0.5) * pixel_y,
                                 shape.lower[1], shape.upper[1])});
      const Edge on = it->second;
      next.erase(it);
      it = next.find(on);
    }
    loop = resample(loop, spacing);
    if (loop.size() >= kLeastPoints) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace mpmfast
