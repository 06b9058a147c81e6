/// The program: what all benchmarks are compiled with goes into the head of the results.

#include <benchmark/benchmark.h>

#include <string>

#include "kernels/simd/lanes.hpp"
#include "mpmfast_version.hpp"

int main(int count, char** arguments) {
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::AddCustomContext("lanes", std::to_string(mpmfast::kLanes));
  benchmark::AddCustomContext("git", mpmfast::kGit);
  benchmark::AddCustomContext("flags", mpmfast::kFlags);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
