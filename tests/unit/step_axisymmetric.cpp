// Axisymmetry: what grids and particles exchange about the axis, to round-off.

#include <numbers>
#include <random>

#include "kernels/materials/out_of_plane.hpp"
#include "material_sample.hpp"
#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// A cylinder on the axis, or (inner > 0) a ring.
std::string cylinder(int inner, const std::string& more = "") {
  return "space: axisymmetric\ngrid: {size: [16 mm, 20 mm], cell: 1 mm}\ntime: {end: 1 s}\n"
         "materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}\n"
         "bodies: [{name: a, box: {from: [" +
         std::to_string(inner) + " mm, 3 mm], to: [8 mm, 9 mm]}, material: m" + more + "}]\n";
}

/// Sets the velocity of every node slot: v(position).
template <class F>
void set_velocities(State<2>& state, F velocity) {
  for (const auto& block : state.tiling.node_blocks)
    for (int local = 0; local < kTileNodes<2>; ++local) {
      const NodeIndex<2> node = state.tiling.node(block, local);
      Vec<2> x;
      for (int d = 0; d < 2; ++d) x[d] = state.grid.origin[d] + node[d] * state.grid.cell;
      for (int t = block.begin; t < block.end; ++t)
        state.nodes.set(Nodal::velocity, t * kTileNodes<2> + local, velocity(x));
    }
}

TEST_CASE("particles are rings of a full turn") {
  const Scene scene = scene_from(cylinder(2));
  Step<2> step(scene);
  double mass = 0, volume = 0;
  for (std::size_t p = 0; p < step.state().particles.size(); ++p) {
    mass += step.state().particles.column(Quantity::mass)[p];
    volume += step.state().particles.column(Quantity::initial_volume)[p];
  }
  const double exact = std::numbers::pi * (64e-6 - 4e-6) * 6e-3;
  CHECK(volume == doctest::Approx(exact).epsilon(1e-13));
  CHECK(mass == doctest::Approx(1200 * exact).epsilon(1e-13));
}

TEST_CASE("nodes that move as v_r = a r, v_z = b z strain every particle by a, b and, round the axis, a") {
  const double a = 0.3, b = -0.7, dt = 0.1;
  for (const char* basis : bases()) {
    CAPTURE(std::string(basis));
    const Scene scene = scene_from(cylinder(0), {{"method.basis", basis}});
    Step<2> step(scene);
    auto& state = step.state();
    const auto passes = make_passes<2>(scene.method.basis);
    passes->sort(state);
    set_velocities(state, [&](const Vec<2>& x) { return Vec<2>(a * x[0], b * x[1]); });
    passes->strain_and_force(state, dt, kAllTerms);
    for (std::size_t p = 0; p < state.particles.size(); ++p) {
      const Mat<2> f = state.particles.deformation_gradient(p);
      REQUIRE(std::abs(f(0, 0) - std::exp(a * dt)) < 1e-13);
      REQUIRE(std::abs(f(1, 1) - std::exp(b * dt)) < 1e-13);
      REQUIRE(std::abs(f(0, 1)) + std::abs(f(1, 0)) < 1e-13);
      REQUIRE(std::abs(state.particles.column(Quantity::out_of_plane_stretch)[p] - std::exp(a * dt)) < 1e-13);
    }
  }
}

TEST_CASE("the power of the nodal forces is that of the stresses, the hoop's included") {
  for (const char* basis : bases()) {
    CAPTURE(std::string(basis));
    const Scene scene = scene_from(cylinder(0), {{"method.basis", basis}});
    Step<2> step(scene);
    auto& state = step.state();
    auto& particles = state.particles;
    const auto passes = make_passes<2>(scene.method.basis);
    passes->sort(state);
    std::mt19937_64 draw(1);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<std::array<double, 4>> stress(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p)
      for (int c = 0; c < 4; ++c)
        stress[p][static_cast<std::size_t>(c)] = particles.column(Quantity::kirchhoff_stress, c)[p] =
            number(draw);
    for (int d = 0; d < 2; ++d) std::fill_n(state.nodes.column(Nodal::force, d), state.tiling.slots(), 0.0);
    passes->strain_and_force(state, 0, 1);
    set_velocities(state, [&](const Vec<2>&) { return Vec<2>(1e-3 * number(draw), 1e-3 * number(draw)); });
    double power = 0, scale = 0;
    for (int i = 0; i < state.tiling.slots(); ++i) {
      const double term = state.nodes.vector(Nodal::force, i).dot(state.nodes.vector(Nodal::velocity, i));
      power += term;
      scale += std::abs(term);
    }
    passes->strain_and_force(state, 1, 1);  // F = I + L, s = 1 + v_r/r
    double expected = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Mat<2> l = particles.deformation_gradient(p) - Mat<2>::Identity();
      const double hoop = particles.column(Quantity::out_of_plane_stretch)[p] - 1;
      expected -= particles.column(Quantity::initial_volume)[p] *
                  (stress[p][0] * l(0, 0) + stress[p][1] * l(1, 1) + stress[p][2] * hoop +
                   stress[p][3] * (l(0, 1) + l(1, 0)));
    }
    CHECK(std::abs(power - expected) < 1e-12 * scale);
  }
}

TEST_CASE("a body that moves along the axis keeps its shape and velocity, on the axis and off it") {
  for (int inner : {0, 2})
    for (const char* basis : bases())
      for (const char* update : {"flip", "pic", "xpic(3)", "fmpm(3)"}) {
        CAPTURE(inner);
        CAPTURE(std::string(basis));
        CAPTURE(std::string(update));
        const Scene scene = scene_from(cylinder(inner, ", velocity: [0 m/s, 60 m/s]"),
                                       {{"method.basis", basis}, {"method.update", update}});
        Step<2> step(scene);
        auto expected = by_id(step.state().particles, Quantity::position);
        advance(step, 60);
        for (std::size_t i = 1; i < expected.size(); i += 2) expected[i] += 60 * step.state().time;
        CHECK(step.state().time * 60 > 2e-3);  // several cells
        const auto& particles = step.state().particles;
        CHECK(relative_difference(by_id(particles, Quantity::position), expected) < 1e-12);
        const auto velocity = by_id(particles, Quantity::velocity);
        for (std::size_t i = 0; i < velocity.size(); ++i)
          REQUIRE(std::abs(velocity[i] - (i % 2 == 1 ? 60 : 0)) < 1e-10);
        for (double s : by_id(particles, Quantity::out_of_plane_stretch)) REQUIRE(std::abs(s - 1) < 1e-12);
      }
}

/// Two blunt bodies that meet head-on, one of them a ring.
const char* const kImpact = R"(
space: axisymmetric
grid: {size: [14 mm, 26 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, disk: {centre: [0 mm, 8 mm], radius: 4.6 mm}, material: m, velocity: [0 m/s, 8 m/s]}
  - {name: b, box: {from: [2.3 mm, 12.7 mm], to: [9.3 mm, 17.7 mm]}, material: m, velocity: [0 m/s, -9 m/s]}
)";

TEST_CASE("momentum along the axis is conserved to round-off through an impact") {
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"})
    for (const char* update : {"flip", "xpic(3)"})
      for (const char* contact :
           {"{law: coulomb, friction: 0.3}", "{law: stick, normal: average_gradient}"}) {
        CAPTURE(std::string(basis));
        CAPTURE(std::string(update));
        CAPTURE(std::string(contact));
        const Scene scene =
            scene_from(kImpact, {{"method.basis", basis}, {"method.update", update}, {"contact", contact}});
        Step<2> step(scene);
        const double before = momentum(step.state().particles)[1];
        double scale = 0;
        for (std::size_t p = 0; p < step.state().particles.size(); ++p)
          scale += step.state().particles.column(Quantity::mass)[p] * 10;
        advance(step, 150);
        CHECK(step.contact_counters().nodes_peak > 0);
        CHECK(std::abs(momentum(step.state().particles)[1] - before) < 1e-13 * scale);
      }
}

TEST_CASE("a perfect interface reproduces one field to round-off about an axis") {
  const Scene one_scene = scene_from(kImpact, {{"contact", "none"}}),
              two_scene = scene_from(kImpact, {{"contact", "{law: perfect}"}});
  Step<2> one(one_scene), two(two_scene);
  REQUIRE(two.plan().fields.size() == 2);
  advance(one, 200);
  advance(two, 200);
  for (Quantity q : {Quantity::position, Quantity::velocity, Quantity::deformation_gradient,
                     Quantity::out_of_plane_stretch})
    CHECK(relative_difference(by_id(two.state().particles, q), by_id(one.state().particles, q)) < 1e-12);
}

TEST_CASE("a volume gradient is that of the section: nothing inside a body") {
  const Scene scene = scene_from(kImpact, {{"contact.normal", "average_gradient"}});
  Step<2> step(scene);
  advance(step, 1);
  auto& state = step.state();
  int inside = 0;
  for (const auto& block : state.tiling.node_blocks)
    for (int local = 0; local < kTileNodes<2>; ++local) {
      const NodeIndex<2> node = state.tiling.node(block, local);
      if (node[0] < 1 || node[0] > 3 || node[1] < 6 || node[1] > 10) continue;
      for (int t = block.begin; t < block.end; ++t) {
        const Vec<2> g = state.nodes.vector(Nodal::volume_gradient, t * kTileNodes<2> + local);
        if (node[0] * node[0] + (node[1] - 8) * (node[1] - 8) > 9) continue;
        CHECK(g.norm() < 1e-14);  // a surface node has 1e-3
        ++inside;
      }
    }
  CHECK(inside > 10);
}

TEST_CASE("a law with a history answers about an axis as in three dimensions") {
  const ElasticPlastic steel{7800, 80e9, {160e9}, {400e6, 1e9}, 470, 0.9, 293};
  Sample<3, ElasticPlastic> solid(steel);
  Lanes l[4], f[4], tau[4], c2, s = broadcast<Lanes>(1.0), rate = broadcast<Lanes>(2.0);
  const double gradient[4] = {3, 1, -0.5, -4};
  for (int e = 0; e < 4; ++e) {
    l[e] = broadcast<Lanes>(gradient[e]);
    f[e] = broadcast<Lanes>(e % 3 == 0 ? 1.0 : 0.0);
  }
  std::vector<double> dissipated(kLanes, 0.0), plastic(kLanes, 0.0), elastic(4 * kLanes), volume(kLanes, 1.0);
  StateView<2> view{};
  view.dissipated = dissipated.data();
  view.plastic_strain = plastic.data();
  view.volume_ratio = volume.data();
  for (int c = 0; c < 4; ++c) {
    view.elastic_strain[c] = elastic.data() + c * kLanes;
    std::fill_n(view.elastic_strain[c], kLanes, c < 3 ? 1.0 : 0.0);
  }
  Mat<3> full = Mat<3>::Zero();
  full.topLeftCorner<2, 2>() << gradient[0], gradient[1], gradient[2], gradient[3];
  full(2, 2) = 2;
  Lanes all[6];
  for (int step = 0; step < 20; ++step) {
    solid.strain(full, 1e-3);
    store_lanes(volume.data(), advance_hoop(view, steel, l, rate, 1e-3, 2, 0, kLanes, f, s, all, c2));
  }
  for (int c = 0; c < 4; ++c) {
    tau[c] = all[c];
    CHECK(double{tau[c][kLanes - 1]} == doctest::Approx(solid.tau[c]).epsilon(1e-12));
  }
  CHECK(plastic[0] > 0.01);
  CHECK(plastic[0] == doctest::Approx(solid.state.plastic_strain).epsilon(1e-12));
  CHECK(double{s[0]} == doctest::Approx(solid.f[8]).epsilon(1e-14));
  CHECK(volume[0] == doctest::Approx(solid.volume()).epsilon(1e-13));
}

}  // namespace
}  // namespace mpmfast
