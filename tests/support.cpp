#include "tests/support.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "engine/errors.hpp"
#include "kernels/basis/facts.hpp"

namespace mpmfast::test {

Scene scene_from(const std::string& yaml, const std::vector<Override>& overrides) {
  return parse_scene(yaml, "test.yaml", overrides);
}

Scene scene_file(const std::string& name, const std::vector<Override>& overrides) {
  return read_scene(source_folder() / "configs" / name, overrides);
}

std::vector<const char*> bases() {
  std::vector<const char*> words;
  for (const BasisFacts& basis : kBasisFacts) words.push_back(basis.keyword);
  return words;
}

std::vector<const char*> apic_bases() {
  std::vector<const char*> words;
  for (const BasisFacts& basis : kBasisFacts)
    if (basis.spread > 0) words.push_back(basis.keyword);
  return words;
}

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return scale > 0 ? difference / scale : difference;
}

template <int Dim>
void advance(Step<Dim>& step, int steps) {
  for (int k = 0; k < steps; ++k) step.advance(step.stable_dt());
}
template void advance(Step<2>&, int);
template void advance(Step<3>&, int);

template <int Dim>
std::vector<double> by_id(const Particles<Dim>& particles, Quantity q) {
  const auto n = static_cast<std::size_t>(Particles<Dim>::components(q));
  std::vector<double> rows(n * particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (std::size_t k = 0; k < n; ++k)
      rows[particles.id()[p] * n + k] = particles.column(q, static_cast<int>(k))[p];
  return rows;
}
template std::vector<double> by_id(const Particles<2>&, Quantity);
template std::vector<double> by_id(const Particles<3>&, Quantity);

template <int Dim>
Vec<Dim> momentum(const Particles<Dim>& particles) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum += particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p);
  return sum;
}
template Vec<2> momentum(const Particles<2>&);
template Vec<3> momentum(const Particles<3>&);

template <int Dim>
double kinetic_energy(const Particles<Dim>& particles) {
  double sum = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    sum += 0.5 * particles.column(Quantity::mass)[p] * particles.vector(Quantity::velocity, p).squaredNorm();
  return sum;
}
template double kinetic_energy(const Particles<2>&);
template double kinetic_energy(const Particles<3>&);

Folder::Folder() {
  static int count = 0;
  path_ = std::filesystem::temp_directory_path() /
          ("mpmfast_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
  std::filesystem::create_directories(path_);
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path Folder::operator/(const std::string& name) const { return path_ / name; }

History read_history(const std::filesystem::path& file) {
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

Outcome run(const Scene& scene, int threads) {
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
