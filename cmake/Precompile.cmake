# The headers of others that most files include, compiled once: a third of the time that a build takes. A file that
# forgets one of them builds all the same then, so only builds that nobody ships do it.
set(common <Eigen/LU> <algorithm> <array> <cmath> <filesystem> <fmt/format.h> <fmt/ranges.h> <fstream> <map> <optional>
  <string> <variant> <vector>)
target_precompile_headers(mpmfast_quantities PRIVATE ${common})
foreach(target mpmfast_geometry mpmfast_scene mpmfast_output mpmfast_state mpmfast_conditions mpmfast_contact mpmfast_step mpmfast_core mpmfast_study mpmfast_report mpmfast_packing)
  target_precompile_headers(${target} REUSE_FROM mpmfast_quantities)
endforeach()
if(MPMFAST_TESTS)
  target_precompile_headers(unit_tests PRIVATE ${common} <doctest/doctest.h>)
  target_precompile_headers(short_tests REUSE_FROM unit_tests)
  set_source_files_properties(tests/main.cpp TARGET_DIRECTORY unit_tests PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endif()
