// Grid files against the nodes and entries that they are written from, and rows of a history against sums and
// differences that are taken plainly.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "engine/output/particle_access.hpp"
#include "engine/output/read_vtu.hpp"
#include "engine/run/make_row.hpp"
#include "engine/run/write_grid.hpp"
#include "engine/scene/crack_tips.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Three bodies that meet at a place off the origin, one of which moves into the others, over a floor. One
/// that is rigid is the first of them.
Scene corner(int dimension, const std::string& contact, const std::string& rest = "") {
  const bool solid = dimension == 3, rigid = rest == "rigid";
  const std::string upper = fmt::format(
      "  - {{name: upper, box: {{from: [13 mm, -15 mm{l}], to: [17 mm, -13 mm{h}]}}, material: {}, velocity: "
      "[3 m/s, -9 m/s{z}]}}",
      rigid ? "tool" : "soft", fmt::arg("l", solid ? ", -2 mm" : ""), fmt::arg("h", solid ? ", 1 mm" : ""),
      fmt::arg("z", solid ? ", 2 m/s" : ""));
  return scene_from(fmt::format(R"(
space: {}
grid: {{origin: [10 mm, -20 mm{}], size: [10 mm, 9 mm{}], cell: 1 mm}}
time: {{end: 1 ms}}
materials: {{soft: {{model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa, heat_capacity: 900 J/kg/K, conductivity: 40 W/m/K}}, tool: {{model: rigid}}}}
bodies:
{}
  - {{name: left, box: {{from: [12 mm, -18 mm{l}], to: [15 mm, -15 mm{h}]}}, material: soft}}
  - {{name: right, box: {{from: [15 mm, -18 mm{l}], to: [18 mm, -15 mm{h}]}}, material: soft, velocity: [-4 m/s, 1 m/s{z}]}}
{}
contact: {}
boundaries: {{floor: {{box: {{from: [12 mm, -18 mm{l}], to: [18 mm, -18 mm{h}]}}, direction: [0, 1{zero}], speed: 0.5 m/s}}, bottom: wall}}
{}
)",
                                solid ? "3d" : "plane_strain", solid ? ", -3 mm" : "", solid ? ", 6 mm" : "",
                                rigid ? upper : "", rigid ? "" : upper, contact, rigid ? "" : rest,
                                fmt::arg("l", solid ? ", -2 mm" : ""), fmt::arg("h", solid ? ", 1 mm" : ""),
                                fmt::arg("z", solid ? ", 2 m/s" : ""), fmt::arg("zero", solid ? ", 0" : "")));
}

bool same(double a, double b, double size = 0) {
  return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 1e-6 * std::max(std::abs(b), size);
}

template <int Dim>
void check_grid(const Scene& scene, bool springs, bool bonds, bool heat) {
  CAPTURE(Dim);
  const Folder folder;
  Step<Dim> step(scene);
  advance(step, 4);
  write_grid(folder / "grid.vtu", step, scene);
  const VtuReader file(folder / "grid.vtu");
  CHECK(file.time() == step.state().time);
  const State<Dim>& state = step.state();
  const ContactList<Dim>& list = step.contact_list();

  /// What one field meets at a node.
  struct Met {
    double gap = std::numeric_limits<double>::infinity(), farthest = 0;
    std::array<double, 3> normal{}, impulse{}, jump{};
    bool touching = false;
    double damage = -1;
  };
  std::map<int, Met> met;  // by slot
  int normals = 0;
  for (const ContactNode<Dim>& node : list.nodes)
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const auto& [pair, geometry, before, status, impulse, slip, spring, bond, fit] = list.pairs;
      const Vec<Dim>&normal = geometry[e].normal, &pushed = impulse[e].now;
      for (const auto& [side, sign] : {std::pair(pair[e].a, 1.0), std::pair(pair[e].b, -1.0)}) {
        if (side < 0) continue;
        Met& now = met[list.fields[static_cast<std::size_t>(node.field_begin + side)].slot];
        for (int d = 0; d < Dim; ++d)
          if (status[e].touching) now.impulse[static_cast<std::size_t>(d)] += sign * pushed[d];
        now.touching = now.touching || status[e].touching;
        if (normal.norm() > 0 && geometry[e].separation < now.gap) {
          now.gap = geometry[e].separation;
          for (int d = 0; d < Dim; ++d) now.normal[static_cast<std::size_t>(d)] = sign * normal[d];
          ++normals;
        }
        if (!spring.empty() && spring[e].acts && spring[e].jump.value.norm() > now.farthest) {
          now.farthest = spring[e].jump.value.norm();
          for (int d = 0; d < Dim; ++d)
            now.jump[static_cast<std::size_t>(d)] = sign * spring[e].jump.value[d];
        }
        if (!bond.empty() && bond[e].damage_before >= 0)
          now.damage = std::max<double>(now.damage, bond[e].damage);
      }
    }
  CHECK(normals > 0);
  std::map<std::tuple<int, int, int, int>, std::size_t> rows;  // field and node
  const auto points = file.points(), field = file.values(*file.find("field"));
  for (std::size_t k = 0; k < file.size(); ++k) {
    std::array<int, 3> node{};
    for (int d = 0; d < 3; ++d) {
      const auto c = static_cast<std::size_t>(d);
      const double cells =
          d < Dim ? (points[3 * k + c] - state.grid.origin[std::min(d, Dim - 1)]) / state.grid.cell
                  : points[3 * k + c];
      node[c] = static_cast<int>(std::lround(cells));
      CHECK(std::abs(cells - node[c]) < 1e-9);
    }
    CHECK(rows.emplace(std::tuple(static_cast<int>(field[k]), node[0], node[1], node[2]), k).second);
  }
  const auto column = [&](const char* name, bool there, std::size_t width) {
    CAPTURE(std::string(name));
    REQUIRE((file.find(name) != nullptr) == there);
    if (there) CHECK(file.find(name)->components == width);
    return there ? file.values(*file.find(name)) : std::vector<double>();
  };
  const auto mass = column("mass", true, 1), velocity = column("velocity", true, 3),
             touching = column("touching", true, 1), normal = column("contact_normal", true, 3),
             gap = column("separation", true, 1), impulse = column("contact_impulse", true, 3),
             jump = column("jump", springs, 3), damage = column("damage", bonds, 1),
             temperature = column("temperature", heat, 1);
  std::size_t found = 0;
  for (const auto& block : state.tiling.node_blocks)
    for (int tile = block.begin; tile < block.end; ++tile)
      for (int local = 0; local < kTileNodes<Dim>; ++local) {
        const int slot = tile * kTileNodes<Dim> + local;
        const NodeIndex<Dim> at = state.tiling.node(block, local);
        const auto row = rows.find({state.tiling.node_tiles[static_cast<std::size_t>(tile)].field, at[0],
                                    at[1], Dim == 3 ? at[Dim - 1] : 0});
        const double m = state.nodes.column(Nodal::mass)[slot];
        CHECK((row != rows.end()) == (m > 0));
        if (row == rows.end()) continue;
        const std::size_t k = row->second;
        ++found;
        const Met now = met.contains(slot) ? met[slot] : Met{};
        CHECK(mass[k] == m);
        CHECK(touching[k] == now.touching);
        CHECK(same(gap[k], std::isinf(now.gap) ? std::numeric_limits<double>::quiet_NaN() : now.gap, 1e-9));
        for (std::size_t d = 0; d < 3; ++d) {
          const int e = std::min(static_cast<int>(d), Dim - 1);
          CHECK(same(velocity[3 * k + d],
                     static_cast<int>(d) < Dim ? state.nodes.vector(Nodal::velocity, slot)[e] : 0));
          CHECK(same(normal[3 * k + d], now.normal[d], 1));
          CHECK(same(impulse[3 * k + d], now.impulse[d], 1e-9));
          if (springs) CHECK(same(jump[3 * k + d], now.jump[d], 1e-12));
        }
        if (bonds)
          CHECK(same(damage[k], now.damage < 0 ? std::numeric_limits<double>::quiet_NaN() : now.damage));
        if (heat) CHECK(same(temperature[k], step.heat().temperature(state, slot)));
      }
  CHECK(found == file.size());
  CHECK(found > 40);
}

TEST_CASE("grid files have a row of each field that has mass at a node, with what it meets there") {
  check_grid<2>(corner(2, "{friction: 0.3}"), false, false, false);
  check_grid<3>(corner(3, "{friction: 0.3}"), false, false, false);
  check_grid<2>(corner(2, "{friction: 0.3, fields: lump}", "rigid"), false, false, false);
  const std::string springs = "{law: interface, normal_stiffness: 1 GPa/m, shear_stiffness: 2 GPa/m}";
  check_grid<2>(corner(2, springs), true, false, false);
  check_grid<3>(corner(3, springs), true, false, false);
  check_grid<2>(corner(2, springs, "rigid"), true, false, false);
  const std::string bonds =
      "{law: cohesive, normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 3 J/m^2, "
      "shear_toughness: "
      "5 J/m^2, friction: 0.3}";
  check_grid<2>(corner(2, bonds), true, true, false);
  check_grid<3>(corner(3, bonds), true, true, false);
  check_grid<2>(
      corner(2, "{friction: 0.3}", "heat: {temperature: 300 K, boundaries: {bottom: {temperature: 350 K}}}"),
      false, false, true);
}

template <int Dim, class Now, class Before>
void check_force(const Vec3& force, const Now& now, const Before& before, double elapsed) {
  for (std::size_t d = 0; d < 3; ++d) {
    const auto e = static_cast<int>(d);
    const double expected = e < now.size() && elapsed > 0
                                ? (now[std::min(e, static_cast<int>(now.size()) - 1)] -
                                   before[std::min(e, static_cast<int>(now.size()) - 1)]) /
                                      elapsed
                                : 0;
    CHECK(force[d] == doctest::Approx(expected).epsilon(1e-12));
  }
}

template <int Dim>
void check_rows(bool rigid) {
  const std::string contact =
      "{friction: 0.3, pairs: [{between: [left, right], friction: 0.1}, {between: [upper, left], friction: "
      "0.2}]}";
  const Scene scene = corner(Dim, contact, rigid ? "rigid" : "");
  Step<Dim> step(scene);
  RunCounters<Dim> counters(scene);
  counters.last_sums = step.sums();
  Sums<Dim> last = step.sums();
  double last_time = 0, forces = 0, widest = 0;
  for (int n = 0; n < 4; ++n) {
    if (n > 0) advance(step, n);
    const Sums<Dim> sums = step.sums();
    const HistoryRow row = make_row(step, scene, 1.5e-7 * n, counters);
    const double elapsed = step.state().time - last_time;
    CHECK(row.step == step.state().step);
    CHECK(row.time == step.state().time);
    CHECK(row.dt == 1.5e-7 * n);
    CHECK(row.stored == step.stored_energy());
    CHECK(row.dissipated == step.dissipated_energy());
    CHECK(row.friction == sums.friction_work);
    CHECK(row.interface == sums.interface_loss);
    CHECK(row.boundary_work == sums.boundary_work);
    CHECK(row.body_force_work == sums.body_force_work);
    CHECK(row.pair_friction == sums.pair_friction_work);
    REQUIRE(row.boundary_force.size() == scene.boundaries.size());
    for (std::size_t b = 0; b < row.boundary_force.size(); ++b) {
      check_force<Dim>(row.boundary_force[b], sums.boundary_impulse[b], last.boundary_impulse[b], elapsed);
      for (const double f : row.boundary_force[b]) forces += std::abs(f);
    }
    REQUIRE(row.pair_force.size() == 2);
    for (std::size_t k = 0; k < 2; ++k)
      check_force<Dim>(row.pair_force[k], sums.pair_impulse[k], last.pair_impulse[k], elapsed);
    REQUIRE(row.rigid_force.size() == 3);
    REQUIRE(row.rigid_moment.size() == 3);
    for (std::size_t b = 0; b < 3; ++b) {
      const auto f = static_cast<std::size_t>(step.plan().body_field[b]);
      const bool is_rigid = rigid && b == 0;
      check_force<Dim>(row.rigid_force[b], sums.rigid_impulse[f], last.rigid_impulse[f],
                       is_rigid ? elapsed : 0);
      check_force<Dim>(row.rigid_moment[b], sums.rigid_moment[f], last.rigid_moment[f],
                       is_rigid ? elapsed : 0);
      if (is_rigid)
        for (const double f_d : row.rigid_force[b]) forces += std::abs(f_d);
    }
    const Spacing spacing = widest_spacing(step.state().particles, scene);
    widest = std::max(widest, spacing.cells);
    CHECK(counters.spacing.cells == widest);
    CHECK(counters.last_row_step == step.state().step);
    CHECK(counters.last_row_time == step.state().time);
    CHECK_FALSE(row.heat);
    CHECK_FALSE(row.overlap);
    // As where an earlier row had wider domains.
    if (n == 2) counters.spacing.cells = widest = 50;
    last = sums;
    last_time = step.state().time;
  }
  CHECK(forces > 0);
}

TEST_CASE("forces of a row are the means since the last one, of impulses that the step has summed") {
  for (const bool rigid : {false, true}) {
    check_rows<2>(rigid);
    check_rows<3>(rigid);
  }
}

TEST_CASE(
    "a row has the loads of the tips that have a contour, and how long each crack is up to where bonds "
    "soften") {
  const Scene scene = scene_from(R"(
space: plane_strain
grid: {size: [22 mm, 20 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {rock: {model: linear_elastic, density: 2 g/cm^3, young: 30 MPa, poisson: 0.2}}
bodies: [{name: plate, box: {from: [3 mm, 3 mm], to: [19 mm, 17 mm]}, material: rock}]
cracks:
  - {name: slit, body: plate, line: [[1 mm, 9.2 mm], [6 mm, 9.7 mm], [9.3 mm, 11.1 mm]], law: cohesive, normal_strength: 60 kPa, shear_strength: 50 kPa, normal_toughness: 1 J/m^2, shear_toughness: 2 J/m^2, contour: 2.5, growth: {}}
  - {name: inner, body: plate, line: [[12 mm, 6 mm], [15 mm, 6.5 mm]], law: frictionless, contour: 2.2}
boundaries:
  up: {box: {from: [0 mm, 16 mm], to: [22 mm, 20 mm]}, direction: [1, 3], speed: 4 m/s}
  down: {box: {from: [0 mm, 0 mm], to: [22 mm, 4 mm]}, direction: y, speed: -2 m/s}
)");
  Step<2> step(scene);
  RunCounters<2> counters(scene);
  counters.last_sums = step.sums();
  advance(step, 20);
  const HistoryRow row = make_row(step, scene, 1e-7, counters);
  const std::vector<CrackTip> tips = crack_tips(scene);
  REQUIRE(tips.size() == 3);
  REQUIRE(row.tips.size() == 3);
  REQUIRE(row.crack_lengths.size() == 2);
  std::vector<double> lengths;
  for (const auto& line : step.cracks().lines()) lengths.push_back(line.length());
  for (std::size_t k = 0; k < 3; ++k) {
    const TipLoad load = step.tip_load(tips[k].crack, tips[k].end);
    CHECK(row.tips[k][0] == load.position[0]);
    CHECK(row.tips[k][1] == load.position[1]);
    CHECK(row.tips[k][2] == load.energy_release_rate);
    CHECK(row.tips[k][3] == load.mode_i);
    CHECK(row.tips[k][4] == load.mode_ii);
    CHECK(load.energy_release_rate > 0);
    lengths[static_cast<std::size_t>(tips[k].crack)] -= load.bonded_length;
  }
  CHECK(row.crack_lengths == lengths);
  CHECK(row.crack_lengths[0] < step.cracks().lines()[0].length());  // bonds lead the slit
}

TEST_CASE("a row has the heat that bodies hold beyond the first temperature, and all that came in") {
  const Scene scene = corner(
      2, "{friction: 0.3}",
      "heat: {temperature: 300 K, boundaries: {bottom: {temperature: 350 K}, spot: {box: {from: [12 mm, "
      "-16 mm], to: [13 mm, -15 mm]}, temperature: 320 K}}}");
  Step<2> step(scene);
  RunCounters<2> counters(scene);
  counters.last_sums = step.sums();
  advance(step, 6);
  const HistoryRow row = make_row(step, scene, 1e-7, counters);
  REQUIRE(row.heat);
  double content = 0;
  const auto& particles = step.state().particles;
  for (std::size_t p = 0; p < particles.size(); ++p)
    content += particles.column(Quantity::mass)[p] * 900 * (particles.column(Quantity::temperature)[p] - 300);
  CHECK(std::abs(row.heat->content - content) <
        1e-9 * std::abs(content) + 1e-9 * row.bodies[0].mass * 900 * 300);
  const HeatSums& sums = step.heat().sums();
  REQUIRE(sums.conditions.size() == 2);
  CHECK(row.heat->conditions == sums.conditions);
  CHECK(row.heat->in == sums.rigid + sums.conditions[0] + sums.conditions[1]);
  CHECK(row.heat->friction == sums.friction);
  CHECK(row.heat->worked == sums.worked);
  CHECK(sums.conditions[1] > 0);
}

}  // namespace
}  // namespace mpmfast
