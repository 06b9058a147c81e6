#pragma once

/// @file Runs of a study as jobs of another program, which starts each where it will and waits for its end:
/// `srun -n1 -c4 mpmfast run …`. It must see the study's folder, and the program, under the same paths.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study.hpp"

namespace mpmfast {

/// Why these words are no command before which a run could stand; empty if they are.
std::string launcher_mistake(const std::vector<std::string>& words);

struct Launch {
  std::vector<std::string> words;  ///< the command; {threads} and {name} stand for those of the run
  std::filesystem::path program;   ///< mpmfast, for runs that name no other
  std::filesystem::path folder;    ///< of the study
  int threads = 1;                 ///< of a run
  int restarts = 2;                ///< of a run that is lost
  const volatile int* stop_signal = nullptr;
};

struct Launched {
  bool lost = false, stopped = false;
  std::string note;  ///< "finished, 0.25 s", "failed: why", "lost: why"
};

/// Starts a run, from its checkpoint where it has one that serves, and again when it is lost: killed, stopped
/// by somebody else, never begun. What it says goes to NAME.log beside its folder. Throws FileError when its
/// order cannot be written.
/// @param anew   what is in its folder does not count
/// @param again  called with the reason for which it is started again
Launched run_launched(const StudyRun& run, const Launch& launch, bool anew,
                      const std::function<void(const std::string&)>& again);

}  // namespace mpmfast
