# Several files in one translation unit: each begins with the same headers, which take most of the time that a short file
# takes. Not the passes of the bases: their files are long.
set(program mpmfast)
if(TARGET mpmfast_program)
  set(program mpmfast_program)
endif()
set_target_properties(mpmfast_quantities mpmfast_geometry mpmfast_scene mpmfast_output mpmfast_core mpmfast_study
  mpmfast_report ${program} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
set_target_properties(mpmfast_state mpmfast_step mpmfast_conditions mpmfast_contact mpmfast_heat mpmfast_loads PROPERTIES
  UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
set_source_files_properties(${BASIS_SOURCES} TARGET_DIRECTORY mpmfast_step PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

# The tests of a program in so many units, by a hash of the file's name: a new file moves no other. Two tests of a unit must
# not give one name to two things; where they would, one of them is compiled by itself (SKIP_UNITY_BUILD_INCLUSION).
function(unite_tests target units)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(name ${source} NAME_WE)
    string(MD5 hash ${name})
    string(SUBSTRING ${hash} 0 4 hash)
    math(EXPR unit "0x${hash} % ${units}")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${unit})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
set(united "")
if(MPMFAST_TESTS AND NOT MPMFAST_TEST_OBJECTS)
  unite_tests(unit_tests 14)
  unite_tests(short_tests 2)
  unite_tests(validation_tests 10)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/stability/recorded_runs.cpp
    ${PROJECT_SOURCE_DIR}/tests/validation/cohesive_limits.cpp TARGET_DIRECTORY validation_tests
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(name curved_springs output_framing scene_resolved scene_schema two_pairs)
    set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/unit/${name}.cpp TARGET_DIRECTORY unit_tests
      PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
  list(APPEND united unit_tests short_tests validation_tests)
endif()
if(MPMFAST_BENCH)
  set_target_properties(benchmarks PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/bench/transfers.cpp TARGET_DIRECTORY benchmarks
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  list(APPEND united benchmarks)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # An unnamed namespace of an included file belongs to the unit all the same.
  foreach(target mpmfast_state mpmfast_step mpmfast_conditions mpmfast_contact mpmfast_heat mpmfast_loads ${united})
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endforeach()
endif()
