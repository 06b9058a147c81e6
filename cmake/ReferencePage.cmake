# The page of all keys, whose prose is Markdown, as C++ text for `mpmfast schema --markdown`.
set(page ${PROJECT_SOURCE_DIR}/engine/scene/schema/reference_page.md.in)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page})
file(READ ${page} REFERENCE_PAGE)
configure_file(${PROJECT_SOURCE_DIR}/cmake/reference_page.hpp.in ${PROJECT_BINARY_DIR}/generated/reference_page.hpp @ONLY)
