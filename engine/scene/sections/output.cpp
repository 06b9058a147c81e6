#include "engine/scene/sections/describe.hpp"

namespace mpmfast {

namespace {

/// By wall time, by steps, or both; what is not asked for is off.
void describe_checkpoint(Slot& slot, CheckpointSpec& checkpoint) {
  if (slot.is_keyword("none", !checkpoint.active)) {
    checkpoint.active = false;
    return;
  }
  constexpr const char* kExpected = "none or a map {every, steps}";
  if (slot.reads() && slot.value()->is(Node::Kind::scalar))
    return slot.complain(std::string("not ") + kExpected, "Write {steps: 1000} or {every: 10 min}");
  slot.map(kExpected, [&](Keys& map) {
    constexpr int kMostSteps = 2000000000;
    map.at("every", "After so much wall time; none where only `steps` is given.", [&](Slot& every) {
      if (every.is_keyword("none", checkpoint.every == 0))
        checkpoint.every = 0;
      else
        every.take(checkpoint.every, Number{Measure::time, kPositive});
    });
    map.at("steps", "After so many steps.", [&](Slot& steps) {
      if (!steps.is_keyword("none", checkpoint.steps == 0))
        steps.take(checkpoint.steps, Whole{1, kMostSteps});
    });
    if (map.reads() && !map.stated("every") && checkpoint.steps > 0) checkpoint.every = 0;
  });
}

/// Fields that a picture can show.
std::vector<std::string> pictures(int dimension) {
  std::vector<std::string> known;
  for (const std::string field : kPictures) {
    const bool needs_depth = field == "stress_yz" || field == "stress_xz";
    if (dimension == 3 || !needs_depth) known.push_back(field);
  }
  return known;
}

}  // namespace

void describe_output(Keys& top, int dimension, OutputSpec& output) {
  top.section(
      "output", "What a run leaves in its folder, and how often.",
      "a map {frames, history, picture, overlap, grid, checkpoint}", [&](Keys& map) {
        constexpr int kMostFrames = 999999;  // frames are numbered with six digits
        constexpr int kMostRows = 100000000;
        map.key("frames", "Particle files, evenly spaced in time, beside the initial one; 0: none at all.",
                output.frames, Whole{0, kMostFrames});
        map.key("history", "Rows of history.csv beside the initial one.", output.history,
                Whole{1, kMostRows});
        map.key("grid",
                "With each frame after the first a file of the nodes (grid.pvd): masses, velocities, "
                "contact.",
                output.grid);
        map.at("overlap", "2-D: history.csv and run.json say how much bodies enter each other.",
               [&](Slot& slot) {
                 slot.take(output.overlap);
                 if (slot.reads() && output.overlap && dimension == 3)
                   slot.complain("the overlap of bodies is measured in 2-D only");
               });
        map.at("checkpoint",
               "When the state is written for `mpmfast resume`, beside at a signal and at the end; none: "
               "never.",
               [&](Slot& slot) { describe_checkpoint(slot, output.checkpoint); });
        map.key("picture", "What the second picture shows, beside the bodies; none: no pictures.",
                output.picture, pictures(map.describes() ? 3 : dimension));
      });
}

}  // namespace mpmfast
