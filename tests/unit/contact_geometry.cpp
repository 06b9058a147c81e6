// Normals and separations of whole scenes, by every method, where geometry alone says what they are.

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

/// Two blocks of 8 × 4 cells that touch at y = `plane` cells and press on each other.
std::string stacked(double plane) {
  const auto y = [&](double v) { return std::to_string(v) + " m"; };
  return "space: plane_strain\n"
         "grid: {origin: [-4 m, -8 m], size: [20 m, 20 m], cell: 1 m}\n"
         "time: {end: 1 s}\n"
         "materials: {m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}\n"
         "bodies:\n"
         "  - {name: low, box: {from: [0 m, " +
         y(plane - 4) + "], to: [8 m, " + y(plane) +
         "]}, material: m, velocity: [0 m/s, 1 m/s]}\n"
         "  - {name: high, box: {from: [0 m, " +
         y(plane) + "], to: [8 m, " + y(plane + 4) + "]}, material: m, velocity: [0 m/s, -1 m/s]}\n";
}

Scene contact_scene(double plane, const std::string& contact) {
  return scene_from(stacked(plane) + "contact: " + contact + "\n");
}

/// Calls f(node, geometry, sign) for the pairs between x = 1 and 7 cells; sign: +1 where a is the lower
/// block.
template <class F>
int for_inner_pairs(const Step<2>& step, F f) {
  int count = 0;
  const auto& list = step.contact_list();
  for (const auto& node : list.nodes) {
    if (node.index[0] < 5 || node.index[0] > 11) continue;
    for (int e = node.pair_begin; e < node.pair_end; ++e) {
      const int field = list.fields[node.field_begin + list.pairs.pair[e].a].field;
      f(node, list.pairs.geometry[e], field == 0 ? 1.0 : -1.0);
      ++count;
    }
  }
  return count;
}

TEST_CASE("on a flat interface every method finds its normal, from a to b") {
  for (const char* normal :
       {"logistic_regression", "smoothed_logistic_regression", "logistic_irls", "linear_regression",
        "average_gradient", "max_gradient", "max_volume", "own_gradient", "specified"})
    for (const double plane : {0.0, 0.5}) {
      CAPTURE(std::string(normal));
      CAPTURE(plane);
      const Scene scene =
          contact_scene(plane, std::string("{specified_normal: [0, 1], normal: ") + normal + "}");
      Step<2> step(scene);
      step.advance(step.stable_dt());
      const int pairs = for_inner_pairs(step, [&](const auto&, const auto& geometry, double sign) {
        CHECK(geometry.normal[1] == doctest::Approx(sign).epsilon(1e-9));
        CHECK(std::abs(geometry.normal[0]) < 1e-6);
      });
      CHECK(pairs > 6);
    }
}

TEST_CASE("own gradients give each field a pair of its own, all others one for two fields") {
  const Scene own = contact_scene(0, "{normal: own_gradient}"),
              pair = contact_scene(0, "{normal: average_gradient}");
  Step<2> a(own), b(pair);
  a.advance(a.stable_dt());
  b.advance(b.stable_dt());
  CHECK(a.contact_list().nodes.size() == b.contact_list().nodes.size());
  CHECK(a.contact_list().pairs.size() == 2 * b.contact_list().pairs.size());
}

TEST_CASE("touching surfaces: separations by domains and by displacement vanish, by position nearly") {
  struct Known {
    const char* separation;
    double tolerance;  // cells
  };
  for (const Known& known :
       {Known{"ellipsoid", 1e-9}, Known{"ellipsoid_support", 1e-9}, Known{"parallelogram_support", 1e-9},
        Known{"displacement", 1e-12}, Known{"position_offset", 0.3}, Known{"position_power", 0.05},
        Known{"position_piecewise", 0.06}}) {
    CAPTURE(std::string(known.separation));
    const Scene scene =
        contact_scene(0.25, std::string("{normal: specified, specified_normal: [0, 1], separation: ") +
                                known.separation + "}");
    Step<2> step(scene);
    step.advance(step.stable_dt());
    const int pairs = for_inner_pairs(step, [&](const auto& node, const auto& geometry, double) {
      if (node.index[1] != 8) return;  // the row nearest to the interface: others see one side whole
      CHECK(std::abs(geometry.separation) < known.tolerance);
    });
    CHECK(pairs > 6);
  }
}

TEST_CASE("displacements measure how far the surfaces have come") {
  const Scene seen =
      contact_scene(0, "{normal: specified, specified_normal: [0, 1], separation: displacement}");
  Step<2> step(seen);
  const double dt = step.stable_dt();
  step.advance(dt);  // surfaces that just touch do not overlap: the blocks approach freely at 2 m/s
  step.advance(dt);
  const int pairs = for_inner_pairs(step, [&](const auto&, const auto& geometry, double) {
    CHECK(std::abs(geometry.separation / (-2 * dt) - 1) < 1e-9);
  });
  CHECK(pairs > 6);
  const Scene unseen = contact_scene(0, "{law: ignore}");
  Step<2> other(unseen);
  CHECK_FALSE(other.state().particles.has(Quantity::reference_position));
}

/// Momentum along y, kg m/s of 1 m, that the upper of two blocks gives the lower one as it parts at 1 m/s,
/// the surfaces `gap` cells apart, right after the two have touched.
double pull_across(double gap, const std::string& hysteresis) {
  const Scene scene = contact_scene(
      0.25,
      "{normal: specified, specified_normal: [0, 1], detection: separation, hysteresis: " + hysteresis + "}");
  Step<2> step(scene);
  const auto start = by_id(step.state().particles, Quantity::position);
  advance(step, 5);  // now they touch
  auto& particles = step.state().particles;
  const auto is_upper = [&](std::size_t p) { return start[2 * particles.id()[p] + 1] > 0.25; };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (int d = 0; d < 2; ++d) {
      particles.column(Quantity::position, d)[p] = start[2 * particles.id()[p] + static_cast<std::size_t>(d)];
      particles.column(Quantity::velocity, d)[p] = d == 1 && is_upper(p) ? 1 : 0;
    }
    if (is_upper(p)) particles.column(Quantity::position, 1)[p] += gap;
    for (int k = 0; k < 4; ++k) particles.column(Quantity::deformation_gradient, k)[p] = k % 3 == 0;
  }
  advance(step, 1);
  double given = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (!is_upper(p))
      given += particles.column(Quantity::mass)[p] * particles.column(Quantity::velocity, 1)[p];
  return given;
}

TEST_CASE("what touches goes on touching up to the gap that the hysteresis says, and no further") {
  CHECK(std::abs(pull_across(0.1, "0")) < 1e-9);
  CHECK(std::abs(pull_across(0.1, "0.08")) < 1e-9);
  CHECK(pull_across(0.1, "0.12") > 100);  // a row of nodes takes the mean velocity: some 10 % of 32 t m/s
}

TEST_CASE("a volume screen drops the edge nodes, and contact without one keeps them") {
  const Scene open = contact_scene(0, "{volume_screen: 0}"),
              screened = contact_scene(0, "{volume_screen: 0.9}");
  Step<2> a(open), b(screened);
  a.advance(a.stable_dt());
  b.advance(b.stable_dt());
  CHECK(b.contact_list().nodes.size() < a.contact_list().nodes.size());
  CHECK(b.contact_list().nodes.size() >= 7);
  CHECK_FALSE(a.state().nodes.has(Nodal::volume));
  const ContactCounters &all = a.contact_counters(), &some = b.contact_counters();
  CHECK(all.screened == 0);
  CHECK(all.meetings == a.contact_list().nodes.size());
  CHECK(some.meetings == all.meetings);
  CHECK(some.screened == a.contact_list().nodes.size() - b.contact_list().nodes.size());
}

TEST_CASE("a mass screen counts the nodes that it leaves without contact, step by step") {
  const Scene scene = contact_scene(0.25, "{mass_screen: 0.1}");
  Step<2> step(scene);
  step.advance(step.stable_dt());
  const std::uint64_t first = step.contact_counters().screened;
  CHECK(first > 0);
  CHECK(first == step.contact_counters().meetings - step.contact_list().nodes.size());
  step.advance(step.stable_dt());
  CHECK(step.contact_counters().screened > first);
}

TEST_CASE(
    "with rigid bias the normal against a rigid body is its own gradient's, at the block's corner too") {
  const std::string scene = R"(
space: plane_strain
grid: {origin: [-4 m, -8 m], size: [20 m, 20 m], cell: 1 m}
time: {end: 1 s}
materials:
  m: {model: neo_hookean, density: 1000 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  r: {model: rigid}
bodies:
  - {name: block, box: {from: [0 m, -4 m], to: [7.3 m, 0 m]}, material: m, velocity: [0 m/s, 1 m/s]}
  - {name: plate, box: {from: [-3 m, 0 m], to: [12 m, 2 m]}, material: r}
)";
  const auto worst_tilt = [&](const std::string& contact) {
    const Scene read = scene_from(scene + "contact: {" + contact + "}\n");
    Step<2> step(read);
    step.advance(step.stable_dt());
    double worst = 0;
    for (const auto& geometry : step.contact_list().pairs.geometry)
      worst = std::max(worst, std::abs(geometry.normal[0]));
    return worst;
  };
  CHECK(worst_tilt("normal: average_gradient") > 0.05);
  CHECK(worst_tilt("normal: average_gradient, rigid_bias: 1000") < 1e-12);
  CHECK(worst_tilt("normal: linear_regression") > 0.05);
  CHECK(worst_tilt("normal: linear_regression, rigid_bias: 5") > 0.05);  // below 10: gradients alone
  CHECK(worst_tilt("normal: linear_regression, rigid_bias: 1000") < 1e-12);
}

// Warm normals are within the tolerance of the least objective, 1 − n'·n < 1e-5 or 4.5e-3 rad; over the path
// of 0.14 m that bends positions by 6e-4 m at most, 5e-5 of the scene's size. Measured: 6e-6.
TEST_CASE("a scene with warm starts keeps the normals and the motion of one with converged cold starts") {
  const std::string contact = "{friction: 0.2, normal: smoothed_logistic_regression, warm_start: ";
  const Scene warm_scene = contact_scene(0.2, contact + "true, penalty: 0.01}"),
              cold_scene = contact_scene(
                  0.2, contact + "false, penalty: 0.01, tolerance: 1e-14, max_iterations: 200}");
  Step<2> warm(warm_scene), cold(cold_scene);
  for (int k = 0; k < 100; ++k) {
    const double dt = cold.stable_dt();
    warm.advance(dt);
    cold.advance(dt);
  }
  REQUIRE(warm.contact_list().pairs.size() == cold.contact_list().pairs.size());
  for (std::size_t e = 0; e < cold.contact_list().pairs.size(); ++e)
    CHECK(1 - warm.contact_list().pairs.geometry[e].normal.dot(cold.contact_list().pairs.geometry[e].normal) <
          2e-5);
  CHECK(relative_difference(by_id(warm.state().particles, Quantity::position),
                            by_id(cold.state().particles, Quantity::position)) < 5e-5);
  CHECK(warm.contact_counters().iterations < cold.contact_counters().iterations);
}

}  // namespace
}  // namespace mpmfast
