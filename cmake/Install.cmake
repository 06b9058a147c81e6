# What an installed mpmfast is made of, and the Debian package (cpack --preset package).
include(CMakePackageConfigHelpers)

install(TARGETS mpmfast RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS mpmfast_library EXPORT mpmfastTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(MPMFAST_PROGRAM_LIBRARY)
  install(TARGETS mpmfast_program LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_SKIP)
endif()
install(FILES engine/library/simulation.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mpmfast)
install(EXPORT mpmfastTargets NAMESPACE mpmfast:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mpmfast)
configure_package_config_file(cmake/mpmfastConfig.cmake.in ${PROJECT_BINARY_DIR}/generated/mpmfastConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mpmfast)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/mpmfastConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/mpmfastConfig.cmake
  ${PROJECT_BINARY_DIR}/generated/mpmfastConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/mpmfast)
install(FILES ${PROJECT_BINARY_DIR}/generated/mpmfast.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PROJECT_BINARY_DIR}/generated/mpmfast.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME mpmfast)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/mpmfast
  PATTERN "*.md" EXCLUDE PATTERN gallery EXCLUDE)
# The pages with all that they point to, where they find it.
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY bench/results DESTINATION ${CMAKE_INSTALL_DOCDIR}/bench)
install(DIRECTORY tools/manual tools/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/tools PATTERN __pycache__ EXCLUDE)
foreach(file tools/README.md tools/python/README.md engine/plan/plan.cpp engine/step/step.cpp
    kernels/contact/laws.hpp)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
if(MPMFAST_PYTHON)
  install(TARGETS mpmfast_python DESTINATION lib/python3/dist-packages/mpmfast)
  install(DIRECTORY tools/python/mpmfast DESTINATION lib/python3/dist-packages PATTERN __pycache__ EXCLUDE)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mpmfast)
set(CPACK_PACKAGE_CONTACT "the mpmfast developers <mpmfast@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
include(CPack)
