# The headers of others that most files include, compiled once: a third of the time that a build takes. A file that
# forgets one of them builds all the same then: tests/cli/includes.py notices.
set(common <Eigen/LU> <algorithm> <array> <cmath> <filesystem> <fmt/format.h> <fmt/ranges.h> <fstream> <map> <optional>
  <string> <variant> <vector>)
target_precompile_headers(mpmfast_quantities PRIVATE ${common})
# One for each level of optimisation: g++ compiles a file with the level of its precompiled header.
target_precompile_headers(mpmfast_geometry PRIVATE ${common})
# A program takes a header that was compiled for libraries if its own code is compiled alike.
function(reuse_headers from)
  foreach(target ${ARGN})
    target_precompile_headers(${target} REUSE_FROM ${from})
    target_compile_options(${target} PRIVATE -fPIC)
  endforeach()
endfunction()
set(program mpmfast)
if(TARGET mpmfast_program)
  set(program mpmfast_program)
endif()
reuse_headers(mpmfast_quantities mpmfast_scene mpmfast_study ${program})
reuse_headers(mpmfast_geometry mpmfast_output mpmfast_state mpmfast_conditions mpmfast_contact mpmfast_heat mpmfast_loads
  mpmfast_step mpmfast_core mpmfast_report)
if(MPMFAST_TESTS AND NOT MPMFAST_TEST_OBJECTS)
  target_precompile_headers(test_main PRIVATE ${common} <doctest/doctest.h>
    ${PROJECT_SOURCE_DIR}/tests/support.hpp)
  set_source_files_properties(tests/main.cpp TARGET_DIRECTORY test_main PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  reuse_headers(test_main test_support unit_tests kernel_tests short_tests validation_tests)
endif()
if(MPMFAST_BENCH)
  reuse_headers(mpmfast_geometry benchmarks)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # What bug 105651 says falsely of std::string, g++ 12 says in more ways where its header is precompiled: no matter for
  # what makes text; the passes keep these warnings.
  foreach(target mpmfast_quantities mpmfast_geometry mpmfast_scene mpmfast_output mpmfast_study mpmfast_report
      ${program} test_main unit_tests short_tests validation_tests benchmarks)
    if(TARGET ${target})
      target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
  endforeach()
  # Sums over matrices of unknown size: the headers of AVX-512 begin with values that are undefined on purpose (GCC bug 105593).
  if(TARGET unit_tests)
    target_compile_options(unit_tests PRIVATE -Wno-maybe-uninitialized)
  endif()
endif()
