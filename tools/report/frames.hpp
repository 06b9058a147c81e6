#pragma once

/// @file The particle files of a run, thinned and packed for a page.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.hpp"

namespace mpmfast {

/// The binary parts of a page, each of zlib's format; the rest of the page names them by their number.
class Chunks {
 public:
  std::size_t add(std::string packed) {
    chunks_.push_back(std::move(packed));
    return chunks_.size() - 1;
  }
  const std::vector<std::string>& all() const { return chunks_; }

 private:
  std::vector<std::string> chunks_;
};

/// What limits a page, in bytes of the packed columns.
struct FrameLimits {
  std::size_t bytes = 0;
  std::size_t values = 7'000'000;  ///< particles x frames: beyond, frames and then particles are left out
};

/// Reads the frames and describes them as the page expects it (page/frames.js); null where there are none,
/// with the reason in `notices`. A frame that cannot be read is left out, with a notice.
/// @param scene  for names and the shapes of particles; nothing where it could not be read
nlohmann::ordered_json pack_frames(const std::filesystem::path& folder, const std::optional<Scene>& scene,
                                   int dimension, const FrameLimits& limits, Chunks& chunks,
                                   std::vector<std::string>& notices);

}  // namespace mpmfast
