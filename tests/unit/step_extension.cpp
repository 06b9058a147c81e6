// Extended splines: what nodes that follow others take from them and give to them.

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/text/diagnostic.hpp"
#include "engine/step/extension.hpp"
#include "kernels/basis/extension.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A body cut by the cells anywhere, with particles at an angle to them.
std::string cut_body(int dimension, double shift, const char* velocity = "[3 m/s, 4 m/s]") {
  const std::string at = std::to_string(shift);
  if (dimension == 2)
    return R"(
space: plane_strain
grid: {origin: [-10 mm, -10 mm], size: [20 mm, 20 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: b, disk: {centre: [)" +
           at + " mm, " + at +
           " mm], radius: 5.2 mm}, material: m, seeding: {angle: 20 deg}, velocity: " + velocity + "}\n";
  return R"(
space: 3d
grid: {origin: [-8 mm, -8 mm, -8 mm], size: [16 mm, 16 mm, 16 mm], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: b, sphere: {centre: [)" +
         at + " mm, " + at + " mm, 0.1 mm], radius: 3.3 mm}, material: m, velocity: [3 m/s, 4 m/s, 5 m/s]}\n";
}

/// A scene whose masses and momenta are on the nodes, as projected, and its extension.
template <int Dim>
struct Projected {
  Scene scene;
  Step<Dim> step;
  Extension<Dim> extension;

  Projected(const std::string& yaml, const char* basis, const char* occupation)
      : scene(scene_from(yaml, {{"method.basis", basis},
                                {"method.extension", std::string("{occupation: ") + occupation + "}"}})),
        step(scene),
        extension(scene, step.plan()) {
    auto& state = step.state();
    const auto passes = make_passes<Dim>(scene.method.basis);
    passes->sort(state);
    for (Nodal q : {Nodal::mass, Nodal::momentum, Nodal::occupied})
      for (int d = 0; d < state.nodes.width(q); ++d)
        std::fill_n(state.nodes.column(q, d), state.tiling.slots(), 0.0);
    REQUIRE(passes->project(state, false));
    passes->occupy(state);
    extension.find(state);
  }
  State<Dim>& state() { return step.state(); }
};

template <int Dim>
std::vector<NodeIndex<Dim>> nodes_of_slots(const State<Dim>& state) {
  std::vector<NodeIndex<Dim>> nodes(static_cast<std::size_t>(state.tiling.slots()));
  for (const auto& block : state.tiling.node_blocks)
    for (int t = block.begin; t < block.end; ++t)
      for (int local = 0; local < kTileNodes<Dim>; ++local)
        nodes[static_cast<std::size_t>(t * kTileNodes<Dim> + local)] = state.tiling.node(block, local);
  return nodes;
}

TEST_CASE("weights of an extension are those of the polynomial through a block of nodes") {
  for (int order = 0; order <= 3; ++order)
    for (int j = -4; j <= 6; ++j)
      for (int power = 0; power <= order; ++power) {
        double sum = 0;
        for (int i = 0; i <= order; ++i) sum += lagrange_weight(order, i, j) * std::pow(i, power);
        CHECK(sum == doctest::Approx(std::pow(j, power)).epsilon(1e-12));
      }
  // The nearest of a quadratic block: 3, −3, 1 (K24 Fig. 4).
  CHECK(lagrange_weight(2, 0, -1) == 3);
  CHECK(lagrange_weight(2, 1, -1) == -3);
  CHECK(lagrange_weight(2, 2, -1) == 1);
}

template <int Dim>
void check_exactness(const char* basis, const char* occupation, double shift) {
  CAPTURE(std::string(basis));
  CAPTURE(std::string(occupation));
  CAPTURE(shift);
  Projected<Dim> p(cut_body(Dim, shift), basis, occupation);
  const auto node = nodes_of_slots(p.state());
  const int degree = facts(p.scene.method.basis).usual_support - 1;
  REQUIRE(!p.extension.following().empty());
  double worst = 0;
  for (const auto& follows : p.extension.following()) {
    const auto& at = node[static_cast<std::size_t>(follows.slot)];
    for (int k = 0; k < power(degree + 1, Dim); ++k) {
      double sum = 0, exact = 1;
      bool within = true;
      for (int d = 0, rest = k; d < Dim; ++d, rest /= degree + 1) {
        within &= rest % (degree + 1) <= follows.order;
        exact *= rest % (degree + 1) == 0 ? 1 : 0;  // x^k about the node itself
      }
      if (!within) continue;
      for (int s = follows.begin; s < follows.end; ++s) {
        const auto& share = p.extension.shares()[static_cast<std::size_t>(s)];
        double product = share.weight;
        for (int d = 0, rest = k; d < Dim; ++d, rest /= degree + 1)
          product *= std::pow(node[static_cast<std::size_t>(share.slot)][d] - at[d], rest % (degree + 1));
        sum += product;
      }
      worst = std::max(worst, std::abs(sum - exact));
    }
  }
  CHECK(worst < 1e-12 * (Dim == 3 ? 1e3 : 1e2));  // terms of up to 4^4 and 4^6 cancel
  if (Dim == 2 && degree == 2) CHECK(worst < 1e-12);
}

TEST_CASE("nodes that follow others take the values of polynomials exactly, with any cut") {
  for (const char* occupation : {"0.5", "0.6", "0.8"})
    for (double shift : {0.0, 0.137, 0.5, 0.731}) {
      check_exactness<2>("bspline2", occupation, shift);
      check_exactness<2>("bspline3", occupation, shift);
    }
  check_exactness<3>("bspline2", "0.6", 0.137);
  check_exactness<3>("bspline3", "0.6", 0.137);
}

/// A block between two walls that moves anyhow, but not where a wall holds its row of nodes.
/// @param wall  of the lower wall, mm: on a row or between two; the block begins there
template <int Dim>
void check_wall(const char* basis, double wall) {
  CAPTURE(std::string(basis));
  CAPTURE(wall);
  const std::string at = std::to_string(wall), z = Dim == 3 ? ", 1.3 mm" : "",
                    top = Dim == 3 ? ", 4.2 mm" : "";
  Projected<Dim> p("space: " + std::string(Dim == 3 ? "3d" : "plane_strain") +
                       "\ngrid: {origin: [0 mm, -2 mm" + (Dim == 3 ? ", 0 mm" : "") +
                       "], size: [9 mm, 10 mm" + (Dim == 3 ? ", 6 mm" : "") + R"(], cell: 1 mm}
time: {end: 1 s, cfl: 0.4}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
boundaries: {bottom: {wall: sliding, position: )" +
                       at + R"( mm}}
bodies: [{name: b, box: {from: [2.3 mm, )" +
                       at + " mm" + z + "], to: [6.6 mm, 5.2 mm" + top +
                       "]}, material: m, particles_per_cell: 4}]\n",
                   basis, "0.8");
  const auto node = nodes_of_slots(p.state());
  const auto held = static_cast<int>(std::floor(wall + 1e-9)) + 2;  // the first row at or beyond the wall
  std::map<std::array<int, 3>, int> slot_at;
  const auto index_of = [&](const NodeIndex<Dim>& n) {
    return std::array<int, 3>{n[0], n[1], Dim == 3 ? n[Dim - 1] : 0};
  };
  for (std::size_t s = 0; s < node.size(); ++s) slot_at[index_of(node[s])] = static_cast<int>(s);
  double* v = p.state().nodes.column(Nodal::velocity, 1);
  for (std::size_t s = 0; s < node.size(); ++s)
    v[s] = node[s][1] == held ? 0 : std::sin(3.0 * node[s][0] + 1.7 * node[s][1] * node[s][1]);
  p.extension.prolong(p.state(), {Nodal::velocity});
  int beyond = 0;
  for (const auto& follows : p.extension.following()) {
    const auto& n = node[static_cast<std::size_t>(follows.slot)];
    const bool over_the_block = n[0] > 3 && n[0] < 6 && (Dim == 2 || (n[Dim - 1] > 2 && n[Dim - 1] < 4));
    if (!over_the_block || n[1] > 4) continue;
    CHECK(n[1] < held);  // the row that the wall holds keeps its freedom
    CHECK(follows.order == 1);
    NodeIndex<Dim> mirror = n;
    mirror[1] = 2 * held - n[1];
    if (n[1] == held - 1)
      CHECK(v[follows.slot] == doctest::Approx(-v[slot_at.at(index_of(mirror))]).epsilon(1e-13));
    ++beyond;
  }
  CHECK(beyond > 0);
}

TEST_CASE("a wall continues the material: its row is free to be held, and rows beyond mirror those inside") {
  for (double wall : {0.0, -0.7}) {
    check_wall<2>("bspline2", wall);
    check_wall<3>("bspline2", wall);
    check_wall<2>("bspline3", wall);
  }
}

TEST_CASE("at an upper wall the nodes that follow are those at a lower one, mirrored") {
  const auto following = [](const char* basis, bool upper) {
    Projected<2> p(std::string(R"(
space: plane_strain
grid: {origin: [-6 mm, -8 mm], size: [12 mm, 16 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
)") + (upper ? R"(
boundaries: {top: {wall: sliding, position: 4 mm}}
bodies: [{name: b, box: {from: [-2.3 mm, -1.2 mm], to: [2.3 mm, 4 mm]}, material: m, particles_per_cell: 4}]
)"
             : R"(
boundaries: {bottom: {wall: sliding, position: -4 mm}}
bodies: [{name: b, box: {from: [-2.3 mm, -4 mm], to: [2.3 mm, 1.2 mm]}, material: m, particles_per_cell: 4}]
)"),
                   basis, "0.8");
    std::set<std::array<int, 2>> places;  // counted from the middle of the grid
    const auto node = nodes_of_slots(p.state());
    for (const auto& follows : p.extension.following()) {
      const auto& n = node[static_cast<std::size_t>(follows.slot)];
      places.insert({n[0], upper ? n[1] - 8 : 8 - n[1]});
    }
    return places;
  };
  for (const char* basis : {"bspline2", "bspline3"}) {
    CAPTURE(std::string(basis));
    const auto low = following(basis, false);
    CHECK(low.size() > 10);
    CHECK(following(basis, true) == low);
  }
}

/// The box ends within cells of the spline, which lie about its nodes (bspline2) or between them.
TEST_CASE("a cell that is filled to the occupation, no more, has not enough, wherever it lies") {
  const auto following = [](const char* basis, double begin, const char* occupation) {
    const auto mm = [](double x) { return std::to_string(x) + " mm"; };
    Projected<2> p(R"(
space: plane_strain
grid: {size: [60 mm, 12 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: b, box: {from: [)" +
                       mm(begin) + ", " + mm(begin - std::floor(begin) + 3) + "], to: [" + mm(begin + 4.5) +
                       ", " + mm(begin - std::floor(begin) + 7.5) + "]}, material: m}]\n",
                   basis, occupation);
    return p.extension.following().size();
  };
  for (const auto& spline : {std::pair{"bspline2", 0.0}, {"bspline3", 0.5}})
    for (int cell = 3; cell < 50; ++cell) {
      const auto [basis, edge] = spline;
      CAPTURE(std::string(spline.first));
      CAPTURE(cell);
      const auto half = following(basis, cell + edge, "0.5");
      CHECK(half == following(basis, cell + edge, "0.52"));
      CHECK(half > following(basis, cell + edge, "0.48"));
    }
}

template <int Dim>
void check_restriction(const char* basis, double shift) {
  CAPTURE(std::string(basis));
  Projected<Dim> p(cut_body(Dim, shift), basis, "0.6");
  auto& nodes = p.state().nodes;
  const auto node = nodes_of_slots(p.state());
  const auto sums = [&] {  // mass, momentum, angular momentum about the grid's first node
    std::array<double, 1 + Dim + 3> out{};
    for (int s = 0; s < p.state().tiling.slots(); ++s) {
      double x[3]{}, v[3]{};
      for (int d = 0; d < Dim; ++d) {
        x[d] = node[static_cast<std::size_t>(s)][d];
        v[d] = nodes.column(Nodal::momentum, d)[s];
        out[static_cast<std::size_t>(1 + d)] += v[d];
      }
      out[0] += nodes.column(Nodal::mass)[s];
      for (int d = 0; d < 3; ++d)
        out[static_cast<std::size_t>(1 + Dim + d)] +=
            x[(d + 1) % 3] * v[(d + 2) % 3] - x[(d + 2) % 3] * v[(d + 1) % 3];
    }
    return out;
  };
  const auto before = sums();
  p.extension.restrict_columns(p.state(), {Nodal::mass, Nodal::momentum});
  const auto after = sums();
  for (std::size_t k = 0; k < after.size(); ++k)
    CHECK(after[k] == doctest::Approx(before[k]).epsilon(1e-13).scale(std::abs(before[0]) * 100));
  for (const auto& follows : p.extension.following()) CHECK(nodes.column(Nodal::mass)[follows.slot] == 0);
}

TEST_CASE("what nodes give to those that they follow keeps mass, momentum and angular momentum") {
  for (const char* basis : {"bspline2", "bspline3"}) {
    check_restriction<2>(basis, 0.137);
    check_restriction<3>(basis, 0.137);
  }
}

template <int Dim>
void check_steps(const char* basis, const char* update) {
  CAPTURE(std::string(basis));
  CAPTURE(std::string(update));
  const Scene scene = scene_from(
      cut_body(Dim, 0.137),
      {{"method.basis", basis}, {"method.update", update}, {"method.extension", "{occupation: 0.6}"}});
  Step<Dim> step(scene);
  auto& particles = step.state().particles;
  double scale = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {  // a body that is stretched and turns
    scale += particles.column(Quantity::mass)[p] * 10;
    const Vec<Dim> x = particles.vector(Quantity::position, p);
    particles.column(Quantity::velocity, 0)[p] += 1000 * x[0] - 700 * x[1];
    particles.column(Quantity::velocity, 1)[p] += 700 * x[0];
  }
  const Vec<Dim> before = momentum(particles);
  const double energy = kinetic_energy(particles);
  advance(step, sanitized() ? 15 : 100);
  CHECK(step.extension().counters().nodes > 0);
  CHECK((momentum(particles) - before).norm() < 1e-13 * scale);
  const double now = kinetic_energy(particles) + step.stored_energy();
  if (std::string(update) == "flip") CHECK(std::abs(now / energy - 1) < 2e-3);
  CHECK(now < 1.0001 * energy);
}

TEST_CASE("momentum is conserved to round-off, and energy does not grow, with extended splines") {
  for (const char* basis : {"bspline2", "bspline3"}) {
    for (const char* update : {"flip", "pic", "xpic(3)", "fmpm(3)"}) check_steps<2>(basis, update);
    check_steps<3>(basis, "flip");
  }
}

TEST_CASE("no node that others follow is thrown about by them, at the cost of exactness where need be") {
  // As the mass of the followed node is summed, so it holds; that weights were lowered shows that it would
  // not.
  std::uint64_t lowered = 0;
  for (int k = 0; k < 40; ++k) {
    Projected<2> p(cut_body(2, 0.025 * k), "bspline2", "0.75");
    auto& state = p.state();
    const std::vector<double> given(state.nodes.column(Nodal::mass),
                                    state.nodes.column(Nodal::mass) + state.tiling.slots());
    p.extension.restrict_columns(state, {Nodal::mass});
    std::vector<double> thrown(given.size(), 0.0);
    for (const auto& follows : p.extension.following())
      for (int s = follows.begin; s < follows.end; ++s) {
        const auto& share = p.extension.shares()[static_cast<std::size_t>(s)];
        thrown[static_cast<std::size_t>(share.slot)] +=
            share.weight * share.weight * given[static_cast<std::size_t>(follows.slot)];
      }
    for (std::size_t s = 0; s < given.size(); ++s)
      CHECK(thrown[s] <= (constants::extension::kMostThrown + 1e-12) * state.nodes.column(Nodal::mass)[s]);
    lowered += p.extension.counters().lowered;
  }
  CHECK(lowered > 0);
}

TEST_CASE("a body with hardly a full cell moves as a body, and its nodes keep what freedom they have") {
  const std::string sliver = R"(
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: b, box: {from: [4.1 mm, 4.2 mm], to: [5.2 mm, 6.4 mm]}, material: m, velocity: [3 m/s, 4 m/s]}
)";
  const Scene scene =
      scene_from(sliver, {{"method.basis", "bspline2"}, {"method.extension", "{occupation: 0.9}"}});
  Step<2> step(scene);
  advance(step, 20);
  const auto& counters = step.extension().counters();
  CHECK(counters.alone + counters.lowered > 0);
  for (std::size_t p = 0; p < step.state().particles.size(); ++p)
    CHECK((step.state().particles.vector(Quantity::velocity, p) - Vec<2>(3, 4)).norm() < 1e-12);
}

TEST_CASE("the list of nodes that follow others is the same on any number of threads") {
  Projected<2> p(cut_body(2, 0.137), "bspline2", "0.6");
  const auto once = p.extension.shares();
  for (int threads : {2, 3, 5}) {
    p.state().threads = threads;
    p.extension.find(p.state());
    const auto& again = p.extension.shares();
    REQUIRE(again.size() == once.size());
    bool same = true;
    for (std::size_t k = 0; k < once.size(); ++k)
      same &= again[k].slot == once[k].slot && again[k].weight == once[k].weight;
    CHECK(same);
  }
}

std::string message_of(const std::vector<Override>& overrides, const std::string& more = "") {
  try {
    scene_from(cut_body(2, 0) + more, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("extensions that cannot be had are refused at their place") {
  const Override extended{"method.extension", "{occupation: 0.6}"};
  CHECK(message_of({{"method.basis", "bspline2"}, extended}) == "");
  CHECK(message_of({{"method.basis", "lcpdi"}, extended}).find("splines alone are extended") !=
        std::string::npos);
  CHECK(message_of({{"method.basis", "bspline3"}, {"method.update", "apic"}, extended})
            .find("apic makes energy with extended splines") != std::string::npos);
  CHECK(message_of({{"method.basis", "bspline2"}, {"method.extension", "{occupation: 1}"}})
            .find("occupation") != std::string::npos);
  const std::string second = "  - {name: c, disk: {centre: [-7 mm, -7 mm], radius: 1 mm}, material: m}\n";
  CHECK(
      message_of({{"method.basis", "bspline2"}, extended}, second).find("one velocity field was expected") !=
      std::string::npos);
  CHECK(message_of({{"method.basis", "bspline2"}, {"contact", "none"}, extended}, second) == "");
}

}  // namespace
}  // namespace mpmfast
