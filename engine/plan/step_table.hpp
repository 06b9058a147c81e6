#pragma once

/// @file The tasks of a step, in the order in which Step::advance comes to them: one row a task. Timers, what
/// `check` lists and the table of the manual are made from it, and a test shows that steps follow it.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/plan/plan.hpp"

namespace mpmfast {

enum class Task : std::uint8_t {
  start_rigid,
  split,
  sort,
  find_crack_sides,
  project,
  project_geometry,
  press_surfaces,
  follow,
  push_surfaces,
  set_rigid_nodes,
  prepare_conditions,
  contact_nodes,
  contact_geometry,
  own_velocities,
  first_correction,
  start_velocities,
  strain_and_force,
  loads,
  react,
  momenta,
  second_correction,
  enforce,
  end_velocities,
  filter,
  re_extrapolate,
  third_correction,
  impose,
  heat,
  moving_velocities,
  update,
  drift,
  move_rigid,
  move_cracks,
  leave,
  record_energies,
  grow_cracks,
};

/// The timers of a step (run.json, `seconds`).
enum class Timer : std::uint8_t {
  sort,
  project,
  extension,
  surfaces,
  contact_nodes,
  contact_geometry,
  contact_resolve,
  strain_force,
  nodes,
  conditions,
  xpic,
  re_extrapolate,
  update,
  heat,
};
inline constexpr std::array<std::string_view, 14> kTimerNames{"sort",
                                                              "project",
                                                              "extension",
                                                              "surfaces",
                                                              "contact_nodes",
                                                              "contact_geometry",
                                                              "contact_resolve",
                                                              "strain_force",
                                                              "nodes",
                                                              "conditions",
                                                              "xpic",
                                                              "re_extrapolate",
                                                              "update",
                                                              "heat"};

struct TaskRow {
  Task task{};
  std::string_view name;      ///< its identifier
  Timer timer{};              ///< that it counts to
  std::string_view sentence;  ///< Markdown
  std::string_view equation;  ///< of the sources; may be empty
  std::string_view function;  ///< where it is
  bool due = false;           ///< not in every step of a scene that needs it
  /// What a scene makes of it, as `check` says; empty: nothing.
  std::string (*said)(const Scene&, const Plan&) = nullptr;
};

inline constexpr std::size_t kTasks = static_cast<std::size_t>(Task::grow_cracks) + 1;
const std::array<TaskRow, kTasks>& step_table();
inline const TaskRow& row_of(Task task) { return step_table()[static_cast<std::size_t>(task)]; }

/// The table of the manual.
std::string step_table_page();

}  // namespace mpmfast
