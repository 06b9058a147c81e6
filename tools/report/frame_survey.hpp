#pragma once

/// @file A first look at the frames of a run: which can be read, who is in them, and the range of every
/// field.

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/drawn.hpp"
#include "engine/output/lines.hpp"
#include "engine/output/read_vtu.hpp"
#include "frame_fields.hpp"

namespace mpmfast {

/// The finite values of one column in all frames.
struct ValueRange {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  std::vector<double> sample;  ///< some of them
  bool empty() const { return !(lower <= upper); }
  /// @param stride  every so many are kept as the sample
  void include(const std::vector<double>& values, std::size_t stride);
};

struct FrameSurvey {
  std::vector<SeriesFrame> frames;  ///< that are shown
  std::vector<std::uint32_t> ids;   ///< of all particles that are ever shown, ascending
  std::vector<FrameField> fields;
  std::vector<ValueRange> extents;     ///< of the fields
  std::array<ValueRange, 3> box;       ///< m, of the centres of particles that are shown
  std::optional<Viewed> viewed;        ///< nothing: all of space is shown
  std::array<ValueRange, 4> gradient;  ///< F in the plane: xx xy yx yy
  std::vector<Polylines> cracks;       ///< of each of the frames
  std::size_t particle_stride = 1;
};

/// Of every `particle_stride`-th particle by its id. A frame that cannot be read is left out and named in
/// `notices`.
/// @param viewed  particles beyond it have no place on the page
FrameSurvey survey_frames(const std::vector<SeriesFrame>& frames, std::size_t particle_stride, int dimension,
                          const std::string& picture, const std::set<std::uint32_t>& rigid,
                          const std::optional<Viewed>& viewed, std::vector<std::string>& notices);

/// The places of a file's particles, three numbers each; NaN where a particle is not shown.
std::vector<double> shown_points(const VtuReader& file, const std::optional<Viewed>& viewed);

/// Where the particles of a file that are shown lie: in the file, and in the survey's ids.
struct PointOrder {
  std::vector<std::size_t> in_file, in_page;
};
PointOrder find_point_order(const VtuReader& file, const FrameSurvey& survey);

/// F in the plane, an entry each: xx xy yx yy; NaN without one.
std::array<FrameField, 4> gradient_fields();

}  // namespace mpmfast
