#pragma once

/// @file A few particles with telling values, in any order, and a folder that vanishes.

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "engine/output/output.hpp"

namespace output_test {

using namespace mpmfast;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mpmfast-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Two soft bodies and a rigid one, a wall.
inline Scene small_scene(Space space) {
  Scene scene;
  scene.title = "A small scene";
  scene.space = space;
  scene.grid = {{0, 0, 0}, {1, 1, 1}, 0.1};
  scene.materials = {{"soft", NeoHookean{1000, 1e6, 1e5}}, {"tool", Rigid{}}};
  for (const char* name : {"left", "right", "punch"}) {
    BodySpec body;
    body.name = name;
    body.material = body.name == "punch" ? 1 : 0;
    scene.bodies.push_back(body);
  }
  scene.boundaries = {{"floor", WallSpec{}}};
  scene.resolved_yaml = "title: A small scene\n";
  return scene;
}

/// Particles on a lattice; every value depends on the id alone. @param order the ids in the order of the
/// columns
template <int Dim>
Particles<Dim> particles_in_order(const std::vector<std::uint32_t>& order) {
  Particles<Dim> particles;
  particles.allocate(order.size(), {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                                    Quantity::kirchhoff_stress, Quantity::mass, Quantity::initial_volume});
  for (std::size_t p = 0; p < order.size(); ++p) {
    std::mt19937_64 random(order[p] + 1);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    particles.id()[p] = order[p];
    particles.body()[p] = static_cast<std::uint16_t>(order[p] % 3);
    for (const Quantity q : particles.quantities())
      for (int k = 0; k < Particles<Dim>::components(q); ++k) particles.column(q, k)[p] = uniform();
    for (int i = 0; i < Dim; ++i) particles.column(Quantity::deformation_gradient, (Dim + 1) * i)[p] += 1;
    for (int k = 0; k < kSymmetric<Dim>; ++k) particles.column(Quantity::kirchhoff_stress, k)[p] *= 1e6;
    particles.column(Quantity::initial_volume)[p] *= 1e-3;
  }
  return particles;
}

inline std::vector<std::uint32_t> ascending(std::size_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

inline std::vector<std::uint32_t> shuffled(std::size_t n) {
  std::vector<std::uint32_t> order = ascending(n);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(7));
  return order;
}

}  // namespace output_test
