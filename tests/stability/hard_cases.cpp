// The hard cases of configs/studies/stability.yaml at the default time step: the default method, and the one
// of the ellipses. bench/stability.sh draws the whole map.

#include <algorithm>

#include "tests/support.hpp"
#include "tools/study/run_study.hpp"
#include "tools/study/study_results.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// They take minutes: bench/stability.sh runs them.
bool is_grains(const std::string& name) {
  return name.find("grains") != std::string::npos || name.find("packing") != std::string::npos;
}

/// Runs the variants of `method` and checks what must hold in each.
void check_cases(const Only& method) {
  const Folder folder;
  const Study study = read_study(test::source_folder() / "configs/studies/stability.yaml");
  StudyRuns runs = expand_study(study);
  std::erase_if(runs.variants, [&](const StudyRun& run) {
    return !goes_with(study.axes, run.choice, method) || is_grains(run.name);
  });
  REQUIRE(!runs.variants.empty());
  StudyOptions options;
  options.folder = folder / "study";
  options.threads = 1;
  prepare_study_folder(study, options.folder);
  run_study(runs, options);
  const StudyResults results = collect_results(study, runs, options.folder);
  for (std::size_t k = 0; k < runs.variants.size(); ++k) {
    const StudyResult& result = results.variants[k];
    CAPTURE(runs.variants[k].name);
    CAPTURE(result.reason);
    for (std::size_t n = 0; n < result.judged.size(); ++n)
      if (result.judged[n] && !result.judged[n]->holds)
        MESSAGE(runs.variants[k].name << ": " << study.conditions[n].name << " " << result.judged[n]->value);
    CHECK(holds(result));
  }
}

TEST_CASE("hard cases hold with the default method") {
  check_cases({{"variants", {"flip"}}, {"method.basis", {"ugimp"}}, {"time.cfl", {"0.5"}}});
}

TEST_CASE("hard cases hold with XPIC(5) and lCPDI") {
  check_cases({{"variants", {"xpic(5)"}}, {"method.basis", {"lcpdi"}}, {"time.cfl", {"0.5"}}});
}

TEST_CASE("a bar that is torn says so, and not one that is pressed") {
  const auto parts = [](const char* scene) {
    const std::vector<RunWarning> warnings = run_warnings(run(scene_file(scene)).summary);
    return std::any_of(warnings.begin(), warnings.end(), [](const RunWarning& warning) {
      return warning.text.starts_with("particles of body '") &&
             warning.text.find(" cells apart") != std::string::npos;
    });
  };
  CHECK(parts("hard/stretch.yaml"));
  CHECK_FALSE(parts("hard/fast_impact.yaml"));
}

}  // namespace
}  // namespace mpmfast
