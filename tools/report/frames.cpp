#include "frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/errors.hpp"
#include "engine/output/drawn.hpp"
#include "frame_constants.hpp"
#include "frame_survey.hpp"
#include "kernels/basis/domain_limit.hpp"
#include "kernels/basis/facts.hpp"
#include "pack.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kFineValues = 500'000;          // particles x frames up to which fields have 16 bits
constexpr std::size_t kCloseValues = 2'000'000;       // up to which places are kept to a hundredth of a pixel
constexpr double kCloseSteps = 1024, kFarSteps = 48;  // of places, a particle
constexpr std::size_t kKeptFields = 3;                // before fewer fields are shown, fewer frames are

/// One column of all frames on its way to the page.
struct FrameColumn {
  FrameField field;
  Levels levels;
  std::vector<std::uint16_t> values;
  Packed packed = {};
};

Levels levels_of(const ValueRange& extent, bool fine) {
  if (extent.empty()) return Levels::even(0, 1, 8);
  if (fine) return Levels::even(extent.lower, extent.upper, 16);
  return extent.sample.empty() ? Levels::even(extent.lower, extent.upper, 8)
                               : Levels::crowded(extent.sample, extent.lower, extent.upper);
}

/// Reads the frames that a survey chose and packs them.
class FramePacker {
 public:
  FramePacker(FrameSurvey survey, const std::optional<Scene>& scene, int dimension)
      : survey_(std::move(survey)),
        scene_(scene),
        dimension_(dimension),
        width_(survey_.ids.size()),
        constants_(width_) {
    const std::size_t values = width_ * survey_.frames.size();
    plan_columns(values <= kFineValues, values <= kCloseValues ? kCloseSteps : kFarSteps);
    for (std::size_t f = 0; f < survey_.frames.size(); ++f) read_frame(f);
    constant_columns_ = packed_constants(constants_, survey_.ids);
    for (auto* columns : {&positions_, &gradient_, &fields_})
      for (FrameColumn& column : *columns)
        column.packed = pack_levels(column.values, width_, column.levels.bits());
  }

  /// What a page needs at least.
  std::size_t least_bytes() const {
    std::size_t bytes = 0;
    for (const auto& column : constant_columns_) bytes += column.second.size();
    for (const FrameColumn& column : positions_) bytes += column.packed.bytes.size();
    for (std::size_t k = 0; k < std::min(kKeptFields, fields_.size()); ++k)
      bytes += fields_[k].packed.bytes.size();
    return bytes;
  }

  Json describe(std::size_t limit, Chunks& chunks, std::vector<std::string>& notices);

 private:
  void plan_columns(bool fine, double steps_per_particle);
  void read_frame(std::size_t frame);
  std::vector<FrameColumn*> all_columns() {
    std::vector<FrameColumn*> out;
    for (auto* columns : {&positions_, &gradient_, &fields_})
      for (FrameColumn& column : *columns) out.push_back(&column);
    return out;
  }
  Json describe(const FrameColumn& column, Chunks& chunks) const;
  Json describe_lines() const;

  FrameSurvey survey_;
  const std::optional<Scene>& scene_;
  int dimension_;
  std::size_t width_;  ///< particles that are ever shown
  FrameConstants constants_;
  std::vector<std::pair<std::string, std::string>> constant_columns_;  ///< name, packed
  std::vector<FrameColumn> positions_, gradient_, fields_;
};

void FramePacker::plan_columns(bool fine, double steps_per_particle) {
  const double dim = dimension_;
  double widest = 0, volume = 1;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
    const ValueRange& side = survey_.box[d];
    if (side.empty()) continue;
    widest = std::max(widest, side.upper - side.lower);
    if (side.upper > side.lower) volume *= side.upper - side.lower;
  }
  const double apart = std::pow(volume / static_cast<double>(std::max<std::size_t>(width_, 1)), 1 / dim);
  const double spacing = std::max({widest / 65000, apart / steps_per_particle, 1e-300});
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension_); ++d) {
    const double lower = survey_.box[d].empty() ? 0 : survey_.box[d].lower;
    positions_.push_back(
        {{axes[d], "m", "Points", d, FrameField::Kind::component}, Levels::spaced(lower, spacing, 16), {}});
  }
  if (dimension_ == 2)
    for (std::size_t k = 0; k < 4; ++k)
      gradient_.push_back({gradient_fields()[k], levels_of(survey_.gradient[k], false), {}});
  for (std::size_t k = 0; k < survey_.fields.size(); ++k)
    fields_.push_back({survey_.fields[k], levels_of(survey_.extents[k], fine), {}});
  for (FrameColumn* column : all_columns())
    column->values.assign(width_ * survey_.frames.size(), column->levels.none());
}

void FramePacker::read_frame(std::size_t frame) {
  const FrameFile file(survey_.frames[frame].file);
  const PointOrder point_order = find_point_order(file.reader(), survey_);
  note_constants(file, point_order, scene_, dimension_, constants_);
  const auto put = [&](FrameColumn& column, const auto& value) {
    for (std::size_t k = 0; k < point_order.in_file.size(); ++k)
      column.values[frame * width_ + point_order.in_page[k]] =
          column.levels.nearest(value(point_order.in_file[k]));
  };
  const std::vector<double> points = shown_points(file.reader(), survey_.viewed);
  for (FrameColumn& column : positions_)
    put(column, [&](std::size_t i) { return points[3 * i + column.field.component]; });
  for (auto* columns : {&gradient_, &fields_})
    for (FrameColumn& column : *columns) {
      const std::vector<double> values = column.field.values(file);
      put(column, [&](std::size_t i) { return values[i]; });
    }
}

/// The points without which a line is off by more than so much, m.
std::vector<Vec<2>> without_needless(const std::vector<Vec<2>>& line, double most) {
  std::vector<Vec<2>> out;
  for (std::size_t from = 0; from < line.size();) {
    out.push_back(line[from]);
    std::size_t to = from + 1;
    const auto reaches = [&](std::size_t end) {
      const Vec<2> way = line[end] - line[from];
      for (std::size_t k = from + 1; k < end; ++k) {
        const double share = std::clamp((line[k] - line[from]).dot(way) / way.squaredNorm(), 0.0, 1.0);
        if (!((line[from] + share * way - line[k]).norm() <= most)) return false;
      }
      return true;
    };
    while (to + 1 < line.size() && reaches(to + 1)) ++to;
    from = to;
  }
  return out;
}

/// Of each frame its cracks, each x and y of its points, in steps of the places.
Json FramePacker::describe_lines() const {
  constexpr double kMostSteps = 4000;  // across all frames: finer than a screen
  double widest = 0;
  for (const ValueRange& side : survey_.box)
    if (!side.empty()) widest = std::max(widest, side.upper - side.lower);
  Json frames = Json::array();
  for (const Polylines& lines : survey_.cracks) {
    Json all = Json::array();
    for (const auto& line : lines) {
      Json points = Json::array();
      for (const Vec<2>& x : without_needless(line, widest / kMostSteps))
        for (std::size_t d = 0; d < 2; ++d) {
          const Levels& levels = positions_[d].levels;
          points.push_back(std::llround((x[static_cast<int>(d)] - levels.lower()) / levels.spacing()));
        }
      all.push_back(std::move(points));
    }
    frames.push_back(std::move(all));
  }
  return frames;
}

Json FramePacker::describe(const FrameColumn& column, Chunks& chunks) const {
  const Levels& levels = column.levels;
  Json json{{"name", column.field.name},
            {"unit", column.field.unit},
            {"bits", levels.bits()},
            {"time_order", column.packed.time_order},
            {"space_order", column.packed.space_order},
            {"chunk", chunks.add(column.packed.bytes)}};
  if (levels.table().empty()) {
    json["lower"] = levels.lower();
    json["spacing"] = levels.spacing();
  } else {
    json["table"] = levels.table();
  }
  return json;
}

Json FramePacker::describe(std::size_t limit, Chunks& chunks, std::vector<std::string>& notices) {
  std::size_t used = 0;
  const auto fits = [&](const std::vector<FrameColumn>& columns, std::size_t from, std::size_t count) {
    std::size_t bytes = 0;
    for (std::size_t k = from; k < from + count; ++k) bytes += columns[k].packed.bytes.size();
    if (used + bytes > limit) return false;
    used += bytes;
    return true;
  };
  Json json{{"dimension", dimension_}, {"count", width_}};
  if (scene_) {  // how large domains are drawn
    json["largest"] = largest_half_diagonal(*scene_);
    json["follows_shape"] = facts(scene_->method.basis).convected;
    json["least_sine"] = constants::kLeastSine;
  }
  std::vector<double> times;
  for (const SeriesFrame& frame : survey_.frames) times.push_back(frame.time);
  json["times"] = times;
  for (const auto& [name, packed] : constant_columns_) {
    used += packed.size();
    json[name] = chunks.add(packed);
  }
  for (const FrameColumn& column : positions_) used += column.packed.bytes.size();
  for (const FrameColumn& column : positions_) json["places"].push_back(describe(column, chunks));
  if (std::any_of(survey_.cracks.begin(), survey_.cracks.end(),
                  [](const Polylines& lines) { return !lines.empty(); }))
    json["lines"] = describe_lines();
  json["fields"] = Json::array();
  std::vector<std::string> dropped;
  const auto take_field = [&](std::size_t k) {
    if (survey_.extents[k].empty()) return;  // all without a number
    if (fits(fields_, k, 1)) {
      json["fields"].push_back(describe(fields_[k], chunks));
    } else {
      dropped.push_back(fields_[k].field.name);
    }
  };
  const std::size_t first = std::min(kKeptFields, fields_.size());
  for (std::size_t k = 0; k < first; ++k) take_field(k);
  if (!gradient_.empty() && !survey_.gradient[0].empty()) {
    if (fits(gradient_, 0, gradient_.size())) {
      for (const FrameColumn& column : gradient_) json["gradient"].push_back(describe(column, chunks));
    } else {
      notices.push_back(
          "Particles are drawn as squares: their deformed shapes would have made this page too large.");
    }
  }
  for (std::size_t k = first; k < fields_.size(); ++k) take_field(k);
  if (!dropped.empty())
    notices.push_back(fmt::format("Left out to keep this page small: {}. The particle files hold them.",
                                  fmt::join(dropped, ", ")));
  return json;
}

/// Every `stride`-th frame, and the last one.
std::vector<SeriesFrame> thinned(const std::vector<SeriesFrame>& frames, std::size_t stride) {
  std::vector<SeriesFrame> out;
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (k % stride == 0 || k + 1 == frames.size()) out.push_back(frames[k]);
  return out;
}

/// Particles of the first frame that can be read: later ones have as many or fewer.
std::size_t particles_of(const std::vector<SeriesFrame>& frames) {
  for (const SeriesFrame& frame : frames) {
    try {
      return VtuReader(frame.file).size();
    } catch (const FileError&) {
      // survey_frames says so
    }
  }
  return 0;
}

/// The grid and what is about it, where the scene is known and particles are there.
std::optional<Viewed> viewed_of(const std::vector<SeriesFrame>& frames, const std::optional<Scene>& scene) {
  if (!scene) return std::nullopt;
  const Viewed viewed(*scene);
  for (const SeriesFrame& frame : frames) {
    try {
      const std::vector<double> points = VtuReader(frame.file).points();
      for (std::size_t i = 0; i < points.size(); i += 3)
        if (viewed.holds(&points[i])) return viewed;
    } catch (const FileError&) {
      // survey_frames says so
    }
  }
  return std::nullopt;
}

std::set<std::uint32_t> rigid_bodies(const std::optional<Scene>& scene) {
  std::set<std::uint32_t> out;
  for (std::uint32_t b = 0; scene && b < scene->bodies.size(); ++b)
    if (is_rigid(*scene, scene->bodies[b])) out.insert(b);
  return out;
}

}  // namespace

Json pack_frames(const fs::path& folder, const std::optional<Scene>& scene, int dimension,
                 const FrameLimits& limits, Chunks& chunks, std::vector<std::string>& notices) {
  std::error_code error;
  if (!fs::exists(folder / "particles.pvd", error)) {
    notices.push_back(
        "There are no particle files, so there is no view of the particles (output.frames of the scene says "
        "how many are written).");
    return nullptr;
  }
  const std::vector<SeriesFrame> all = read_pvd(folder / "particles.pvd");
  const std::size_t particles = particles_of(all);
  const std::size_t few = 2;  // frames that a page shows at least: the first and the last
  const std::size_t particle_stride = particles * few / limits.values + 1;
  std::size_t frame_stride = particles / particle_stride * all.size() / limits.values + 1;
  const std::string picture = scene ? scene->output.picture : "pressure";
  const std::set<std::uint32_t> rigid = rigid_bodies(scene);
  const std::optional<Viewed> viewed = viewed_of(all, scene);
  for (;; frame_stride *= 2) {
    std::vector<std::string> own;
    const std::vector<SeriesFrame> chosen = thinned(all, frame_stride);
    FrameSurvey survey = survey_frames(chosen, particle_stride, dimension, picture, rigid, viewed, own);
    if (survey.frames.empty()) {
      notices.insert(notices.end(), own.begin(), own.end());
      notices.push_back("No particle file could be read, so there is no view of the particles.");
      return nullptr;
    }
    const std::size_t shown = survey.frames.size();
    FramePacker packer(std::move(survey), scene, dimension);
    if (packer.least_bytes() > limits.bytes && chosen.size() > few) continue;
    notices.insert(notices.end(), own.begin(), own.end());
    if (chosen.size() < all.size())
      notices.push_back(
          fmt::format("{} of {} frames are shown, to keep this page small.", shown, all.size()));
    if (particle_stride > 1)
      notices.push_back(
          fmt::format("One of {} particles is shown, to keep this page small.", particle_stride));
    return packer.describe(limits.bytes, chunks, notices);
  }
}

}  // namespace mpmfast
