#include "tools/pack_ellipses/packing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace mpmfast {
namespace {

constexpr double kClearance = 0.2;                     // pixels between any two grains
constexpr double kLeastRadius = 10, kMostRadius = 30;  // of the circle of equal area, at 280 × 560 pixels
constexpr double kLeastMinor = 5.5;
constexpr double kSown = 0.7;  // of its planned radius: as dense as random places allow
constexpr double kMostAspect = 2.5;

/// Ellipses in a box under trial moves: each is kept only if it makes no overlap.
class Box {
 public:
  Box(const PackingOptions& options)
      : width_(options.width),
        height_(options.height),
        unit_(std::sqrt(width_ * height_ / (280.0 * 560.0))),
        random_(options.seed) {}

  /// Places grains smaller than they will be, the largest first.
  void sow(double fraction) {
    std::vector<double> radius;
    double covered = 0;
    while (covered < fraction * width_ * height_) {
      // 1 / r uniform: more small grains than large.
      const double least = kLeastRadius / kSown, u = random_.uniform();
      radius.push_back(unit_ * least / (1 - u * (1 - least / kMostRadius)));
      covered += kPi * radius.back() * radius.back();
    }
    std::sort(radius.rbegin(), radius.rend());
    for (double r : radius) sow_one(kSown * r);
  }

  /// One trial for each grain: shift, turn and reshape at once. A loss of area up to `loss` may be accepted.
  void sweep(double stride, double loss) {
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      const Ellipse trial = changed(grains_[i], stride);
      const double u = random_.uniform(), gain = trial.area() - grains_[i].area();
      if (gain >= -loss * u * u * u && allowed(trial, i)) {
        grains_[i] = trial;
        area_ += gain;
      }
    }
  }

  double fraction() const { return area_ / (width_ * height_); }
  double unit() const { return unit_; }
  const std::vector<Ellipse>& grains() const { return grains_; }

 private:
  bool in_size(const Ellipse& e) const {
    const double least = unit_ * kLeastRadius, most = unit_ * kMostRadius, square = e.major * e.minor;
    return e.minor >= unit_ * kLeastMinor && e.major <= kMostAspect * e.minor && square >= least * least &&
           square <= most * most;
  }

  void sow_one(double radius) {
    for (int attempt = 0; attempt < 20000; ++attempt) {
      const double root = std::sqrt(random_.between(1, 2));
      // One draw after the other: a compiler takes the arguments of a call in an order of its own.
      const bool across = random_.uniform() < 0.5;
      const double turn = random_.between(-1, 1), x = random_.uniform() * width_,
                   y = random_.uniform() * height_;
      const Ellipse e = turned({x, y, radius * root, radius / root, 1, 0}, turn, across);
      if (!allowed(e, grains_.size())) continue;
      grains_.push_back(e);
      area_ += e.area();
      return;
    }
  }

  /// Turned by 2 atan t, and by a right angle more.
  static Ellipse turned(Ellipse e, double t, bool quarter) {
    const double c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
    const double cosine = e.cosine * c - e.sine * s, sine = e.sine * c + e.cosine * s;
    const double length = std::sqrt(cosine * cosine + sine * sine);  // rounding must not add up
    e.cosine = (quarter ? -sine : cosine) / length;
    e.sine = (quarter ? cosine : sine) / length;
    return e;
  }

  Ellipse changed(const Ellipse& old, double stride) {
    Ellipse e = turned(old, random_.between(-0.5, 0.5) * stride / old.major, false);
    e.x += random_.between(-stride, stride);
    e.y += random_.between(-stride, stride);
    e.major += random_.between(-0.7, 1) * stride;
    e.minor += random_.between(-0.7, 1) * stride;
    if (e.minor > e.major) {
      std::swap(e.major, e.minor);
      e = turned(e, 0, true);
    }
    return e;
  }

  bool allowed(const Ellipse& e, std::size_t self) const {
    if (!in_size(e)) return false;
    const double wx = e.half_width(), wy = e.half_height();
    if (e.x < wx || e.x > width_ - wx || e.y < wy || e.y > height_ - wy) return false;
    const Ellipse wide = e.grown(0.5 * kClearance);
    for (std::size_t j = 0; j < grains_.size(); ++j) {
      const Ellipse& other = grains_[j];
      const double dx = other.x - e.x, dy = other.y - e.y, reach = e.major + other.major + kClearance;
      if (j == self || dx * dx + dy * dy > reach * reach) continue;
      if (!disjoint(wide, other.grown(0.5 * kClearance))) return false;
    }
    return true;
  }

  double width_, height_, unit_, area_ = 0;
  Random random_;
  std::vector<Ellipse> grains_;
};

}  // namespace

Packing pack(const PackingOptions& options) {
  Box box(options);
  box.sow(options.fraction);
  // Annealing: losses of area let grains make way for each other, less and less so.
  constexpr int kSweeps = 200000;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const double left = 1 - static_cast<double>(sweep) / kSweeps;
    box.sweep(box.unit() * (0.05 + 0.6 * left * left), box.unit() * box.unit() * 20 * left * left);
    if (box.fraction() >= options.fraction) break;
  }
  if (box.fraction() < options.fraction)
    throw std::runtime_error("grains cover " + std::to_string(box.fraction()) +
                             " of the box only; try another seed");
  return {options, box.grains(), choose_greys(box.grains(), options.seed)};
}

std::vector<unsigned char> paint(const Packing& packing) {
  const int width = packing.options.width, height = packing.options.height;
  std::vector<unsigned char> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                                    kVoid);
  for (std::size_t g = 0; g < packing.grains.size(); ++g) {
    const Ellipse& e = packing.grains[g];
    const int left = std::max(0, static_cast<int>(e.x - e.half_width()));
    const int right = std::min(width - 1, static_cast<int>(e.x + e.half_width()));
    const int low = std::max(0, static_cast<int>(e.y - e.half_height()));
    const int high = std::min(height - 1, static_cast<int>(e.y + e.half_height()));
    for (int row = low; row <= high; ++row)
      for (int column = left; column <= right; ++column) {
        if (!e.contains(column + 0.5, row + 0.5)) continue;
        unsigned char& pixel = pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                      static_cast<std::size_t>(column)];
        if (pixel != kVoid) throw std::logic_error("two grains claim one pixel");
        pixel = static_cast<unsigned char>(packing.grey[g] * kGreyStep);
      }
  }
  return pixels;
}

double area_fraction(const std::vector<unsigned char>& pixels) {
  const auto empty = std::count(pixels.begin(), pixels.end(), kVoid);
  return 1 - static_cast<double>(empty) / static_cast<double>(pixels.size());
}

}  // namespace mpmfast
