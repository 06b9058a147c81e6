#pragma once

/// @file What does not change as a particle moves: whose it is, of what, and the sides of its undeformed
/// domain.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/scene.hpp"
#include "frame_survey.hpp"

namespace mpmfast {

struct FrameConstants {
  explicit FrameConstants(std::size_t count = 0)
      : body(count), material(count), side_x(count), side_y(count), known(count) {}
  std::vector<std::uint16_t> body, material;
  std::vector<float> side_x, side_y;  ///< m, of the undeformed domain; in 3-D of a cube, x alone
  std::vector<bool> known;
};

/// Notes the particles of a file that are not known yet.
void note_constants(const FrameFile& file, const PointOrder& point_order, const std::optional<Scene>& scene,
                    int dimension, FrameConstants& constants);

/// Their columns as the page names them, packed. Ids that count from 0 are left out.
std::vector<std::pair<std::string, std::string>> packed_constants(const FrameConstants& constants,
                                                                  const std::vector<std::uint32_t>& ids);

}  // namespace mpmfast
