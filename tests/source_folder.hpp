#pragma once

#include <filesystem>

namespace mpmfast::test {

/// The checkout that the tests were built from. It is compiled into one file, so that the others are the same
/// in every checkout and a compiler's cache serves them all.
std::filesystem::path source_folder();

}  // namespace mpmfast::test
