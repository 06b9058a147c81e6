#pragma once

/// @file A tiny scene on disk and studies of it.

#include <fmt/format.h>

#include "tests/unit/output_fixture.hpp"
#include "tools/study/study_results.hpp"

namespace study_test {

using namespace mpmfast;

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// A folder with a scene of one free block, 2 x 2 cells, and whatever study the test asks for.
class StudyFolder {
 public:
  StudyFolder() {
    write_text(path() / "scene.yaml",
               "space: plane_strain\n"
               "grid: {size: [10 mm, 10 mm], cell: 1 mm}\n"
               "time: {end: 20 us}\n"
               "materials:\n"
               "  rubber: {model: linear_elastic, density: 1 g/cm^3, young: 10 MPa, poisson: 0.3}\n"
               "bodies:\n"
               "  - {name: block, box: {from: [4 mm, 4 mm], to: [6 mm, 6 mm]}, material: rubber}\n");
  }
  const std::filesystem::path& path() const { return folder_.path(); }

  Study study(const std::string& text) const { return parse_study(text, path() / "study.yaml"); }

  /// What reading and expanding the study complains of, "LINE: path: message. hint" each.
  std::vector<std::string> faults(const std::string& text) const {
    std::vector<std::string> out;
    try {
      expand_study(study(text));
    } catch (const SceneError& error) {
      for (const Diagnostic& fault : error.diagnostics())
        out.push_back(fmt::format("{}: {}: {}{}{}", fault.line, fault.path, fault.message,
                                  fault.hint.empty() ? "" : ". ", fault.hint));
    }
    return out;
  }

 private:
  output_test::TemporaryFolder folder_;
};

inline std::vector<std::string> names_of(const std::vector<StudyRun>& runs) {
  std::vector<std::string> out;
  for (const StudyRun& run : runs) out.push_back(run.name);
  return out;
}

}  // namespace study_test
