#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tools/pack_ellipses/packing.hpp"

namespace mpmfast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFar = 200;  // pixels: beyond, a lower bound of the gap is as good

/// Greys under construction: −1 is none yet.
struct Greys {
  const std::vector<double>& gaps;
  std::vector<int> of;

  /// From a grain to the next one of that grey.
  double distance(std::size_t grain, int grey) const {
    double least = kInfinity;
    for (std::size_t j = 0; j < of.size(); ++j)
      if (j != grain && of[j] == grey) least = std::min(least, gaps[grain * of.size() + j]);
    return least;
  }
};

int best_grey(const Greys& greys, std::size_t grain, std::size_t most) {
  int best = -1;
  double best_distance = -1;
  for (int grey = 0; grey < kGreys; ++grey) {
    if (static_cast<std::size_t>(std::count(greys.of.begin(), greys.of.end(), grey)) >= most) continue;
    const double distance = greys.distance(grain, grey);
    if (distance > best_distance) {
      best = grey;
      best_distance = distance;
    }
  }
  return best;
}

/// Exchanges two grains' greys where that widens the lesser of their two distances.
void try_exchange(Greys& greys, std::size_t a, std::size_t b) {
  if (greys.of[a] == greys.of[b]) return;
  const auto least = [&] { return std::min(greys.distance(a, greys.of[a]), greys.distance(b, greys.of[b])); };
  const double before = least();
  std::swap(greys.of[a], greys.of[b]);
  if (least() <= before) std::swap(greys.of[a], greys.of[b]);
}

}  // namespace

std::vector<double> all_gaps(const std::vector<Ellipse>& grains) {
  const std::size_t n = grains.size();
  std::vector<double> gaps(n * n, kInfinity);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = grains[i].x - grains[j].x, dy = grains[i].y - grains[j].y;
      const double bound = std::sqrt(dx * dx + dy * dy) - grains[i].major - grains[j].major;
      gaps[i * n + j] = gaps[j * n + i] = bound > kFar ? bound : gap(grains[i], grains[j]);
    }
  return gaps;
}

std::vector<int> choose_greys(const std::vector<Ellipse>& grains, std::uint64_t seed) {
  const std::vector<double> gaps = all_gaps(grains);
  const std::size_t n = grains.size(), most = (n + kGreys - 1) / kGreys;
  Greys greys{gaps, std::vector<int>(n, -1)};
  for (std::size_t i = 0; i < n; ++i) greys.of[i] = best_grey(greys, i, most);
  Random random(seed);
  constexpr int kExchanges = 100000;
  for (int i = 0; i < kExchanges && n > 1; ++i) {
    const std::size_t a = random.below(n), b = random.below(n);
    try_exchange(greys, a, b);
  }
  return greys.of;
}

}  // namespace mpmfast
