# The passes of each basis of kernels/basis/bases.hpp, in each dimension, are compiled in a file of their own:
# BASIS_SOURCES.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/basis/bases.hpp)
file(READ ${PROJECT_SOURCE_DIR}/kernels/basis/bases.hpp text)
string(REGEX MATCHALL "[ \n]basis\\( *[A-Za-z0-9_]+ *," entries "${text}")
set(BASIS_SOURCES "")
foreach(entry ${entries})
  string(REGEX REPLACE ".*\\( *([A-Za-z0-9_]+) *," "\\1" BASIS "${entry}")
  foreach(DIMENSION 2 3)
    set(source ${PROJECT_BINARY_DIR}/generated/passes_${BASIS}_${DIMENSION}d.cpp)
    configure_file(${PROJECT_SOURCE_DIR}/engine/step/passes_of.cpp.in ${source} @ONLY)
    list(APPEND BASIS_SOURCES ${source})
  endforeach()
endforeach()
