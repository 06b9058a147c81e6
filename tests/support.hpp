#pragma once

/// @file Helpers of the tests: scenes in a few lines of YAML, steps without files, runs in a folder that is
/// removed.

#include <doctest/doctest.h>

#include <unistd.h>
#include <cmath>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "engine/errors.hpp"
#include "engine/run/run.hpp"
#include "engine/scene/read_scene.hpp"
#include "engine/step/step.hpp"
#include "kernels/basis/facts.hpp"
#include "tests/source_folder.hpp"

namespace mpmfast::test {

/// Do the sanitizers watch? Everything is some 20 times slower then, so long cases take fewer steps, or are
/// passed over where others run the same code.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

inline Scene scene_from(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  return parse_scene(yaml, "test.yaml", overrides);
}

inline Scene scene_file(const std::string& name, const std::vector<Override>& overrides = {}) {
  return read_scene(source_folder() / "configs" / name, overrides);
}

/// The words of all bases.
inline std::vector<const char*> bases() {
  std::vector<const char*> words;
  for (const BasisFacts& basis : kBasisFacts) words.push_back(basis.word);
  return words;
}

/// Of those that apic can use.
inline std::vector<const char*> apic_bases() {
  std::vector<const char*> words;
  for (const BasisFacts& basis : kBasisFacts)
    if (basis.spread > 0) words.push_back(basis.word);
  return words;
}

template <int Dim>
void advance(Step<Dim>& step, int steps) {
  for (int k = 0; k < steps; ++k) step.advance(step.stable_dt());
}

/// Rows of a particle quantity in order of the ids, components side by side.
template <int Dim>
std::vector<double> by_id(const Particles<Dim>& particles, Quantity q) {
  const auto n = static_cast<std::size_t>(Particles<Dim>::components(q));
  std::vector<double> rows(n * particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (std::size_t k = 0; k < n; ++k)
      rows[particles.id()[p] * n + k] = particles.column(q, static_cast<int>(k))[p];
  return rows;
}

/// max |a − b| / max |b|.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return scale > 0 ? difference / scale : difference;
}

template <int Dim>
Vec<Dim> momentum(const Particles<Dim>& particles) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum += particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p);
  return sum;
}

template <int Dim>
double kinetic_energy(const Particles<Dim>& particles) {
  double sum = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum += 0.5 * particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p).squaredNorm();
  return sum;
}

/// A folder of its own for each test, removed at the end.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("mpmfast_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// history.csv by column.
using History = std::map<std::string, std::vector<double>>;

inline History read_history(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line, cell;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  History history;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (const auto& name : names)
      if (std::getline(row, cell, ',')) history[name].push_back(std::stod(cell));
  }
  return history;
}

/// Runs a scene and returns its history. A physical failure is returned in `failure`, with what was written
/// until then.
struct Outcome {
  RunSummary summary;
  History history;
  std::string failure;
};

inline Outcome run(const Scene& scene, int threads = 0) {
  Folder folder;
  RunOptions options;
  options.folder = folder / "run";
  options.threads = threads;
  Outcome outcome;
  try {
    outcome.summary = run_scene(scene, options);
  } catch (const RunFailure& failure) {
    outcome.failure = failure.what();
  }
  outcome.history = read_history(options.folder / "history.csv");
  return outcome;
}

}  // namespace mpmfast::test
