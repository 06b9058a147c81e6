#include "engine/step/run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/errors.hpp"
#include "engine/step/step.hpp"

namespace mpmfast {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Even marks in time: 0, interval, 2 · interval …
class Marks {
 public:
  Marks(double end, int count) : interval_(count > 0 ? end / count : 0) {}
  bool due(double time) const { return interval_ > 0 && time >= interval_ * next_ * (1 - 1e-12); }
  void pass(double time) {
    while (due(time)) ++next_;
  }

 private:
  double interval_;
  int next_ = 1;
};

/// The balance kinetic + stored + dissipated + friction − work of boundaries and body forces, and how far it
/// has drifted.
class EnergyBalance {
 public:
  void add(const HistoryRow& row) {
    const double balance =
        row.kinetic + row.stored + row.dissipated + row.friction - row.boundary_work - row.body_force_work;
    if (!started_) first_ = balance;
    started_ = true;
    drift_ = balance - first_;
    scale_ = std::max({scale_, row.kinetic + row.stored + row.dissipated, std::abs(row.boundary_work),
                       std::abs(row.body_force_work)});
  }
  double error() const { return scale_ > 0 ? drift_ / scale_ : 0; }

 private:
  bool started_ = false;
  double first_ = 0, drift_ = 0, scale_ = 0;
};

template <int Dim>
class Run {
 public:
  Run(const Scene& scene, const RunOptions& options)
      : scene_(scene),
        options_(options),
        step_(scene),
        end_(std::min(scene.time.end, options.until)),
        history_marks_(scene.time.end, scene.output.history),
        frame_marks_(scene.time.end, scene.output.frames) {
    prepare_folder(options.folder, scene, options.force);
    history_.emplace(options.folder, scene);
    if (scene.output.frames > 0) series_.emplace(options.folder, scene);
    last_impulse_ = step_.sums();
  }

  RunSummary execute() {
    write_row(0);
    write_frame();
    draw("first");
    start_ = Clock::now();
    last_report_ = start_;
    try {
      loop();
    } catch (const std::exception& failure) {
      keep_what_there_is(failure.what());
      throw;
    }
    if (last_row_step_ != step_.state().step) write_row(dt_);
    if (last_frame_step_ != step_.state().step) write_frame();
    draw("last");
    const bool ended = step_.state().time >= end_ * (1 - 1e-12);
    return summarise(stopped_ ? "stopped" : "finished", stopped_ ? "signal" : ended ? "" : "steps");
  }

 private:
  void loop() {
    auto& state = step_.state();
    while (state.time < end_ * (1 - 1e-12) && state.step < options_.max_steps) {
      if (options_.stop_signal && *options_.stop_signal) {
        stopped_ = true;
        return;
      }
      const double stable = step_.stable_dt();
      const double left = end_ - state.time;
      // Two even steps rather than a last sliver.
      const double dt = left <= stable ? left : left < 2 * stable ? 0.5 * left : stable;
      if (!(dt > 1e-12 * end_) && dt < left)
        throw RunFailure(fmt::format("step {}, time {:.9g} s: the time step collapsed to {:.3g} s",
                                     state.step, state.time, dt));
      const auto begin = Clock::now();
      step_.advance(dt);
      stepping_ += seconds_since(begin);
      dt_ = dt;
      dt_min_ = std::min(dt_min_, dt);
      dt_max_ = std::max(dt_max_, dt);
      if (history_marks_.due(state.time)) {
        write_row(dt);
        history_marks_.pass(state.time);
      }
      if (frame_marks_.due(state.time)) {
        write_frame();
        frame_marks_.pass(state.time);
      }
      report();
    }
  }

  void write_row(double dt) {
    const auto& state = step_.state();
    HistoryRow row;
    row.step = state.step;
    row.time = state.time;
    row.dt = dt;
    const Sums<Dim>& sums = step_.sums();
    row.stored = step_.stored_energy();
    row.dissipated = step_.dissipated_energy();
    row.friction = sums.friction_work;
    row.boundary_work = sums.boundary_work;
    row.body_force_work = sums.body_force_work;
    fill_particle_sums(state.particles, scene_, row);
    const double elapsed = state.time - last_row_time_;
    const auto mean_force = [&](const auto& now, const auto& before) {
      Vec3 force{};
      for (int d = 0; d < now.size() && elapsed > 0; ++d)
        force[static_cast<std::size_t>(d)] = (now[d] - before[d]) / elapsed;
      return force;
    };
    for (std::size_t b = 0; b < sums.boundary_impulse.size(); ++b)
      row.boundary_force.push_back(mean_force(sums.boundary_impulse[b], last_impulse_.boundary_impulse[b]));
    row.rigid_force.assign(scene_.bodies.size(), Vec3{});
    row.rigid_moment.assign(scene_.bodies.size(), Vec3{});
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const auto f = static_cast<std::size_t>(step_.plan().body_field[b]);
      if (!step_.plan().field_rigid[f]) continue;
      row.rigid_force[b] = mean_force(sums.rigid_impulse[f], last_impulse_.rigid_impulse[f]);
      row.rigid_moment[b] = mean_force(sums.rigid_moment[f], last_impulse_.rigid_moment[f]);
    }
    for (std::size_t k = 0; k < sums.pair_impulse.size(); ++k)
      row.pair_force.push_back(mean_force(sums.pair_impulse[k], last_impulse_.pair_impulse[k]));
    row.pair_friction = sums.pair_friction_work;
    measure_overlap_of_fields();
    row.overlap = overlap_;
    last_impulse_ = sums;
    last_row_time_ = state.time;
    last_row_step_ = state.step;
    balance_.add(row);
    history_->append(row);
  }

  void measure_overlap_of_fields() {
    const auto& state = step_.state();
    if constexpr (Dim == 2)
      if (scene_.output.overlap)
        overlap_ =
            measure_overlap(particle_domains(state.particles, state.bodies, state.body_field), state.threads);
  }

  void write_frame() {
    if (series_) series_->append(step_.state().particles, step_.state().time);
    last_frame_step_ = step_.state().step;
  }

  void draw(const std::string& which) {
    for (const std::string& field : {std::string("body"), scene_.output.picture})
      draw_particles(options_.folder / fmt::format("picture_{}_{}.png", which, field),
                     step_.state().particles, scene_, field, step_.state().time);
  }

  double throughput() const {
    const auto work =
        static_cast<double>(step_.state().particles.size()) * static_cast<double>(step_.state().step);
    return stepping_ > 0 ? work / stepping_ : 0;
  }

  void report() {
    if (!options_.progress || seconds_since(last_report_) < 0.25) return;
    last_report_ = Clock::now();
    const auto& state = step_.state();
    Progress p;
    p.step = state.step;
    p.time = state.time;
    p.end = end_;
    p.wall = seconds_since(start_);
    p.particle_steps_per_second = throughput();
    p.seconds_left = dt_ > 0 ? (end_ - state.time) / dt_ * p.wall / static_cast<double>(state.step) : 0;
    p.energy_error = balance_.error();
    options_.progress(p);
  }

  /// After a failure: run.json first, then a last frame and pictures of the half-made step, if they can be
  /// made. The history ends with the last whole row.
  void keep_what_there_is(const std::string& reason) {
    const auto attempt = [](auto f) {
      try {
        f();
      } catch (const std::exception&) {  // the failure itself is what the user must hear of
      }
    };
    attempt([&] { summarise("failed", reason); });
    attempt([&] { write_frame(); });
    attempt([&] { draw("last"); });
  }

  RunSummary summarise(const std::string& status, const std::string& reason) {
    const auto& state = step_.state();
    RunSummary s;
    s.resolved_yaml = scene_.resolved_yaml;
    s.scene_name = scene_.file.filename().string();
    s.status = status;
    s.reason = reason;
    s.dimension = Dim;
    s.threads = state.threads;
    s.particles = state.particles.size();
    s.fields = step_.plan().fields.size();
    s.nodes_active_peak = step_.nodes_peak();
    s.steps = state.step;
    s.time = state.time;
    s.dt_min = state.step > 0 ? dt_min_ : 0;
    s.dt_max = dt_max_;
    s.wall = seconds_since(start_);
    s.particle_steps_per_second = throughput();
    s.peak_memory_bytes = peak_memory_bytes();
    for (std::size_t k = 0; k < kPassNames.size(); ++k)
      s.seconds.emplace_back(kPassNames[k], step_.clock().seconds()[k]);
    s.seconds.emplace_back("output", std::max(0.0, s.wall - stepping_));
    const ContactCounters& c = step_.contact_counters();
    const double mean_iterations =
        c.regressions > 0 ? static_cast<double>(c.iterations) / static_cast<double>(c.regressions) : 0;
    s.contact = {c.nodes_peak,    c.regressions, c.fallbacks,     c.unconverged,
                 mean_iterations, c.pair_nodes,  c.pair_fallbacks};
    s.energy_error = balance_.error();
    s.overlap = overlap_;
    s.checksum = checksum(state.particles);
    s.command = options_.command;
    s.overrides = options_.overrides;
    write_run_json(options_.folder, s);
    return s;
  }

  const Scene& scene_;
  const RunOptions& options_;
  Step<Dim> step_;
  double end_;
  Marks history_marks_, frame_marks_;
  std::optional<HistoryFile> history_;
  std::optional<ParticleSeries<Dim>> series_;
  EnergyBalance balance_;
  std::optional<Overlap> overlap_;  ///< of the last row
  Sums<Dim> last_impulse_;
  double last_row_time_ = 0, dt_ = 0, dt_min_ = std::numeric_limits<double>::infinity(), dt_max_ = 0,
         stepping_ = 0;
  std::uint64_t last_row_step_ = ~std::uint64_t{0}, last_frame_step_ = ~std::uint64_t{0};
  bool stopped_ = false;
  Clock::time_point start_ = Clock::now(), last_report_ = start_;
};

}  // namespace

RunSummary run_scene(const Scene& scene, const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  if (scene.dimension() == 3) return Run<3>(scene, options).execute();
  return Run<2>(scene, options).execute();
}

}  // namespace mpmfast
