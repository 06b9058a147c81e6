#pragma once

/// @file What the run loop remembers beside the state: with Step::visit all that a run is made of when it is
/// written to a checkpoint.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/output.hpp"
#include "engine/state/archive.hpp"
#include "engine/step/step.hpp"
#include "engine/step/visit_sums.hpp"

namespace mpmfast {

/// Even marks in time: 0, interval, 2 · interval …
class Marks {
 public:
  Marks(double end, int count) : interval_(count > 0 ? end / count : 0) {}
  bool due(double time) const { return interval_ > 0 && time >= interval_ * next_ * (1 - 1e-12); }
  void pass(double time) {
    while (due(time)) ++next_;
  }
  void visit(Archive& archive, const std::string& name) {
    archive.number(name, next_);
    next_ = std::max(next_, 1);  // a file that says less would have us pass 2^31 marks
  }

 private:
  double interval_;
  int next_ = 1;
};

/// The balance kinetic + stored + dissipated + friction + what interfaces lost and what left − work of
/// boundaries, body forces and heat, and how far it has drifted.
class EnergyBalance {
 public:
  void add(const HistoryRow& row) {
    const double gone = row.outflow ? row.outflow->energy : 0;
    const double by_heat = row.heat ? row.heat->worked : 0;
    const double balance = row.kinetic + row.stored + row.dissipated + row.friction + row.interface + gone -
                           row.boundary_work - row.body_force_work - by_heat;
    if (!started_) first_ = balance;
    started_ = true;
    drift_ = balance - first_;
    scale_ = std::max({scale_, row.kinetic + row.stored + row.dissipated, std::abs(row.boundary_work),
                       std::abs(row.body_force_work)});
  }
  double error() const { return scale_ > 0 ? drift_ / scale_ : 0; }
  void visit(Archive& archive) {
    archive.flag("balance/started", started_);
    archive.number("balance/first", first_);
    archive.number("balance/drift", drift_);
    archive.number("balance/scale", scale_);
  }

 private:
  bool started_ = false;
  double first_ = 0, drift_ = 0, scale_ = 0;
};

/// Where a run comes from and how far it is to go.
struct RunOrigin {
  std::string scene_hash, seeding;  ///< of the resolved scene; of the particles that it seeded
  std::string program;              ///< that began it
  std::string scene_name, command;
  std::vector<std::string> overrides;
  std::vector<std::string> warnings;  ///< of the scene
  double end = 0;                     ///< s
  std::uint64_t max_steps = std::numeric_limits<std::uint64_t>::max();

  void visit(Archive& archive);
};

template <int Dim>
struct RunCounters {
  Marks history, frames;
  EnergyBalance balance;
  std::optional<Overlap> overlap;  ///< of the last row
  Spacing spacing;                 ///< the widest of all rows
  Sums<Dim> last_sums;             ///< at the last row
  std::uint64_t last_row_step = ~std::uint64_t{0}, last_frame_step = ~std::uint64_t{0};
  std::uint64_t rows = 0;           ///< of history.csv
  std::string history_hash;         ///< of its header and these rows
  std::vector<double> frame_times;  ///< s
  double last_row_time = 0;         ///< s
  double particle_steps = 0;        ///< particles of each step, which may become fewer
  double first_dt = 0;              ///< the stable time step at the start, s
  double dt = 0, dt_min = std::numeric_limits<double>::infinity(), dt_max = 0;
  double stepping = 0, wall = 0;  ///< s of wall time: in the steps alone, and of the whole run
  std::uint64_t resumes = 0;

  explicit RunCounters(const Scene& scene)
      : history(scene.time.end, scene.output.history), frames(scene.time.end, scene.output.frames) {}

  /// last_sums must have the sizes of the scene.
  void visit(Archive& archive);
  /// Throws FileError where what was read cannot be that of a run of so many bodies.
  void check(std::size_t bodies) const;
};

extern template struct RunCounters<2>;
extern template struct RunCounters<3>;

}  // namespace mpmfast
