#include "engine/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "engine/errors.hpp"
#include "engine/output/checkpoint_file.hpp"
#include "engine/run/make_row.hpp"
#include "engine/run/origin.hpp"
#include "engine/run/overlap_at_start.hpp"
#include "engine/run/pause.hpp"
#include "engine/run/run_counters.hpp"
#include "engine/run/run_log.hpp"
#include "engine/run/threads.hpp"
#include "engine/run/write_grid.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kCheckpointName = "checkpoint.h5";
constexpr std::uint64_t kNever = ~std::uint64_t{0};
constexpr double kFirstSave = 60;    ///< s of wall time
constexpr double kFailureReach = 4;  ///< cells around a failure of which failed.vtu shows the particles

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

RunSummary::Settings settings_of(const Scene& scene) {
  const MethodSpec& method = scene.method;
  RunSummary::Settings out;
  out.averaged_strain = method.strain == StrainKind::average;
  out.grid_end = method.position == PositionKind::grid_end;
  out.filtered = method.update != UpdateKind::flip;
  out.volume_screen = scene.contact.volume_screen > 0;
  out.cfl = scene.time.cfl;
  out.follows_shape = facts(method.basis).convected;
  out.splits = method.split;
  for (const BodySpec& body : scene.bodies)
    if (out.flowing_body.empty() && flows(scene, body)) out.flowing_body = body.name;
  return out;
}

std::vector<double> after_first(const std::vector<double>& times) {
  return times.empty() ? times : std::vector<double>(times.begin() + 1, times.end());
}

template <int Dim>
class Run {
 public:
  /// From the start.
  Run(const Scene& scene, const RunOptions& options) : Run(scene, options, first_origin(scene, options)) {
    lock_.emplace(prepare_folder(options.folder, scene, options.force));
    if constexpr (Dim == 2) warn_of_overlap();
    history_.emplace(options.folder, scene);
    log_.emplace(options.folder, figures());
    if (scene.output.frames > 0) series_.emplace(options.folder, scene);
    if (series_ && scene.output.grid) grid_series_.emplace(options.folder, "grid");
    write_row(0);
    write_frame();
    draw("first");
  }

  /// From a checkpoint of the folder, of which the origin has been read.
  Run(const Scene& scene, const RunOptions& options, const NextOrigin& next, CheckpointReader& checkpoint)
      : Run(scene, options, next.origin) {
    if (origin_.seeding != next.origin.seeding)
      throw CannotResume(
          fmt::format("{} does not give the particles that the run began with: did an image change?",
                      scene.file.string()));
    read(checkpoint);
    limits_changed_ = next.limits_changed;
    reopen_folder(options.folder);
    ++counters_.resumes;
    log_.emplace(options.folder, figures());
    if (scene.output.frames > 0) series_.emplace(options.folder, scene, counters_.frame_times);
    if (series_ && scene.output.grid)
      grid_series_.emplace(options.folder, "grid", after_first(counters_.frame_times));
    saved_step_ = step_.state().step;
  }

  RunSummary execute() {
    last_report_ = last_save_ = Clock::now();
    start_ = last_save_ -
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(counters_.wall));
    try {
      if (limits_changed_) save();  // a kill before the next checkpoint must not bring the old ones back
      loop();
    } catch (RunFailure& failure) {
      failure.set_warnings(keep_what_there_is(failure));
      throw;
    } catch (const std::exception& failure) {
      keep_what_there_is(failure);
      throw;
    }
    // Before the last row and frame, which a run that went on would not have written; they are written even
    // where the checkpoint cannot be.
    std::exception_ptr unsaved;
    try {
      if (saved_step_ != step_.state().step) save();
    } catch (const FileError&) {
      unsaved = std::current_exception();
    }
    if (counters_.last_row_step != step_.state().step) write_row(counters_.dt);
    if (counters_.last_frame_step != step_.state().step) write_frame();
    draw("last");
    const bool ended = has_ended(step_.state().time, origin_.end);
    const bool stopped = !stop_reason_.empty();
    const RunSummary summary = summarise(stopped ? "stopped" : "finished", stopped ? stop_reason_
                                                                           : ended ? ""
                                                                                   : "steps");
    if (unsaved) std::rethrow_exception(unsaved);
    return summary;
  }

 private:
  Run(const Scene& scene, const RunOptions& options, const RunOrigin& origin)
      : scene_(scene), options_(options), origin_(origin), step_(scene), counters_(scene) {
    origin_.seeding = seeding_hash(step_.state().particles);
    counters_.last_sums = step_.sums();
  }

  /// The state, and the history that belongs to it; changes no file.
  void read(CheckpointReader& checkpoint) {
    try {
      step_.visit(checkpoint);
      counters_.visit(checkpoint);
      counters_.check(scene_.bodies.size());
      checkpoint.finish();
      history_.emplace(options_.folder, scene_,
                       HistoryMark{counters_.rows, counters_.last_row_step, counters_.history_hash});
    } catch (const FileError& error) {
      throw CannotResume(error.what());
    }
  }

  void warn_of_overlap() {
    const OverlapAtStart overlap = overlap_at_start(step_.state(), scene_);
    if (!overlap.is_likely_a_mistake) return;
    origin_.warnings.push_back(fmt::format("bodies overlap before anything moves: {}", overlap.text));
    if (options_.warn) options_.warn(origin_.warnings.back());
  }

  void loop() {
    auto& state = step_.state();
    const double end = origin_.end;
    while (!has_ended(state.time, end) && state.step < origin_.max_steps) {
      if (is_stop_asked()) return;
      if (state.step == 0) counters_.first_dt = step_.stable_dt();
      const double dt = step_.dt_towards(end, counters_.first_dt);
      counters_.particle_steps += static_cast<double>(state.particles.size());
      const auto begin = Clock::now();
      step_.advance(dt, false);
      counters_.stepping += seconds_since(begin);
      counters_.dt = dt;
      counters_.dt_min = std::min(counters_.dt_min, dt);
      counters_.dt_max = std::max(counters_.dt_max, dt);
      if (counters_.history.due(state.time)) {
        write_row(dt);
        counters_.history.pass(state.time);
      }
      if (counters_.frames.due(state.time)) {
        write_frame();
        counters_.frames.pass(state.time);
      }
      if (is_save_due()) save();
      report();
    }
  }

  bool is_stop_asked() {
    if (options_.stop_signal && *options_.stop_signal) stop_reason_ = "signal";
    if (options_.stop && asking_.due() && options_.stop()) stop_reason_ = "request";
    return !stop_reason_.empty();
  }

  bool is_save_due() const {
    const CheckpointSpec& when = scene_.output.checkpoint;
    if (when.steps > 0 && step_.state().step % static_cast<std::uint64_t>(when.steps) == 0) return true;
    // The first comes early: what is lost most often is a run that has just begun.
    const bool first = saved_step_ == kNever;
    return when.every > 0 &&
           seconds_since(last_save_) >= (first ? std::min(when.every, kFirstSave) : when.every);
  }

  /// The run as it stands. The history must be on the disk before a checkpoint that counts its rows.
  void save() {
    if (!scene_.output.checkpoint.active) return;
    step_.find_stresses();
    counters_.wall = seconds_since(start_);
    const HistoryMark mark = history_->mark();
    counters_.rows = mark.rows;
    counters_.history_hash = mark.hash;
    if (series_) counters_.frame_times = series_->times();
    CheckpointWriter checkpoint(options_.folder / kCheckpointName);
    origin_.visit(checkpoint);
    step_.visit(checkpoint);
    counters_.visit(checkpoint);
    history_->sync();
    checkpoint.keep();
    saved_step_ = step_.state().step;
    last_save_ = Clock::now();
  }

  void write_row(double dt) {
    const HistoryRow row = make_row(step_, scene_, dt, counters_);
    counters_.balance.add(row);
    history_->append(row);
    if (step_.state().step > 0) log_->row(figures(), dt);
  }

  void write_frame() {
    step_.find_stresses();
    const auto& state = step_.state();
    if (series_) series_->append(state.particles, state.time, crack_lines());
    if (grid_series_ && state.step > 0) {  // before the first step nodes know nothing
      write_grid(grid_series_->next(), step_, scene_);
      grid_series_->add(state.time);
    }
    counters_.last_frame_step = step_.state().step;
  }

  Polylines crack_lines() const {
    Polylines cracks;
    for (const auto& crack : step_.cracks().lines()) {
      cracks.emplace_back();
      for (const auto& x : crack.points) cracks.back().push_back(x.template head<2>());
    }
    return cracks;
  }

  void draw(const std::string& which) {
    if (scene_.output.picture == "none") return;
    step_.find_stresses();
    const Polylines cracks = crack_lines();
    for (const std::string& field : {std::string("body"), scene_.output.picture})
      draw_particles(options_.folder / fmt::format("picture_{}_{}.png", which, field),
                     step_.state().particles, scene_, field, step_.state().time, cracks);
  }

  double throughput() const {
    return counters_.stepping > 0 ? counters_.particle_steps / counters_.stepping : 0;
  }

  void report() {
    if (!options_.progress || seconds_since(last_report_) < 0.25) return;
    last_report_ = Clock::now();
    const auto& state = step_.state();
    Progress p;
    p.step = state.step;
    p.time = state.time;
    p.end = origin_.end;
    p.wall = seconds_since(start_);
    p.particle_steps_per_second = throughput();
    p.seconds_left = counters_.dt > 0 ? (origin_.end - state.time) / counters_.dt * p.wall /
                                            static_cast<double>(state.step)
                                      : 0;
    p.energy_error = counters_.balance.error();
    options_.progress(p);
  }

  /// After a failure: run.json first, then the neighbourhood of the place where it failed, a last frame and
  /// pictures of the half-made step, if they can be made. The history ends with the last whole row.
  /// @return the warnings of the run
  std::vector<std::string> keep_what_there_is(const std::exception& failure) {
    const auto* physical = dynamic_cast<const RunFailure*>(&failure);
    failed_by_ = physical ? "physics" : dynamic_cast<const FileError*>(&failure) ? "files" : "program";
    const auto attempt = [](auto f) {
      try {
        f();
      } catch (const std::exception&) {  // the failure itself is what the user must hear of
      }
    };
    std::vector<std::string> warnings;
    attempt([&] { warnings = all_warnings(summarise("failed", failure.what())); });
    if (physical && physical->position()) attempt([&] { write_failed(*physical->position()); });
    attempt([&] { write_frame(); });
    attempt([&] { draw("last"); });
    return warnings;
  }

  void write_failed(const RunFailure::Position& position) {
    step_.find_stresses();
    const auto& state = step_.state();
    Vec<Dim> centre;
    for (int d = 0; d < Dim; ++d) centre[d] = position[static_cast<std::size_t>(d)];
    std::vector<Vec<Dim>> positions;
    for (std::size_t p = 0; p < state.particles.size(); ++p) positions.push_back(step_.position_of(p));
    write_neighbourhood(options_.folder / "failed.vtu", state.particles, scene_, positions, centre,
                        kFailureReach * state.grid.cell, state.time);
  }

  /// What is known of the run while it goes on.
  RunSummary figures() {
    const auto& state = step_.state();
    RunSummary s;
    s.scene_name = origin_.scene_name;
    s.dimension = Dim;
    s.threads = state.threads;
    s.particles = state.particles.size();
    s.fields = step_.plan().fields.size();
    s.nodes_active_peak = step_.nodes_peak();
    s.steps = state.step;
    s.time = state.time;
    s.dt_min = state.step > 0 ? counters_.dt_min : 0;
    s.dt_max = counters_.dt_max;
    s.wall = seconds_since(start_);
    s.particle_steps_per_second = throughput();
    s.third_cracks = step_.cracks().counters().third;
    const ContactCounters& c = step_.contact_counters();
    const double mean_iterations =
        c.regressions > 0 ? static_cast<double>(c.iterations) / static_cast<double>(c.regressions) : 0;
    s.contact = {c.nodes_peak, c.regressions, c.fallbacks,      c.unconverged, mean_iterations, c.touching,
                 c.doubtful,   c.pair_nodes,  c.pair_fallbacks, c.meetings,    c.screened};
    s.contact.points_peak = step_.penalty().contact_points_peak();
    s.energy_error = counters_.balance.error();
    s.settings = settings_of(scene_);
    s.spacing = counters_.spacing.cells;
    // A domain's corners reach the nodes around them, which two domains of two cells still share.
    s.most_spacing = facts(scene_.method.basis).convected ? 2 : 1;
    if (s.spacing > 0) s.spacing_body = scene_.bodies[counters_.spacing.body].name;
    if (step_.plan().split_edge > 0) s.splits = {step_.splits().splits, step_.splits().held};
    s.command = origin_.command;
    s.overrides = origin_.overrides;
    s.scene_warnings = origin_.warnings;
    s.resumes = counters_.resumes;
    return s;
  }

  RunSummary summarise(const std::string& status, const std::string& reason) {
    RunSummary s = figures();
    s.resolved_yaml = scene_.resolved_yaml;
    s.status = status;
    s.reason = reason;
    s.failed_by = failed_by_;
    s.history = history_->mark();
    s.peak_memory_bytes = peak_memory_bytes();
    for (std::size_t k = 0; k < kTimerNames.size(); ++k)
      s.seconds.emplace_back(kTimerNames[k], step_.clock().seconds()[k]);
    s.seconds.emplace_back("output", std::max(0.0, s.wall - counters_.stepping));
    s.overlap = counters_.overlap;
    s.outflow = outflow_of(step_, scene_);
    step_.find_stresses();
    s.checksum = checksum(step_.state().particles);
    write_run_json(options_.folder, s);
    log_->close(s);
    return s;
  }

  const Scene& scene_;
  const RunOptions& options_;
  std::optional<FolderLock> lock_;  ///< of a run from the start; one that goes on was given it
  RunOrigin origin_;
  Step<Dim> step_;
  RunCounters<Dim> counters_;
  std::optional<HistoryFile> history_;
  std::optional<RunLog> log_;
  std::optional<ParticleSeries<Dim>> series_;
  std::optional<FrameSeries> grid_series_;
  std::uint64_t saved_step_ = kNever;  ///< of the last checkpoint
  bool limits_changed_ = false;        ///< since the checkpoint from which it goes on
  std::string stop_reason_;            ///< empty: it was not stopped
  std::string failed_by_;              ///< empty: it did not fail
  Pause asking_;
  Clock::time_point start_ = Clock::now(), last_report_ = start_, last_save_ = start_;
};

/// In place, since a reader is not moved.
std::optional<CheckpointReader> open_checkpoint(const std::filesystem::path& path) {
  try {
    return std::optional<CheckpointReader>(std::in_place, path);
  } catch (const FileError& error) {
    throw CannotResume(error.what());
  }
}

template <int Dim>
RunSummary go_on(const Scene& scene, const RunOptions& options, const NextOrigin& next,
                 std::optional<CheckpointReader>& checkpoint) {
  Run<Dim> run(scene, options, next, *checkpoint);
  checkpoint.reset();  // closes the file, which the next one replaces
  return run.execute();
}

}  // namespace

RunSummary run_scene(const Scene& scene, const RunOptions& options) {
  const ThreadCount threads(options.threads);
  reset_peak_memory();
  if (scene.dimension() == 3) return Run<3>(scene, options).execute();
  return Run<2>(scene, options).execute();
}

std::optional<RunSummary> resume_run(const RunOptions& options) {
  const ThreadCount threads(options.threads);
  reset_peak_memory();
  const std::filesystem::path path = options.folder / kCheckpointName;
  std::error_code error;
  if (!std::filesystem::is_directory(options.folder, error))
    throw FileError(options.folder.string() +
                    (std::filesystem::exists(options.folder, error)
                         ? " is no folder: what resumes is the output folder of a run"
                         : ": there is no such folder"));
  if (!std::filesystem::exists(path, error))
    throw FileError(
        options.folder.string() +
        " holds no checkpoint (the first comes after a minute, or as output.checkpoint says): run the "
        "scene anew");
  const FolderLock lock(options.folder, FolderWriter::run);
  std::optional<CheckpointReader> checkpoint = open_checkpoint(path);
  const Scene scene = read_scene(options.folder / "scene.yaml");
  const std::optional<NextOrigin> next = next_origin(scene, options, *checkpoint);
  if (!next) return std::nullopt;
  if (scene.dimension() == 3) return go_on<3>(scene, options, *next, checkpoint);
  return go_on<2>(scene, options, *next, checkpoint);
}

}  // namespace mpmfast
