// What files and histories say of particles, against plain sums and formulas over random ones.

#include <doctest/doctest.h>
#include <zlib.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "engine/output/particle_access.hpp"
#include "engine/output/read_frame.hpp"
#include "engine/output/read_vtu.hpp"
#include "tests/random.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;
using mpmfast::test::Random;

namespace {

/// Every column with random values, ids in any order: 0 … n − 1, or with gaps.
template <int Dim>
Particles<Dim> random_particles(unsigned seed, std::size_t n, std::vector<Quantity> quantities,
                                bool gaps = false) {
  Random random(seed);
  Particles<Dim> particles;
  particles.allocate(n, quantities);
  std::vector<std::uint32_t> ids = ascending(n);
  for (std::size_t k = n; k > 1; --k) std::swap(ids[k - 1], ids[random.below(k)]);
  for (std::size_t p = 0; p < n; ++p) {
    particles.id()[p] = gaps ? 3 * ids[p] + 5 : ids[p];
    particles.body()[p] = static_cast<std::uint16_t>(random.below(3));
    for (const Quantity q : quantities)
      for (int k = 0; k < Particles<Dim>::components(q); ++k) particles.column(q, k)[p] = random.in(-1, 1);
    for (const Quantity q : {Quantity::mass, Quantity::initial_volume, Quantity::volume_ratio,
                             Quantity::out_of_plane_stretch, Quantity::domain_share, Quantity::temperature})
      if (particles.has(q))
        for (int k = 0; k < Particles<Dim>::components(q); ++k)
          particles.column(q, k)[p] = random.in(0.5, 1.5);
    if (particles.has(Quantity::deformation_gradient))
      for (int i = 0; i < Dim; ++i) particles.column(Quantity::deformation_gradient, (Dim + 1) * i)[p] += 3;
    if (particles.has(Quantity::kirchhoff_stress))
      for (int k = 0; k < kSymmetric<Dim>; ++k) particles.column(Quantity::kirchhoff_stress, k)[p] *= 1e5;
  }
  return particles;
}

const std::vector<Quantity> kUsual{
    Quantity::position,         Quantity::velocity, Quantity::deformation_gradient,
    Quantity::kirchhoff_stress, Quantity::mass,     Quantity::initial_volume};

std::vector<Quantity> usual_and(std::initializer_list<Quantity> more) {
  std::vector<Quantity> out = kUsual;
  out.insert(out.end(), more);
  return out;
}

/// J, from the columns as they are.
template <int Dim>
double ratio_of(const Particles<Dim>& particles, std::size_t p) {
  if (particles.has(Quantity::volume_ratio)) return particles.column(Quantity::volume_ratio)[p];
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) f(i, j) = particles.column(Quantity::deformation_gradient, Dim * i + j)[p];
  if (particles.has(Quantity::out_of_plane_stretch))
    f(2, 2) = particles.column(Quantity::out_of_plane_stretch)[p];
  return f.determinant();
}

/// Cauchy's stress as a matrix.
template <int Dim>
Eigen::Matrix3d stress_of(const Particles<Dim>& particles, std::size_t p) {
  constexpr std::array<std::array<int, 2>, 6> kEntries{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  for (int k = 0; k < kSymmetric<Dim>; ++k) {
    const auto [i, j] = kEntries[static_cast<std::size_t>(k)];
    stress(i, j) = stress(j, i) = particles.column(Quantity::kirchhoff_stress, k)[p] / ratio_of(particles, p);
  }
  return stress;
}

double von_mises_of(const Eigen::Matrix3d& stress) {
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5 * deviator.squaredNorm());
}

bool is_close(double a, double b, double size) {
  return std::abs(a - b) <= 1e-12 * std::max(std::abs(b), size);
}

Scene scene_in(int dimension) {
  Scene scene = small_scene(dimension == 2 ? Space::plane_strain : Space::three_dimensional);
  scene.materials.insert(scene.materials.begin(), {"hard", NeoHookean{1000, 1e9, 1e8}});
  scene.bodies[0].material = 1;  // soft; the second is hard, the third rigid
  scene.bodies[1].material = 0;
  scene.bodies[2].material = 2;
  scene.bodies[1].particles_per_cell = {1, 3, 2};
  return scene;
}

template <int Dim>
void check_fields(const Particles<Dim>& particles) {
  const Scene scene = scene_in(Dim);
  const auto check = [&](const std::string& field, const std::string& label, const std::string& unit,
                         bool of_rigid, auto value) {
    CAPTURE(field);
    const FieldValues values = field_values(particles, scene, field);
    CHECK(values.label == label);
    CHECK(values.unit == unit);
    CHECK(values.names == unit.empty());
    bool same = values.value.size() == particles.size();
    for (std::size_t p = 0; p < particles.size() && same; ++p)
      same = particles.body()[p] == 2 && !of_rigid ? std::isnan(values.value[p])
                                                   : is_close(values.value[p], value(p), 1);
    CHECK(same);
  };
  check("pressure", "pressure", "Pa", false,
        [&](std::size_t p) { return -stress_of(particles, p).trace() / 3; });
  check("von_mises", "von Mises stress", "Pa", false,
        [&](std::size_t p) { return von_mises_of(stress_of(particles, p)); });
  check("stress_difference", "stress difference in the plane", "Pa", false, [&](std::size_t p) {
    const Eigen::Matrix3d stress = stress_of(particles, p);
    const double angle = 0.5 * std::atan2(2 * stress(0, 1), stress(0, 0) - stress(1, 1));
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0), across(-along[1], along[0], 0);
    return along.dot(stress * along) - across.dot(stress * across);
  });
  const std::string axes = "xyz";
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const std::string name{axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(j)]};
      check("stress_" + name, "stress " + name, "Pa", false,
            [&](std::size_t p) { return stress_of(particles, p)(i, j); });
    }
  check("speed", "speed", "m/s", true, [&](std::size_t p) {
    double sum = 0;
    for (int d = 0; d < Dim; ++d) sum += std::pow(particles.column(Quantity::velocity, d)[p], 2);
    return std::sqrt(sum);
  });
  for (int d = 0; d < Dim; ++d) {
    const std::string axis(1, axes[static_cast<std::size_t>(d)]);
    check("velocity_" + axis, "velocity along " + axis, "m/s", true,
          [&](std::size_t p) { return particles.column(Quantity::velocity, d)[p]; });
  }
  check("volume_ratio", "volume over initial volume", "-", false,
        [&](std::size_t p) { return ratio_of(particles, p); });
  check("plastic_strain", "plastic strain", "-", false,
        [&](std::size_t p) { return particles.column(Quantity::plastic_strain)[p]; });
  check("temperature", "temperature", "K", false,
        [&](std::size_t p) { return particles.column(Quantity::temperature)[p]; });
  check("body", "body", "", true, [&](std::size_t p) { return static_cast<double>(particles.body()[p]); });
  check("material", "material", "", true, [&](std::size_t p) {
    return std::array{1.0, 0.0, 2.0}[particles.body()[p]];
  });
}

TEST_CASE("a field's values are what its name says of the columns, in the plane and in space") {
  const auto more = {Quantity::plastic_strain, Quantity::temperature};
  check_fields(random_particles<2>(1, 60, usual_and(more)));
  check_fields(random_particles<2>(
      2, 60, usual_and({Quantity::plastic_strain, Quantity::temperature, Quantity::out_of_plane_stretch})));
  check_fields(random_particles<3>(3, 60, usual_and(more)));
  check_fields(random_particles<3>(
      4, 60, usual_and({Quantity::plastic_strain, Quantity::temperature, Quantity::volume_ratio})));
}

TEST_CASE("fields have their names, those of space more than those of the plane") {
  CHECK(field_names(2) == std::vector<std::string>{"pressure", "von_mises", "stress_difference", "stress_xx",
                                                   "stress_yy", "stress_zz", "stress_xy", "speed",
                                                   "velocity_x", "velocity_y", "volume_ratio",
                                                   "plastic_strain", "temperature", "body", "material"});
  CHECK(field_names(3) == std::vector<std::string>{"pressure", "von_mises", "stress_difference", "stress_xx",
                                                   "stress_yy", "stress_zz", "stress_xy", "stress_yz",
                                                   "stress_xz", "speed", "velocity_x", "velocity_y",
                                                   "velocity_z", "volume_ratio", "plastic_strain",
                                                   "temperature", "body", "material"});
}

TEST_CASE("particles come in the order of their numbers, with gaps between them and without") {
  for (const bool gaps : {false, true})
    for (const std::size_t n : {0, 1, 2, 77}) {
      const Particles<2> particles = random_particles<2>(5, n, {Quantity::position}, gaps);
      const std::vector<std::uint32_t> order = order_by_id(particles);
      REQUIRE(order.size() == n);
      for (std::size_t k = 0; k < n; ++k) CHECK(particles.id()[order[k]] == (gaps ? 3 * k + 5 : k));
    }
}

template <int Dim>
void check_sums(const Particles<Dim>& particles) {
  const Scene scene = scene_in(Dim);
  HistoryRow row;
  fill_particle_sums(particles, scene, row);
  REQUIRE(row.bodies.size() == 3);
  double kinetic = 0, volume_of_all = 0;
  std::array<double, 3> momentum_of_all{};
  std::array<double, 6> stress_of_all{};
  const double count = static_cast<double>(particles.size());
  for (std::size_t b = 0; b < 3; ++b) {
    double mass = 0, volume = 0, warmth = 0;
    std::array<double, 3> moment{}, momentum{};
    std::array<double, 6> stress{};
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles.body()[p] != b) continue;
      const double m = particles.column(Quantity::mass)[p];
      mass += m;
      if (particles.has(Quantity::temperature)) warmth += m * particles.column(Quantity::temperature)[p];
      for (int d = 0; d < Dim; ++d) {
        const double v = particles.column(Quantity::velocity, d)[p];
        moment[static_cast<std::size_t>(d)] += m * particles.column(Quantity::position, d)[p];
        momentum[static_cast<std::size_t>(d)] += m * v;
        if (b != 2) kinetic += 0.5 * m * v * v;
      }
      if (b == 2) continue;
      volume += ratio_of(particles, p) * particles.column(Quantity::initial_volume)[p];
      for (int k = 0; k < kSymmetric<Dim>; ++k)
        stress[static_cast<std::size_t>(k)] += particles.column(Quantity::initial_volume)[p] *
                                               particles.column(Quantity::kirchhoff_stress, k)[p];
    }
    const HistoryRow::Body& body = row.bodies[b];
    CHECK(is_close(body.mass, mass, 0));
    if (particles.has(Quantity::temperature_slope)) CHECK(is_close(body.temperature, warmth / mass, 1));
    if (!particles.has(Quantity::temperature_slope)) CHECK(body.temperature == 0);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(is_close(body.position[k], moment[k] / mass, 1));
      CHECK(is_close(body.velocity[k], momentum[k] / mass, 1));
      if (b != 2) momentum_of_all[k] += momentum[k];
    }
    for (std::size_t k = 0; k < 6; ++k) {
      CHECK(is_close(body.mean_stress[k], b == 2 ? 0 : stress[k] / volume, 1e5));
      stress_of_all[k] += stress[k];
    }
    volume_of_all += volume;
  }
  CHECK(is_close(row.kinetic, kinetic, 0));
  for (std::size_t k = 0; k < 3; ++k) CHECK(is_close(row.momentum[k], momentum_of_all[k], count));
  for (std::size_t k = 0; k < 6; ++k)
    CHECK(is_close(row.mean_stress[k], stress_of_all[k] / volume_of_all, 1e5));
}

TEST_CASE("the row of a history has the sums over the particles of each body, and of all that deform") {
  check_sums(random_particles<2>(6, 90, kUsual));
  check_sums(random_particles<2>(
      7, 90, usual_and({Quantity::temperature, Quantity::temperature_slope, Quantity::out_of_plane_stretch}),
      true));
  check_sums(random_particles<3>(8, 90, usual_and({Quantity::temperature, Quantity::temperature_slope})));
  check_sums(random_particles<3>(9, 90, usual_and({Quantity::temperature, Quantity::volume_ratio}), true));
}

template <int Dim>
void check_spacing(const Particles<Dim>& particles) {
  const Scene scene = scene_in(Dim);
  double widest = 0;
  std::uint64_t where = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (int d = 0; d < Dim && particles.body()[p] != 2; ++d) {
      double square = 0;
      for (int i = 0; i < Dim; ++i)
        square += std::pow(particles.column(Quantity::deformation_gradient, Dim * i + d)[p], 2);
      const double share =
          particles.has(Quantity::domain_share) ? particles.column(Quantity::domain_share, d)[p] : 1;
      const double cells = std::sqrt(square) * share /
                           scene.bodies[particles.body()[p]].particles_per_cell[static_cast<std::size_t>(d)];
      if (cells <= widest) continue;
      widest = cells;
      where = particles.body()[p];
    }
  const Spacing spacing = widest_spacing(particles, scene);
  CHECK(spacing.cells == doctest::Approx(widest).epsilon(1e-12));
  CHECK(spacing.body == where);
}

TEST_CASE("the widest spacing is the longest edge of any domain that deforms, in cells") {
  for (unsigned seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    check_spacing(random_particles<2>(seed, 4, kUsual));
    check_spacing(random_particles<2>(seed, 4, usual_and({Quantity::domain_share})));
    check_spacing(random_particles<3>(seed, 4, usual_and({Quantity::domain_share})));
  }
  CHECK(widest_spacing(random_particles<2>(1, 4, {Quantity::position}), scene_in(2)).cells == 0);
}

/// An array of a VTU file as another program finds it.
struct Array {
  std::string type;
  std::size_t components = 1;
  std::vector<std::string> names = {};
  std::string tuples = "";
  std::vector<double> values = {};
};

std::string attribute_of(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + name.size() + 3;
  return tag.substr(begin, tag.find('"', begin) - begin);
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  REQUIRE(at + sizeof(T) <= bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <class T>
std::vector<double> numbers_in(const std::string& bytes) {
  std::vector<double> out;
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(T))
    out.push_back(static_cast<double>(number_at<T>(bytes, at)));
  return out;
}

/// All arrays of a file, and what it says without them.
struct File {
  std::map<std::string, Array> arrays;
  std::vector<std::string> order;
  std::string frame;
};

File parse_vtu(const std::filesystem::path& path) {
  const std::string text = read_text(path), mark = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t data = text.find(mark) + mark.size();
  REQUIRE(data > mark.size());
  const std::string header = text.substr(0, data);
  File file;
  for (std::size_t at = 0; at < header.size();) {
    const std::size_t tag_at = header.find("<DataArray", at);
    file.frame += header.substr(at, tag_at == std::string::npos ? tag_at : tag_at - at);
    if (tag_at == std::string::npos) break;
    const std::size_t end = header.find('>', tag_at);
    const std::string tag = header.substr(tag_at, end + 1 - tag_at), offset = attribute_of(tag, "offset");
    at = end + 1;
    if (offset.empty()) {  // the time
      file.frame += tag;
      continue;
    }
    CHECK(attribute_of(tag, "format") == "appended");
    Array array;
    array.type = attribute_of(tag, "type");
    array.tuples = attribute_of(tag, "NumberOfTuples");
    const std::string components = attribute_of(tag, "NumberOfComponents");
    if (!components.empty()) array.components = std::stoul(components);
    for (std::size_t k = 0; k < 10; ++k)
      if (const std::string name = attribute_of(tag, "ComponentName" + std::to_string(k)); !name.empty())
        array.names.push_back(name);
    const std::size_t begin = data + std::stoul(offset);
    const auto blocks = number_at<std::uint64_t>(text, begin),
               whole = number_at<std::uint64_t>(text, begin + 8),
               last = number_at<std::uint64_t>(text, begin + 16);
    CHECK(whole == 1048576);
    std::size_t packed_at = begin + 24 + 8 * blocks;
    std::string bytes;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const auto packed = number_at<std::uint64_t>(text, begin + 24 + 8 * b);
      std::string block(b + 1 == blocks && last != 0 ? last : whole, '\0');
      uLongf size = block.size();
      REQUIRE(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                         reinterpret_cast<const Bytef*>(text.data() + packed_at), packed) == Z_OK);
      CHECK(size == block.size());
      packed_at += packed;
      bytes += block;
    }
    if (array.type == "Float64") array.values = numbers_in<double>(bytes);
    if (array.type == "Float32") array.values = numbers_in<float>(bytes);
    if (array.type == "UInt32") array.values = numbers_in<std::uint32_t>(bytes);
    if (array.type == "UInt16") array.values = numbers_in<std::uint16_t>(bytes);
    if (array.type == "UInt8") array.values = numbers_in<std::uint8_t>(bytes);
    if (array.type == "Int64") array.values = numbers_in<std::int64_t>(bytes);
    const std::string name = attribute_of(tag, "Name");
    file.order.push_back(name);
    file.arrays[name] = array;
  }
  return file;
}

/// What a file of particles has to hold: by name, in the order of the numbers.
template <int Dim>
std::map<std::string, Array> expected_arrays(const Particles<Dim>& particles, const Scene& scene,
                                             const std::vector<std::uint32_t>& order) {
  std::map<std::string, Array> out;
  const auto add = [&](const std::string& name, const std::string& type,
                       const std::vector<std::string>& names, auto values_of) {
    Array array{type, std::max<std::size_t>(names.size(), 1), names, "", {}};
    for (const std::uint32_t p : order)
      for (const double value : values_of(p))
        array.values.push_back(type == "Float32" ? static_cast<float>(value) : value);
    out[name] = array;
  };
  using Values = std::vector<double>;
  const auto vector_of = [&](Quantity q, std::size_t p, double beyond) {
    Values values(3, beyond);
    for (int d = 0; d < Dim; ++d) values[static_cast<std::size_t>(d)] = particles.column(q, d)[p];
    return values;
  };
  const std::vector<std::string> xyz{"X", "Y", "Z"};
  add("id", "UInt32", {}, [&](std::size_t p) { return Values{static_cast<double>(particles.id()[p])}; });
  add("body", "UInt16", {}, [&](std::size_t p) { return Values{static_cast<double>(particles.body()[p])}; });
  add("material", "UInt16", {},
      [&](std::size_t p) { return Values{static_cast<double>(scene.bodies[particles.body()[p]].material)}; });
  add("Points", "Float64", xyz, [&](std::size_t p) { return vector_of(Quantity::position, p, 0); });
  out["Points"].names.clear();
  if (particles.has(Quantity::velocity))
    add("velocity", "Float32", xyz, [&](std::size_t p) { return vector_of(Quantity::velocity, p, 0); });
  if (particles.has(Quantity::kirchhoff_stress)) {
    add("stress", "Float32", {"XX", "YY", "ZZ", "XY", "YZ", "XZ"}, [&](std::size_t p) {
      const Eigen::Matrix3d s = stress_of(particles, p);
      return Values{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
    });
    add("von_mises", "Float32", {},
        [&](std::size_t p) { return Values{von_mises_of(stress_of(particles, p))}; });
    add("pressure", "Float32", {},
        [&](std::size_t p) { return Values{-stress_of(particles, p).trace() / 3}; });
  }
  if (particles.has(Quantity::deformation_gradient))
    add("deformation_gradient", "Float64", {"XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"},
        [&](std::size_t p) {
          Values f(9);
          f[8] = particles.has(Quantity::out_of_plane_stretch)
                     ? particles.column(Quantity::out_of_plane_stretch)[p]
                     : 1;
          for (int i = 0; i < Dim; ++i)
            for (int j = 0; j < Dim; ++j)
              f[static_cast<std::size_t>(3 * i + j)] =
                  particles.column(Quantity::deformation_gradient, Dim * i + j)[p];
          return f;
        });
  if (particles.has(Quantity::initial_volume))
    add("volume", "Float32", {}, [&](std::size_t p) {
      const double j = particles.has(Quantity::deformation_gradient) ? ratio_of(particles, p) : 1;
      return Values{particles.column(Quantity::initial_volume)[p] * j};
    });
  if (particles.has(Quantity::domain_share))
    add("domain_share", "Float32", xyz,
        [&](std::size_t p) { return vector_of(Quantity::domain_share, p, 1); });
  if (particles.has(Quantity::volume_ratio))
    add("volume_ratio", "Float64", {},
        [&](std::size_t p) { return Values{particles.column(Quantity::volume_ratio)[p]}; });
  for (const auto& [quantity, name] : {std::pair(Quantity::dissipated_energy, "dissipated_energy"),
                                       std::pair(Quantity::internal_energy, "internal_energy"),
                                       std::pair(Quantity::plastic_strain, "plastic_strain"),
                                       std::pair(Quantity::temperature, "temperature")})
    if (particles.has(quantity))
      add(name, "Float32", {}, [&, q = quantity](std::size_t p) { return Values{particles.column(q)[p]}; });
  Array &connectivity = out["connectivity"] = {"Int64"}, &offsets = out["offsets"] = {"Int64"},
        &types = out["types"] = {"UInt8"};
  for (std::size_t k = 0; k < order.size(); ++k) {
    connectivity.values.push_back(static_cast<double>(k));
    offsets.values.push_back(static_cast<double>(k + 1));
    types.values.push_back(1);
  }
  return out;
}

void check_arrays(const File& file, const std::map<std::string, Array>& expected) {
  CHECK(file.arrays.size() == expected.size());
  for (const auto& [name, array] : expected) {
    CAPTURE(name);
    const auto found = file.arrays.find(name);
    REQUIRE(found != file.arrays.end());
    CHECK(found->second.type == array.type);
    CHECK(found->second.components == array.components);
    CHECK(found->second.names == array.names);
    CHECK(found->second.tuples == array.tuples);
    REQUIRE(found->second.values.size() == array.values.size());
    double worst = 0;
    for (std::size_t k = 0; k < array.values.size(); ++k) {
      const double a = found->second.values[k], b = array.values[k];
      worst = std::max(worst, std::abs(a - b) / std::max(std::abs(b), 1e-3));
    }
    // Numbers in single precision may be rounded from either side.
    CHECK(worst <= (array.type == "Float32" ? 1.5e-7 : 0));
  }
}

template <int Dim>
void check_series(unsigned seed, std::size_t n, const std::vector<Quantity>& quantities, bool gaps) {
  const TemporaryFolder folder;
  const Scene scene = scene_in(Dim);
  const Particles<Dim> particles = random_particles<Dim>(seed, n, quantities, gaps);
  ParticleSeries<Dim> series(folder.path(), scene);
  series.append(particles, 0.25);
  std::vector<std::uint32_t> order = ascending(n);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return particles.id()[a] < particles.id()[b]; });
  const auto path = folder.path() / "particles/000000.vtu";
  const File file = parse_vtu(path);
  const std::string count = std::to_string(n);
  CHECK(file.frame.find("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">") != std::string::npos);
  CHECK(file.frame.find("<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                        "format=\"ascii\">0.25</DataArray>") != std::string::npos);
  CHECK(file.frame.find("<Piece NumberOfPoints=\"" + count + "\" NumberOfCells=\"" + count + "\">") !=
        std::string::npos);
  check_arrays(file, expected_arrays(particles, scene, order));

  // The engine's own reader has the same numbers.
  const VtuReader reader(path);
  CHECK(reader.time() == 0.25);
  CHECK(reader.size() == n);
  for (const auto& [name, array] : file.arrays) {
    const VtuArray* found = reader.find(name);
    REQUIRE(found != nullptr);
    CHECK(found->type == array.type);
    CHECK(found->components == array.components);
    CHECK(reader.values(*found) == array.values);
  }

  // Of the particles around one of them, no others.
  if (n == 0) return;
  std::vector<Vec<Dim>> positions;
  for (std::size_t p = 0; p < n; ++p) positions.push_back(2 * particles.vector(Quantity::position, p));
  const Vec<Dim> centre = positions[n / 2];
  std::vector<std::uint32_t> near;
  for (const std::uint32_t p : order)
    if ((positions[p] - centre).cwiseAbs().maxCoeff() <= 1.1) near.push_back(p);
  write_neighbourhood(folder.path() / "near.vtu", particles, scene, positions, centre, 1.1, 0.25);
  auto expected = expected_arrays(particles, scene, near);
  for (double& x : expected["Points"].values) x *= 2;
  check_arrays(parse_vtu(folder.path() / "near.vtu"), expected);
}

TEST_CASE("a file of particles holds what their columns say, however another program reads it") {
  check_series<2>(1, 40, kUsual, false);
  check_series<2>(
      2, 41, usual_and({Quantity::out_of_plane_stretch, Quantity::plastic_strain, Quantity::temperature}),
      true);
  check_series<2>(3, 7,
                  usual_and({Quantity::domain_share, Quantity::volume_ratio, Quantity::internal_energy,
                             Quantity::dissipated_energy}),
                  false);
  check_series<2>(4, 5, {Quantity::position, Quantity::initial_volume}, false);
  check_series<2>(5, 0, kUsual, false);
  check_series<3>(6, 40, kUsual, true);
  check_series<3>(7, 9,
                  usual_and({Quantity::domain_share, Quantity::volume_ratio, Quantity::internal_energy,
                             Quantity::dissipated_energy, Quantity::plastic_strain, Quantity::temperature}),
                  false);
}

TEST_CASE("cracks of a file are their points in a row, and how many each has") {
  const TemporaryFolder folder;
  const Scene scene = scene_in(2);
  const Particles<2> particles = random_particles<2>(8, 6, kUsual);
  ParticleSeries<2> series(folder.path(), scene);
  const Polylines lines{{{0.5, 0.25}, {1, 2}, {3, 5}}, {{-1, -2}, {0.125, 8}}};
  series.append(particles, 0.25, lines);
  const File file = parse_vtu(folder.path() / "particles/000000.vtu");
  const Array points = file.arrays.at("crack_points"), lengths = file.arrays.at("crack_lengths");
  CHECK(points.type == "Float64");
  CHECK(points.components == 3);
  CHECK(points.tuples == "5");
  CHECK(points.values == std::vector<double>{0.5, 0.25, 0, 1, 2, 0, 3, 5, 0, -1, -2, 0, 0.125, 8, 0});
  CHECK(lengths.type == "UInt32");
  CHECK(lengths.components == 1);
  CHECK(lengths.tuples == "2");
  CHECK(lengths.values == std::vector<double>{3, 2});
}

/// The columns that a frame gives back are those that were written, to the digits of the file.
template <int Dim>
void check_frame(unsigned seed, const std::vector<Quantity>& quantities, Space space) {
  const TemporaryFolder folder;
  Scene scene = scene_in(Dim);
  scene.space = space;
  const Particles<Dim> particles = random_particles<Dim>(seed, 30, quantities, true);
  ParticleSeries<Dim> series(folder.path(), scene);
  series.append(particles, 0.5);
  const auto path = folder.path() / "particles/000000.vtu";
  const Particles<Dim> read = read_frame<Dim>(VtuReader(path), path, scene);
  REQUIRE(read.size() == 30);
  CHECK(read.quantities().size() == quantities.size());
  std::vector<std::uint32_t> order = order_by_id(particles);
  for (std::size_t k = 0; k < 30; ++k) {
    CHECK(read.id()[k] == particles.id()[order[k]]);
    CHECK(read.body()[k] == particles.body()[order[k]]);
  }
  for (const Quantity q : quantities) {
    REQUIRE(read.has(q));
    for (int c = 0; c < Particles<Dim>::components(q); ++c)
      for (std::size_t k = 0; k < 30; ++k) {
        const double a = read.column(q, c)[k], b = particles.column(q, c)[order[k]];
        CHECK(std::abs(a - b) <= 3e-7 * std::max(std::abs(b), 1e-3));
      }
  }
}

TEST_CASE("a frame that is read back has the columns of the particles that were written") {
  std::vector<Quantity> columns = kUsual;
  std::erase(columns, Quantity::mass);  // which files do not hold
  const auto with = [&](std::initializer_list<Quantity> more) {
    std::vector<Quantity> out = columns;
    out.insert(out.end(), more);
    return out;
  };
  check_frame<2>(1, columns, Space::plane_strain);
  check_frame<2>(2, with({Quantity::out_of_plane_stretch, Quantity::temperature}), Space::plane_stress);
  check_frame<2>(3, with({Quantity::out_of_plane_stretch, Quantity::domain_share}), Space::axisymmetric);
  check_frame<2>(4, with({Quantity::volume_ratio, Quantity::dissipated_energy}), Space::plane_strain);
  check_frame<2>(5, {Quantity::position}, Space::plane_strain);
  check_frame<3>(6, with({Quantity::plastic_strain, Quantity::internal_energy}), Space::three_dimensional);
  check_frame<3>(7, with({Quantity::domain_share, Quantity::volume_ratio}), Space::three_dimensional);
}

}  // namespace
