# The headers of others that most files include, compiled once: a third of the time that a build takes. A file that
# forgets one of them builds all the same then: tests/cli/includes.py notices.
set(common <Eigen/LU> <algorithm> <array> <cmath> <filesystem> <fmt/format.h> <fmt/ranges.h> <fstream> <map> <optional>
  <string> <variant> <vector>)
target_precompile_headers(mpmfast_quantities PRIVATE ${common})
foreach(target mpmfast_geometry mpmfast_scene mpmfast_output mpmfast_state mpmfast_conditions mpmfast_contact mpmfast_step
    mpmfast_core mpmfast_study mpmfast_report mpmfast)
  target_precompile_headers(${target} REUSE_FROM mpmfast_quantities)
endforeach()
if(MPMFAST_TESTS)
  target_precompile_headers(test_main PRIVATE ${common} <doctest/doctest.h>)
  set_source_files_properties(tests/main.cpp TARGET_DIRECTORY test_main PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  foreach(target unit_tests short_tests validation_tests)
    target_precompile_headers(${target} REUSE_FROM test_main)
  endforeach()
endif()
if(MPMFAST_BENCH)
  target_precompile_headers(benchmarks REUSE_FROM mpmfast_quantities)
endif()
