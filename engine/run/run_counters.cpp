#include "engine/run/run_counters.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/errors.hpp"

namespace mpmfast {

namespace {

void refuse_counters(const char* name) {
  throw FileError(fmt::format("the checkpoint is none of its scene: {} does not fit it", name));
}

bool is_duration(double seconds) {
  constexpr double kMost = 1e10;  // s: three hundred years, which clocks can count
  return seconds >= 0 && seconds < kMost;
}

/// Lists of text are kept as one, each ended by a zero.
void visit_texts(Archive& archive, const std::string& name, std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + '\0';
  archive.list(name, all);
  if (!archive.reading()) return;
  texts.clear();
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = all.find('\0', begin);
    texts.push_back(all.substr(begin, end - begin));
    begin = end == std::string::npos ? all.size() : end + 1;
  }
}

void visit_overlap(Archive& archive, std::optional<Overlap>& overlap) {
  bool measured = overlap.has_value();
  archive.flag("run/overlap_measured", measured);
  if (!measured) return;
  if (!overlap) overlap.emplace();
  archive.number("run/overlap_area", overlap->area);
  archive.number("run/overlap_inside", overlap->inside);
  archive.number("run/overlap_particles_inside", overlap->particles_inside);
}

}  // namespace

void RunOrigin::visit(Archive& archive) {
  archive.list("origin/scene_hash", scene_hash);
  archive.list("origin/seeding", seeding);
  archive.list("origin/program", program);
  archive.list("origin/scene_name", scene_name);
  archive.list("origin/command", command);
  visit_texts(archive, "origin/overrides", overrides);
  visit_texts(archive, "origin/warnings", warnings);
  archive.number("origin/end", end);
  archive.number("origin/max_steps", max_steps);
  if (archive.reading() && !std::isfinite(end)) throw FileError("the checkpoint's run has no end");
}

template <int Dim>
void RunCounters<Dim>::check(std::size_t bodies) const {
  if (spacing.body >= bodies) refuse_counters("run/spacing_body");
  if (!is_duration(wall) || !is_duration(stepping)) refuse_counters("run/wall_seconds");
  if (!std::isfinite(first_dt) || first_dt < 0) refuse_counters("run/first_dt");
  for (const double time : frame_times)
    if (!std::isfinite(time)) refuse_counters("run/frame_times");
}

template <int Dim>
void RunCounters<Dim>::visit(Archive& archive) {
  history.visit(archive, "run/next_row");
  frames.visit(archive, "run/next_frame");
  balance.visit(archive);
  visit_overlap(archive, overlap);
  archive.number("run/spacing_cells", spacing.cells);
  archive.number("run/spacing_body", spacing.body);
  visit_sums(archive, "last_sums", last_sums);
  archive.number("run/last_row_step", last_row_step);
  archive.number("run/last_frame_step", last_frame_step);
  archive.number("run/rows", rows);
  archive.list("run/history_hash", history_hash);
  archive.list("run/frame_times", frame_times);
  archive.number("run/last_row_time", last_row_time);
  archive.number("run/particle_steps", particle_steps);
  archive.number("run/first_dt", first_dt);
  archive.number("run/dt", dt);
  archive.number("run/dt_min", dt_min);
  archive.number("run/dt_max", dt_max);
  archive.number("run/stepping_seconds", stepping);
  archive.number("run/wall_seconds", wall);
  archive.number("run/resumes", resumes);
}

template struct RunCounters<2>;
template struct RunCounters<3>;

}  // namespace mpmfast
