#include <doctest/doctest.h>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "engine/errors.hpp"
#include "engine/output/read_vtu.hpp"
#include "engine/output/vtu.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

TEST_CASE("a VTU file read back holds the particles in the order of their ids (2-D)") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  const std::size_t n = 60000;  // points take more than one block
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>(shuffled(n)), 1.25e-6);
  const Particles<2> particles = particles_in_order<2>(ascending(n));

  const VtuReader file(folder.path() / "particles/000000.vtu");
  const std::string text = read_text(folder.path() / "particles/000000.vtu");
  CHECK(text.find("header_type=\"UInt64\"") != std::string::npos);
  CHECK(text.find("NumberOfTuples=\"1\" format=\"ascii\">1.25e-06<") != std::string::npos);
  CHECK(file.find("stress")->components == 6);
  CHECK(file.find("stress")->names[3] == "XY");
  CHECK(file.find("deformation_gradient")->components == 9);
  const auto points = file.read<double>("Points");
  const auto velocity = file.read<float>("velocity"), stress = file.read<float>("stress");
  const auto von_mises = file.read<float>("von_mises"), pressure = file.read<float>("pressure");
  const auto volume = file.read<float>("volume");
  const auto f = file.read<double>("deformation_gradient");
  const auto id = file.read<std::uint32_t>("id");
  const auto body = file.read<std::uint16_t>("body"), material = file.read<std::uint16_t>("material");
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
  const auto connectivity = file.read<std::int64_t>("connectivity"),
             offsets = file.read<std::int64_t>("offsets");
  CHECK(connectivity.back() == static_cast<std::int64_t>(n - 1));
  CHECK(offsets.front() == 1);
  CHECK(file.read<std::uint8_t>("types") == std::vector<std::uint8_t>(n, 1));
}

TEST_CASE("a VTU file read back holds all components in 3-D") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::three_dimensional);
  const Particles<3> particles = particles_in_order<3>(ascending(10));
  ParticleSeries<3> series(folder.path(), scene);
  series.append(particles, 0);
  const VtuReader file(folder.path() / "particles/000000.vtu");
  const auto f = file.read<double>("deformation_gradient"), points = file.read<double>("Points");
  const auto stress = file.read<float>("stress");
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
    const std::vector<SeriesFrame> frames = read_pvd(folder.path() / "particles.pvd");
    for (std::size_t k = 0; k < frames.size(); ++k) {
      CHECK(frames[k].time == 0.5 * static_cast<double>(k));
      CHECK(VtuReader(frames[k].file).time() == frames[k].time);
    }
    CHECK(frames.size() == static_cast<std::size_t>(frame) + 1);
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
  const VtuReader file(folder.path() / "particles/000000.vtu");
  CHECK(file.points().empty());
  CHECK(file.size() == 0);
}

namespace {

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// All that a file holds is read. @return what is wrong with it; empty where it is whole
std::string fault(const std::filesystem::path& path) {
  try {
    const VtuReader file(path);
    file.points();
    for (const VtuArray& array : file.point_data()) file.values(array);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("all arrays of a VTU file are read back, of every type and in blocks") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.vtu";
  const std::size_t n = 150000;  // more than one block of doubles
  std::vector<double> points(3 * n), wide(n);
  std::vector<float> pairs(2 * n);
  std::vector<std::uint16_t> whole(n);
  for (std::size_t i = 0; i < n; ++i) {
    points[3 * i] = std::sin(static_cast<double>(i));
    wide[i] = 1 / (1.0 + static_cast<double>(i));
    pairs[2 * i + 1] = static_cast<float>(wide[i]);
    whole[i] = static_cast<std::uint16_t>(i % 65536);
  }
  wide[7] = std::numeric_limits<double>::quiet_NaN();
  constexpr std::array<std::string_view, 2> kNames{"A", "B"};
  VtuFile out(points);
  out.add_point_data("wide", wide);
  out.add_point_data("pairs", pairs, kNames);
  out.add_point_data("whole", whole);
  out.write(path, -0.1);

  const VtuReader file(path);
  CHECK(file.time() == -0.1);
  CHECK(file.points() == points);
  REQUIRE(file.point_data().size() == 3);
  CHECK(file.point_data()[1].names == std::vector<std::string>{"A", "B"});
  CHECK(file.point_data()[1].components == 2);
  CHECK(file.read<float>("pairs") == pairs);
  CHECK(file.values(*file.find("pairs")) == std::vector<double>(pairs.begin(), pairs.end()));
  CHECK(file.read<std::uint16_t>("whole") == whole);
  const auto back = file.read<double>("wide");
  CHECK(std::isnan(back[7]));
  wide[7] = back[7] == back[7] ? 0 : 1;
  auto rest = back;
  rest[7] = wide[7];
  CHECK(rest == wide);
  CHECK(file.find("missing") == nullptr);
  CHECK_THROWS_WITH_AS(file.read<float>("wide"), doctest::Contains("no array 'wide' of Float32"), FileError);
}

TEST_CASE("a VTU file that was cut anywhere is refused by its name") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>(ascending(50)), 0);
  const std::string text = read_text(folder.path() / "particles/000000.vtu");
  const auto path = folder.path() / "cut.vtu";
  write_text(path, text);
  CHECK(fault(path) == "");
  for (std::size_t size = 0; size < text.size(); size += 100) {
    write_text(path, text.substr(0, size));
    const std::string why = fault(path);
    CHECK_MESSAGE(why.find("cut.vtu: ") != std::string::npos, size, why);
  }
  write_text(path, text.substr(0, text.size() - 1));
  CHECK(fault(path).find("cut short") != std::string::npos);
  CHECK(fault(folder.path() / "nowhere.vtu").find("no such file") != std::string::npos);
  CHECK(fault(folder.path()).find("no regular file") != std::string::npos);
}

TEST_CASE("a VTU file that was altered is refused or read, and no size in it is believed") {
  const TemporaryFolder folder;
  const Scene scene = small_scene(Space::plane_strain);
  ParticleSeries<2> series(folder.path(), scene);
  series.append(particles_in_order<2>(ascending(50)), 0);
  const std::string text = read_text(folder.path() / "particles/000000.vtu");
  const auto path = folder.path() / "altered.vtu";
  const auto refused = [&](const std::string& altered) {
    write_text(path, altered);
    const std::string why = fault(path);
    return why.find("altered.vtu: ") != std::string::npos;
  };
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string altered = text;
    REQUIRE(altered.find(from) != std::string::npos);
    return altered.replace(altered.find(from), from.size(), to);
  };
  CHECK(refused(replaced("NumberOfPoints=\"50\"", "NumberOfPoints=\"51\"")));
  CHECK(refused(replaced("NumberOfPoints=\"50\"", "NumberOfPoints=\"4000000000000000000\"")));
  CHECK(refused(replaced("NumberOfPoints=\"50\"", "NumberOfPoints=\"-1\"")));
  CHECK(refused(replaced("NumberOfComponents=\"6\"", "NumberOfComponents=\"99999999\"")));
  CHECK(refused(replaced("offset=\"0\"", "offset=\"18446744073709551615\"")));
  CHECK(refused(replaced("ascii\">0<", "ascii\">nan<")));
  CHECK(refused(replaced("</PointData>", "</PointDate>")));
  // Every word of the first array's table, all ones: a count, sizes and a packed size that there cannot be.
  const std::size_t data = text.find("\n_") + 2;
  for (std::size_t word = 0; word < 4; ++word)
    CHECK(refused(std::string(text).replace(data + 8 * word, 8, std::string(8, '\xff'))));
  // One bit anywhere else: whatever it meets, there is an answer.
  std::size_t found = 0;
  for (std::size_t at = data; at < text.size() - 32; at += 7) {
    std::string altered = text;
    altered[at] = static_cast<char>(altered[at] ^ (1 << at % 8));
    found += refused(altered) ? 1u : 0u;
  }
  CHECK(found > (text.size() - 32 - data) / 14);
}

TEST_CASE("an array of a type that no run writes is refused, whatever its values would take") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "types.vtu";
  VtuFile out(std::vector<double>{0, 0, 0, 1, 1, 1});
  out.add_point_data("bytes", std::vector<std::uint8_t>{3, 250});
  out.add_point_data("numbers", std::vector<double>{1, 2});
  out.write(path, 0);
  const std::string text = read_text(path);
  CHECK(VtuReader(path).values(*VtuReader(path).find("bytes")) == std::vector<double>{3, 250});
  for (const std::string known : {"UInt8", "Float64"})
    for (const std::string other : {"Int8", "UInt64", "Float16", "uint8", "String", "bit", ""}) {
      CAPTURE(known);
      CAPTURE(other);
      const std::string name = known == "UInt8" ? "bytes" : "numbers", type = "type=\"" + known + "\"";
      const std::size_t tag = text.rfind('<', text.find("Name=\"" + name)), at = text.find(type, tag);
      REQUIRE(at < text.find('>', tag));
      write_text(path, std::string(text).replace(at, type.size(), "type=\"" + other + "\""));
      CHECK(fault(path).find("an array of its PointData is not as a run writes it") != std::string::npos);
    }
}

TEST_CASE("components of a VTU array have a name each or none, and the file says which") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "names.vtu";
  VtuFile out(std::vector<double>{0, 0, 0});
  constexpr std::array<std::string_view, 2> kNames{"A", "B"};
  out.add_point_data("pair", std::vector<double>{1, 2}, kNames);
  out.write(path, 0);
  CHECK(fault(path) == "");
  const std::string text = read_text(path), second = "ComponentName1=\"B\"";
  const std::size_t at = text.find(second);
  REQUIRE(at != std::string::npos);
  for (const std::string replaced : {"ComponentName2=\"B\"", ""}) {  // of a third component; of none
    write_text(path, std::string(text).replace(at, second.size(), replaced));
    CHECK(fault(path).find("names.vtu: ") != std::string::npos);
  }
}

TEST_CASE("a PVD file that is none is refused") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "particles.pvd";
  for (const std::string text : {"", "<VTKFile", "<VTKFile type=\"ImageData\"></VTKFile>",
                                 "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"x\" "
                                 "file=\"a\"/></Collection></VTKFile>"}) {
    write_text(path, text);
    CHECK_THROWS_WITH_AS(read_pvd(path), doctest::Contains("particles.pvd: "), FileError);
  }
}
