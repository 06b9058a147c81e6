# The commit that a build was made from, for --version and run.json; "unknown" outside a git checkout.
set(MPMFAST_GIT "unknown")
find_package(Git QUIET)
if(Git_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE MPMFAST_GIT_OUT
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE MPMFAST_GIT_RESULT)
  if(MPMFAST_GIT_RESULT EQUAL 0)
    set(MPMFAST_GIT "${MPMFAST_GIT_OUT}")
  endif()
  # A new commit configures again: a study keeps only results of the same commit.
  execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --git-path logs/HEAD
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE MPMFAST_GIT_LOG
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  get_filename_component(MPMFAST_GIT_LOG "${MPMFAST_GIT_LOG}" ABSOLUTE BASE_DIR ${PROJECT_SOURCE_DIR})
  if(EXISTS "${MPMFAST_GIT_LOG}" AND NOT IS_DIRECTORY "${MPMFAST_GIT_LOG}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${MPMFAST_GIT_LOG}")
  endif()
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" MPMFAST_BUILD_UPPER)
set(MPMFAST_FLAGS "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${MPMFAST_BUILD_UPPER}}")
if(MPMFAST_ARCH_FLAG)
  string(APPEND MPMFAST_FLAGS " ${MPMFAST_ARCH_FLAG}")
endif()
if(MPMFAST_SINGLE)
  string(APPEND MPMFAST_FLAGS " -DMPMFAST_SINGLE_TRANSFERS")
endif()
string(STRIP "${MPMFAST_FLAGS}" MPMFAST_FLAGS)
configure_file(${PROJECT_SOURCE_DIR}/cmake/version.hpp.in ${PROJECT_BINARY_DIR}/generated/mpmfast_version.hpp @ONLY)
