#include <string>

#include "engine/errors.hpp"
#include "entries.hpp"
#include "tests/source_folder.hpp"
#include "tools/study/study.hpp"

namespace mpmfast::fuzz {

void read_study_bytes(Bytes bytes) {
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    parse_study(text, test::source_folder() / "configs/studies/study.yaml");
  } catch (const SceneError& error) {
    if (error.diagnostics().empty()) throw std::logic_error("refused without a reason");
  }
}

}  // namespace mpmfast::fuzz
