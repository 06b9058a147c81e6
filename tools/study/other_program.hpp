#pragma once

/// @file Runs of a study by another build of the program: an older one, or one of another precision.

#include <filesystem>
#include <string>
#include <vector>

#include "study.hpp"

namespace mpmfast {

/// Where a program lies that a study names: relative to the study, as its scene is.
std::filesystem::path program_path(const Study& study, const Setting& asked);

/// Throws SceneError if one of the study's programs is not there; a study can be read without them.
void check_programs(const Study& study);

/// What a program is asked to run: the scene, and which program it is (of run.program a hash): an earlier
/// run counts if neither has changed. Throws FileError when the program cannot be read.
std::string order_text(const StudyRun& run);

/// The file in the study's folder that holds this text.
std::filesystem::path order_file(const StudyRun& run, const std::filesystem::path& folder);

/// The command lines that run an order into a folder, and go on with it, quietly.
/// @param threads  0: as many as the program wants
std::vector<std::string> run_words(const std::filesystem::path& program, const std::filesystem::path& order,
                                   const std::filesystem::path& folder, int threads);
std::vector<std::string> resume_words(const std::filesystem::path& program,
                                      const std::filesystem::path& folder, int threads);

/// Has run.program run the scene into its folder, quietly. @param threads 0: as many as it wants.
/// @return "finished", "failed" or "stopped". Throws FileError when it cannot be started or ends otherwise.
std::string run_by_program(const StudyRun& run, const std::filesystem::path& folder, int threads,
                           const volatile int* stop_signal);

}  // namespace mpmfast
