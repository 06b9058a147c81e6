#pragma once

/// @file The visible discs of a picture, given in order from the front to the back.

#include <cstdint>
#include <vector>

#include "engine/output/canvas.hpp"

namespace mpmfast {

/// The samples of a picture that discs cover.
class Cover {
 public:
  Cover(int width, int height);

  /// Covers what is under the disc. Returns whether some of it was free.
  bool add(PixelPoint centre, double radius);

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> covered_;
};

}  // namespace mpmfast
