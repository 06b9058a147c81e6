# The scenes of configs/starters/ as C++ text, for `mpmfast new`; the first is the default.
set(STARTERS "")
foreach(name impact press sphere3d axisymmetric soil)
  set(starter ${PROJECT_SOURCE_DIR}/configs/starters/${name}.yaml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${starter})
  file(READ ${starter} text)
  string(APPEND STARTERS "    {\"${name}\", R\"scene(${text})scene\"},\n")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/cmake/starters.hpp.in ${PROJECT_BINARY_DIR}/generated/starters.hpp @ONLY)
