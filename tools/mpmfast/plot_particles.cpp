#include "plot_particles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "complain.hpp"
#include "engine/errors.hpp"
#include "engine/output/animated_png.hpp"
#include "engine/output/files.hpp"
#include "engine/output/paint.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/read_frame.hpp"
#include "engine/quantities/quantity.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/scene/text/suggest.hpp"
#include "exit_codes.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

int refuse(const std::string& option, const std::string& why, const std::string& hint = "") {
  complain("mpmfast: {}: {}{}\n", option, why, hint.empty() ? "" : ". " + hint);
  return kExitWrongInput;
}

/// Index of the frame that was asked for; nothing when there is none of that number.
std::optional<std::size_t> frame_index(const std::string& text, std::size_t count) {
  if (text == "first") return 0;
  if (text == "last") return count - 1;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size() || index >= count) return std::nullopt;
  return index;
}

/// What follows the number: "MPa" of "3 MPa".
std::string unit_in(const std::string& text) {
  for (std::size_t end = text.size(); end > 0; --end)
    if (std::holds_alternative<double>(parse_quantity(text.substr(0, end), Measure::number)))
      return text.substr(end);
  return "";
}

/// "LOW:HIGH", each with a unit of the field or in SI; a bare LOW has the unit of HIGH.
std::optional<Range> read_range(const std::string& text, const std::string& unit) {
  const Measure measure = unit == "Pa"    ? Measure::pressure
                          : unit == "m/s" ? Measure::velocity
                          : unit == "K"   ? Measure::temperature
                                          : Measure::number;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const std::string low = text.substr(0, colon), high = text.substr(colon + 1);
  const bool bare = std::holds_alternative<double>(parse_quantity(low, Measure::number));
  const auto lower = parse_quantity(bare ? low + unit_in(high) : low, measure),
             upper = parse_quantity(high, measure);
  if (!std::holds_alternative<double>(lower) || !std::holds_alternative<double>(upper)) return std::nullopt;
  const Range range{std::get<double>(lower), std::get<double>(upper)};
  return range.lower < range.upper ? std::optional(range) : std::nullopt;
}

/// Is there no column for it?
bool lacks(const FieldValues& values) {
  return std::all_of(values.value.begin(), values.value.end(), [](double v) { return std::isnan(v); });
}

template <int Dim>
class Series {
 public:
  Series(const Scene& scene, std::vector<SeriesFrame> frames) : scene_(scene), frames_(std::move(frames)) {}

  std::size_t size() const { return frames_.size(); }
  double time(std::size_t k) const { return frames_[k].time; }
  struct Frame {
    Particles<Dim> particles;
    Polylines cracks;
  };
  Frame read(std::size_t k) const {
    const VtuReader file(frames_[k].file);
    return {read_frame<Dim>(file, frames_[k].file, scene_), read_lines(file, frames_[k].file)};
  }

 private:
  const Scene& scene_;
  std::vector<SeriesFrame> frames_;
};

template <int Dim>
class ParticlePlot {
 public:
  ParticlePlot(const CommandLine& line, const PlotFiles& files, const Scene& scene,
               std::vector<SeriesFrame> frames)
      : line_(line), files_(files), scene_(scene), series_(scene, std::move(frames)) {}

  /// Is what was asked for there? Says what is not.
  int check(const std::vector<std::string>& fields) const {
    if (!line_.frame.empty() && !frame_index(line_.frame, series_.size()))
      return refuse("--frame", fmt::format("not a frame of this run (first, last or 0 to {}), got '{}'",
                                           series_.size() - 1, line_.frame));
    for (const std::string& field : fields) {
      const FieldValues values = field_values(Particles<Dim>(), scene_, field);
      if (!line_.range.empty() && !colours_of(values))
        return refuse(
            "--range",
            fmt::format("not LOW:HIGH for {} ({}), such as 0:5, got '{}'", values.label,
                        values.unit.empty() ? "which has names, not numbers" : values.unit, line_.range));
    }
    return 0;
  }

  /// One picture of one frame, or the animation of all; vectors do not move, and show the last one.
  void draw(const std::string& field) {
    const auto colours = colours_of(field_values(Particles<Dim>(), scene_, field));
    const bool still = line_.frame.empty() && !files_.picture.empty() &&
                       picture_format(files_.picture) != PictureFormat::png;
    if (const auto k = frame_index(still ? "last" : line_.frame, series_.size()))
      draw_frame(field, *k, colours);
    else
      animate(field, colours);
  }

 private:
  std::optional<Range> colours_of(const FieldValues& values) const {
    if (line_.range.empty() || values.names) return std::nullopt;
    return read_range(line_.range, values.unit);
  }

  void draw_frame(const std::string& field, std::size_t k, std::optional<Range> colours) {
    const auto [particles, cracks] = series_.read(k);
    Framing framing = framing_of(particles, scene_, field);
    if (colours) framing.values = colours;
    const fs::path path = files_.at(fmt::format("plot_{}_{:06}.png", field, k));
    const PictureFormat format = picture_format(path).value_or(PictureFormat::png);
    paint_particles(particles, scene_, field, series_.time(k), framing, format, cracks).write(path);
    say("picture          {}\n", path.string());
  }

  void animate(const std::string& field, std::optional<Range> colours) {
    Framing framing;
    for (std::size_t k = 0; k < series_.size(); ++k)
      framing.include(framing_of(series_.read(k).particles, scene_, field));
    if (colours) framing.values = colours;
    std::optional<AnimatedPng> animation;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      const auto [particles, cracks] = series_.read(k);
      Canvas canvas =
          paint_particles(particles, scene_, field, series_.time(k), framing, PictureFormat::png, cracks);
      if (!animation) animation.emplace(canvas.width(), canvas.height(), kRate);
      animation->add(canvas.pixels());
    }
    const fs::path path = files_.at(fmt::format("plot_{}.png", field));
    animation->write(path);
    say("animation        {} ({} frames; opens in a browser)\n", path.string(), series_.size());
  }

  static constexpr int kRate = 8;  ///< frames a second
  const CommandLine& line_;
  const PlotFiles& files_;
  const Scene& scene_;
  Series<Dim> series_;
};

template <int Dim>
int plot_fields(const CommandLine& line, const PlotFiles& files, const Scene& scene,
                std::vector<SeriesFrame> frames) {
  std::vector<std::string> fields = line.fields;
  if (fields.empty()) fields.push_back(scene.output.picture == "none" ? "body" : scene.output.picture);
  const std::vector<std::string> known = field_names(Dim);
  for (const std::string& field : fields)
    if (std::find(known.begin(), known.end(), field) == known.end())
      return refuse("--field", fmt::format("not known (one of {}), got '{}'", fmt::join(known, ", "), field),
                    did_you_mean(field, known));
  const Particles<Dim> first = read_frame<Dim>(VtuReader(frames[0].file), frames[0].file, scene);
  for (const std::string& field : fields)
    if (first.size() > 0 && lacks(field_values(first, scene, field)))
      return refuse("--field", fmt::format("the particles of this run have no {}", field));
  ParticlePlot<Dim> plot(line, files, scene, std::move(frames));
  if (const int code = plot.check(fields); code != 0) return code;
  make_folder(files.folder);
  for (const std::string& field : fields) plot.draw(field);
  return 0;
}

}  // namespace

bool has_particle_files(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "particles.pvd", error);
}

int plot_particles(const CommandLine& line, const PlotFiles& files) {
  const fs::path folder = line.scene;
  if (!has_particle_files(folder))
    throw FileError(
        fmt::format("{} has no particle files (particles.pvd): the scene's output.frames was 0, or it is no "
                    "output folder of a run",
                    folder.string()));
  const Scene scene = read_scene(folder / "scene.yaml");
  std::vector<SeriesFrame> frames = read_pvd(folder / "particles.pvd");
  if (frames.empty()) throw FileError(fmt::format("{} lists no frames", (folder / "particles.pvd").string()));
  return scene.dimension() == 2 ? plot_fields<2>(line, files, scene, std::move(frames))
                                : plot_fields<3>(line, files, scene, std::move(frames));
}

}  // namespace mpmfast
