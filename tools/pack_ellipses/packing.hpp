#pragma once

/// @file A box filled with ellipses of many sizes that do not overlap, as a picture with a grey for each
/// material: a scene like that of N20, Fig. 6. The same options give the same picture on every machine.

#include <cstdint>
#include <random>
#include <vector>

#include "tools/pack_ellipses/ellipse.hpp"

namespace mpmfast {

inline constexpr int kGreys = 20;     ///< materials
inline constexpr int kGreyStep = 12;  ///< their levels are 0, 12, …, 228
inline constexpr unsigned char kVoid = 255;

struct PackingOptions {
  std::uint64_t seed = 1;
  int width = 280, height = 560;  ///< pixels
  double fraction = 0.85;         ///< of the box that grains cover
};

struct Packing {
  PackingOptions options;
  std::vector<Ellipse> grains;  ///< pixels, wholly inside the box
  std::vector<int> grey;        ///< 0 … kGreys − 1 for each grain
};

/// Uniform numbers that are the same everywhere, which those of std::uniform_real_distribution need not be.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  ///< [0, 1)
  double between(double lower, double upper) { return lower + (upper - lower) * uniform(); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(uniform() * static_cast<double>(n)); }

 private:
  std::mt19937_64 engine_;
};

/// Throws std::runtime_error when the fraction is out of reach.
Packing pack(const PackingOptions& options);

/// Greys that keep grains of one grey as far apart as can be, each used by as many grains (± 1).
std::vector<int> choose_greys(const std::vector<Ellipse>& grains, std::uint64_t seed);

/// Gaps between all pairs, row by row; those beyond 200 pixels are lower bounds.
std::vector<double> all_gaps(const std::vector<Ellipse>& grains);

/// Grey levels of the pixels, row 0 at the top. Throws std::logic_error if two grains claim a pixel.
std::vector<unsigned char> paint(const Packing& packing);

/// The share of pixels that are not void.
double area_fraction(const std::vector<unsigned char>& pixels);

}  // namespace mpmfast
