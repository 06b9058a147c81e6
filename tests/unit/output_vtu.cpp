#include <doctest/doctest.h>

#include <Eigen/LU>

#include <cmath>
#include <set>

#include "tests/unit/vtu_reader.hpp"

using namespace output_test;

TEST_CASE("a VTU file read back holds the particles in the order of their ids (2-D)") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  const std::size_t n = 60000;  // points take more than one block
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>(shuffled(n)), 1.25e-6);
  const Particles<2> particles = particles_in_order<2>(ascending(n));

  const Vtu file(folder.path() / "particles/000000.vtu");
  CHECK(file.text().find("header_type=\"UInt64\"") != std::string::npos);
  CHECK(file.text().find("NumberOfTuples=\"1\" format=\"ascii\">1.25e-06<") != std::string::npos);
  CHECK(attribute(file.tag("stress"), "NumberOfComponents") == "6");
  CHECK(attribute(file.tag("stress"), "ComponentName3") == "XY");
  CHECK(attribute(file.tag("deformation_gradient"), "NumberOfComponents") == "9");
  const auto points = file.array<double>("Points");
  const auto velocity = file.array<float>("velocity"), stress = file.array<float>("stress");
  const auto von_mises = file.array<float>("von_mises"), pressure = file.array<float>("pressure");
  const auto volume = file.array<float>("volume");
  const auto f = file.array<double>("deformation_gradient");
  const auto id = file.array<std::uint32_t>("id");
  const auto body = file.array<std::uint16_t>("body"), material = file.array<std::uint16_t>("material");
  REQUIRE(points.size() == 3 * n);
  REQUIRE(velocity.size() == 3 * n);
  REQUIRE(stress.size() == 6 * n);
  REQUIRE(f.size() == 9 * n);
  for (const std::size_t n_points :
       {von_mises.size(), pressure.size(), volume.size(), id.size(), body.size()})
    REQUIRE(n_points == n);
  bool same = true;
  for (std::size_t p = 0; p < n; ++p) {
    const double j = particles.deformation_gradient(p).determinant();
    std::array<double, 6> s{};
    for (int k = 0; k < 4; ++k)
      s[static_cast<std::size_t>(k)] = particles.column(Quantity::kirchhoff_stress, k)[p] / j;
    const double mean = (s[0] + s[1] + s[2]) / 3;
    double deviator = 2 * s[3] * s[3];
    for (std::size_t k = 0; k < 3; ++k) deviator += (s[k] - mean) * (s[k] - mean);
    const auto close = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); };
    same = same && id[p] == p && body[p] == p % 3 && material[p] == (p % 3 == 2 ? 1 : 0);
    for (int d = 0; d < 2; ++d) {
      const std::size_t k = 3 * p + static_cast<std::size_t>(d);
      same = same && points[k] == particles.column(Quantity::position, d)[p];
      same = same && velocity[k] == static_cast<float>(particles.column(Quantity::velocity, d)[p]);
    }
    for (std::size_t k = 0; k < 6; ++k) same = same && stress[6 * p + k] == static_cast<float>(s[k]);
    same = same && close(von_mises[p], std::sqrt(1.5 * deviator)) && close(pressure[p], -mean);
    same = same && close(volume[p], j * particles.column(Quantity::initial_volume)[p]);
    same = same && points[3 * p + 2] == 0 && f[9 * p + 8] == 1 && f[9 * p + 2] == 0;
    same = same && f[9 * p + 3] == particles.column(Quantity::deformation_gradient, 2)[p];
  }
  CHECK(same);
  const auto connectivity = file.array<std::int64_t>("connectivity"),
             offsets = file.array<std::int64_t>("offsets");
  CHECK(connectivity.back() == static_cast<std::int64_t>(n - 1));
  CHECK(offsets.front() == 1);
  CHECK(file.array<std::uint8_t>("types") == std::vector<std::uint8_t>(n, 1));
}

TEST_CASE("a VTU file read back holds all components in 3-D") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::three_dimensional);
  const Particles<3> particles = particles_in_order<3>(ascending(10));
  ParticleSeries<3> series(folder.path(), scene);
  series.append(particles, 0);
  const Vtu file(folder.path() / "particles/000000.vtu");
  const auto f = file.array<double>("deformation_gradient"), points = file.array<double>("Points");
  const auto stress = file.array<float>("stress");
  for (std::size_t p = 0; p < 10; ++p) {
    for (int k = 0; k < 9; ++k)
      CHECK(f[9 * p + static_cast<std::size_t>(k)] == particles.column(Quantity::deformation_gradient, k)[p]);
    CHECK(points[3 * p + 2] == particles.column(Quantity::position, 2)[p]);
    CHECK(stress[6 * p + 5] == static_cast<float>(particles.column(Quantity::kirchhoff_stress, 5)[p] /
                                                  particles.deformation_gradient(p).determinant()));
  }
}

TEST_CASE("the PVD file lists every frame after each of them, and no temporary file stays") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  for (int frame = 0; frame < 3; ++frame) {
    series.append(particles_in_order<2>(ascending(4)), 0.5 * frame);
    const std::string text = read_text(folder.path() / "particles.pvd");
    CHECK(text.rfind("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"", 0) == 0);
    CHECK(text.find("</Collection>\n</VTKFile>\n") == text.size() - 25);
    std::size_t found = 0;
    for (auto at = text.find("<DataSet "); at != std::string::npos; at = text.find("<DataSet ", at + 1)) {
      const std::string tag = text.substr(at, text.find("/>", at) - at);
      CHECK(std::stod(attribute(tag, "timestep")) == 0.5 * static_cast<double>(found));
      CHECK(std::filesystem::exists(folder.path() / attribute(tag, "file")));
      ++found;
    }
    CHECK(found == static_cast<std::size_t>(frame) + 1);
  }
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    names.insert(entry.path().filename().string());
  CHECK(names ==
        std::set<std::string>{"000000.vtu", "000001.vtu", "000002.vtu", "particles", "particles.pvd"});
}

TEST_CASE("a frame without particles is still a VTU file") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>({}), 0);
  const Vtu file(folder.path() / "particles/000000.vtu");
  CHECK(file.array<double>("Points").empty());
  CHECK(file.text().find("NumberOfPoints=\"0\"") != std::string::npos);
}
