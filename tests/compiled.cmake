# The tests, compiled here and linked with the engine of this build.
set_source_files_properties(source_folder.cpp PROPERTIES COMPILE_DEFINITIONS
  MPMFAST_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
add_library(test_main STATIC main.cpp sanitized.cpp source_folder.cpp)
target_link_libraries(test_main PUBLIC mpmfast_options fmt::fmt nlohmann_json::nlohmann_json)
target_include_directories(test_main SYSTEM PUBLIC ${DOCTEST_INCLUDE})
# A check is one function call: half the time that the tests take to compile. What a check throws ends its test case.
target_compile_definitions(test_main PUBLIC DOCTEST_CONFIG_SUPER_FAST_ASSERTS)
# With the fused products of the program, but sooner compiled.
target_compile_options(test_main PUBLIC $<$<CONFIG:Release>:-O1>)
# Helpers of what runs scenes and steps.
add_library(test_support STATIC support.cpp)
target_link_libraries(test_support PUBLIC test_main mpmfast_core mpmfast_scene mpmfast_output mpmfast_options)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Of some processors g++ 12 takes what its own AVX-512 header leaves undefined for an oversight (GCC bug 105593).
  set_source_files_properties(unit/delassus_operator.cpp PROPERTIES COMPILE_OPTIONS -Wno-maybe-uninitialized)
endif()
add_executable(unit_tests EXCLUDE_FROM_ALL ${UNIT_SOURCES} fuzz/entries.cpp fuzz/entry_study.cpp
  fuzz/entry_json.cpp fuzz/entry_table.cpp fuzz/entry_checkpoint.cpp)
target_link_libraries(unit_tests PRIVATE mpmfast_packing mpmfast_study mpmfast_report ZLIB::ZLIB)
target_include_directories(unit_tests PRIVATE ${PROJECT_BINARY_DIR}/generated)
target_include_directories(unit_tests SYSTEM PRIVATE ${HDF5_INCLUDE})
# Those of them that use threads, and short scenes, for the thread sanitizer (tools/test_threads).
file(GLOB THREAD_SOURCES CONFIGURE_DEPENDS unit/step_*.cpp unit/state_*.cpp unit/transfer_*.cpp unit/contact*.cpp
  unit/collect_clouds.cpp unit/two_pairs.cpp unit/run_resume.cpp validation/axisymmetric.cpp validation/pair_laws.cpp
  validation/plane_stress.cpp validation/shock.cpp stability/invariance.cpp stability/reproducible.cpp)
add_executable(thread_tests EXCLUDE_FROM_ALL ${THREAD_SOURCES})
add_executable(kernel_tests EXCLUDE_FROM_ALL ${KERNEL_SOURCES})
target_link_libraries(kernel_tests PRIVATE test_main mpmfast_options)
# The sums and windows of the transfers in single precision; no engine is linked, which has them in double.
add_executable(single_tests EXCLUDE_FROM_ALL unit/transfer_sums.cpp unit/transfer_window.cpp)
target_link_libraries(single_tests PRIVATE test_main mpmfast_options)
target_compile_definitions(single_tests PRIVATE MPMFAST_SINGLE_TRANSFERS)
set(LONG_SOURCES ${VALIDATION_SOURCES})
list(REMOVE_ITEM LONG_SOURCES ${SHORT_SOURCES})
add_executable(short_tests ${SHORT_SOURCES})
add_executable(validation_tests ${LONG_SOURCES})
target_link_libraries(validation_tests PRIVATE mpmfast_study)
foreach(program unit_tests thread_tests short_tests validation_tests)
  target_link_libraries(${program} PRIVATE test_support mpmfast_core mpmfast_scene mpmfast_output mpmfast_options
    fmt::fmt nlohmann_json::nlohmann_json)
  target_include_directories(${program} SYSTEM PRIVATE ${STB_INCLUDE})
endforeach()
# The shared library as other programs have it: only what its header declares is there.
add_executable(library_tests EXCLUDE_FROM_ALL library/simulation.cpp)
target_link_libraries(library_tests PRIVATE test_main mpmfast_library mpmfast_options)
# For a build whose engine the sanitizers watch (linked.cmake).
set(objects "")
foreach(target test_main test_support unit_tests short_tests library_tests)
  string(APPEND objects "set(objects_${target} \"$<TARGET_OBJECTS:${target}>\")\n")
endforeach()
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/test_objects.cmake CONTENT "${objects}")
