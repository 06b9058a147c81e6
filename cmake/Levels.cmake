# The instruction set, and the others that a build for any machine has beside it: the engine with its widest vectors.
#
# Library and program are built whole once more for each level, in builds of their own under glibc-hwcaps/, where the
# loader looks first (ld.so(8)); of a machine's levels it takes the highest. Installed, they lie in the same way beside the
# libraries for every machine. So that the program comes from there, it is a library too, and bin/mpmfast calls it.
set(MPMFAST_ARCH_FLAG "")
if(MPMFAST_ARCH)
  set(MPMFAST_ARCH_FLAG -march=${MPMFAST_ARCH})
elseif(MPMFAST_NATIVE)
  set(MPMFAST_ARCH_FLAG -march=native)
endif()

if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(MPMFAST_LEVELS "")
endif()
if(MPMFAST_LEVELS)
  set(MPMFAST_PROGRAM_LIBRARY ON)
endif()

set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
foreach(level ${MPMFAST_LEVELS})
  include(ExternalProject)
  set(folder ${PROJECT_BINARY_DIR}/glibc-hwcaps/${level})
  ExternalProject_Add(level_${level} SOURCE_DIR ${PROJECT_SOURCE_DIR} BINARY_DIR ${folder} PREFIX ${folder}/steps
    CMAKE_CACHE_ARGS -DMPMFAST_ARCH:STRING=${level} -DMPMFAST_PROGRAM_LIBRARY:BOOL=ON -DMPMFAST_LEVELS:STRING=
      -DMPMFAST_TESTS:BOOL=OFF -DMPMFAST_BENCH:BOOL=OFF -DMPMFAST_PRECOMPILE:BOOL=ON
      -DMPMFAST_WERROR:BOOL=${MPMFAST_WERROR} -DMPMFAST_SINGLE:BOOL=${MPMFAST_SINGLE}
      -DCMAKE_BUILD_TYPE:STRING=${CMAKE_BUILD_TYPE} -DCMAKE_CXX_COMPILER:STRING=${CMAKE_CXX_COMPILER}
      -DCMAKE_CXX_FLAGS:STRING=${CMAKE_CXX_FLAGS} -DCMAKE_SHARED_LINKER_FLAGS:STRING=-s
    BUILD_COMMAND ${CMAKE_COMMAND} --build <BINARY_DIR> --target mpmfast_library mpmfast_program
    BUILD_ALWAYS ON USES_TERMINAL_BUILD ON INSTALL_COMMAND "")
  foreach(library mpmfast mpmfast_program)
    install(FILES ${folder}/lib${library}.so.${PROJECT_VERSION} ${folder}/lib${library}.so.${soversion}
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${level})
  endforeach()
endforeach()
