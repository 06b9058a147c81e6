#include "source_folder.hpp"

namespace mpmfast::test {

std::filesystem::path source_folder() { return MPMFAST_SOURCE_DIR; }

}  // namespace mpmfast::test
