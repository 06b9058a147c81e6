#pragma once

/// @file Helpers of the tests: scenes in a few lines of YAML, steps without files, runs in a folder that is
/// removed.

#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/run/run.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "tests/sanitized.hpp"
#include "tests/source_folder.hpp"

namespace mpmfast::test {

Scene scene_from(const std::string& yaml, const std::vector<Override>& overrides = {});
Scene scene_file(const std::string& name, const std::vector<Override>& overrides = {});

/// The words of all bases.
std::vector<const char*> bases();
/// Of those that apic can use.
std::vector<const char*> apic_bases();

template <int Dim>
void advance(Step<Dim>& step, int steps);

/// Rows of a particle quantity in order of the ids, components side by side.
template <int Dim>
std::vector<double> by_id(const Particles<Dim>& particles, Quantity q);

/// max |a − b| / max |b|.
double relative_difference(const std::vector<double>& a, const std::vector<double>& b);

template <int Dim>
Vec<Dim> momentum(const Particles<Dim>& particles);
template <int Dim>
double kinetic_energy(const Particles<Dim>& particles);

/// A folder of its own for each test, removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  std::filesystem::path operator/(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

/// history.csv by column.
using History = std::map<std::string, std::vector<double>>;

History read_history(const std::filesystem::path& file);

/// Runs a scene and returns its history. A physical failure is returned in `failure`, with what was written
/// until then.
struct Outcome {
  RunSummary summary;
  History history;
  std::string failure;
};

Outcome run(const Scene& scene, int threads = 0);

}  // namespace mpmfast::test
