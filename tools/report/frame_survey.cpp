#include "frame_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/errors.hpp"
#include "engine/output/read_frame.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kSample = 200'000;  // values of a field that its levels are made for

std::vector<std::uint32_t> shown_ids(const VtuReader& file, std::size_t stride) {
  std::vector<std::uint32_t> ids = file.read<std::uint32_t>("id");
  std::erase_if(ids, [&](std::uint32_t id) { return id % stride != 0; });
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

void merge(std::vector<std::uint32_t>& all, const std::vector<std::uint32_t>& more) {
  if (all == more) return;
  std::vector<std::uint32_t> both;
  std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
  all = std::move(both);
}

void survey_frame(const FrameFile& file, const std::filesystem::path& path, std::size_t frames,
                  FrameSurvey& survey) {
  Polylines cracks = read_lines(file.reader(), path);
  const std::size_t stride = file.size() * frames / kSample + 1;
  merge(survey.ids, shown_ids(file.reader(), survey.particle_stride));
  const std::vector<double> points = shown_points(file.reader(), survey.viewed);
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<double> x(file.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = points[3 * i + d];
    survey.box[d].include(x, x.size() + 1);
  }
  for (std::size_t k = 0; k < survey.fields.size(); ++k)
    survey.extents[k].include(survey.fields[k].values(file), stride);
  const auto gradient = gradient_fields();
  for (std::size_t k = 0; k < gradient.size(); ++k)
    survey.gradient[k].include(gradient[k].values(file), stride);
  survey.cracks.push_back(std::move(cracks));
}

}  // namespace

void ValueRange::include(const std::vector<double>& values, std::size_t stride) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    lower = std::min(lower, values[i]);
    upper = std::max(upper, values[i]);
    if (i % stride == 0) sample.push_back(values[i]);
  }
}

FrameSurvey survey_frames(const std::vector<SeriesFrame>& frames, std::size_t particle_stride, int dimension,
                          const std::string& picture, const std::set<std::uint32_t>& rigid,
                          const std::optional<Viewed>& viewed, std::vector<std::string>& notices) {
  FrameSurvey survey;
  survey.particle_stride = particle_stride;
  survey.viewed = viewed;
  for (const SeriesFrame& frame : frames) {
    try {
      const FrameFile file(frame.file);
      if (survey.frames.empty()) survey.fields = frame_fields(file.reader(), dimension, picture, rigid);
      survey.extents.resize(survey.fields.size());
      survey_frame(file, frame.file, frames.size(), survey);
      survey.frames.push_back(frame);
    } catch (const FileError& error) {
      notices.push_back(fmt::format("A frame is left out: {}.", error.what()));
    }
  }
  return survey;
}

std::vector<double> shown_points(const VtuReader& file, const std::optional<Viewed>& viewed) {
  std::vector<double> points = file.points();
  for (std::size_t i = 0; viewed && i < points.size(); i += 3)
    if (!viewed->holds(&points[i]))
      std::fill_n(points.begin() + static_cast<std::ptrdiff_t>(i), 3,
                  std::numeric_limits<double>::quiet_NaN());
  return points;
}

PointOrder find_point_order(const VtuReader& file, const FrameSurvey& survey) {
  PointOrder point_order;
  const std::vector<std::uint32_t> ids = file.read<std::uint32_t>("id");
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto at = std::lower_bound(survey.ids.begin(), survey.ids.end(), ids[i]);
    if (at == survey.ids.end() || *at != ids[i]) continue;
    point_order.in_file.push_back(i);
    point_order.in_page.push_back(static_cast<std::size_t>(at - survey.ids.begin()));
  }
  return point_order;
}

std::array<FrameField, 4> gradient_fields() {
  const auto entry = [](const char* name, std::size_t component) {
    return FrameField{name, "", "deformation_gradient", component, FrameField::Kind::domain};
  };
  return {entry("xx", 0), entry("xy", 1), entry("yx", 3), entry("yy", 4)};
}

}  // namespace mpmfast
