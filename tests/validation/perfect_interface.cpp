// A perfect interface must reproduce one field in every basis, in both dimensions (N20 §3.2; theory §2).

#include "tests/support.hpp"

namespace mpmfast {
namespace {

using namespace test;

template <int Dim>
const char* blocks() {
  if constexpr (Dim == 2)
    return R"(
space: plane_strain
grid: {origin: [-5 mm, -5 mm], size: [34 mm, 24 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm], to: [6.3 mm, 8.2 mm]}, material: m, velocity: [4 m/s, 1 m/s]}
  - {name: b, box: {from: [6.3 mm, 3.7 mm], to: [13.3 mm, 9.7 mm]}, material: m, velocity: [-5 m/s, -2 m/s]}
)";
  else
    return R"(
space: 3d
grid: {origin: [-4 mm, -4 mm, -4 mm], size: [20 mm, 14 mm, 14 mm], cell: 1 mm}
time: {end: 1 s}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: a, box: {from: [0.3 mm, 0.2 mm, 0.4 mm], to: [4.3 mm, 4.2 mm, 4.4 mm]}, material: m, velocity: [4 m/s, 1 m/s, 2 m/s]}
  - {name: b, box: {from: [4.3 mm, 1.7 mm, 1.2 mm], to: [9.3 mm, 5.7 mm, 4.2 mm]}, material: m, velocity: [-5 m/s, -2 m/s, 0 m/s]}
)";
}

/// Largest relative difference of positions, velocities and F after some steps.
template <int Dim>
double difference(const char* basis, const char* update, int steps, const char* strain = "average") {
  const std::vector<Override> own{
      {"method.basis", basis}, {"method.update", update}, {"method.strain", strain}};
  auto tied = own, alone = own;
  tied.push_back({"contact", "{law: perfect}"});
  alone.push_back({"contact", "none"});
  const Scene two_fields = scene_from(blocks<Dim>(), tied), one_field = scene_from(blocks<Dim>(), alone);
  Step<Dim> one(one_field), two(two_fields);
  REQUIRE(two.plan().fields.size() == 2);
  advance(one, steps);
  advance(two, steps);
  CHECK(two.contact_counters().nodes_peak > 0);
  double largest = 0;
  for (Quantity q : {Quantity::position, Quantity::velocity, Quantity::deformation_gradient})
    largest = std::max(largest,
                       relative_difference(by_id(two.state().particles, q), by_id(one.state().particles, q)));
  return largest;
}

template <int Dim>
void check_all_bases() {
  for (const char* basis : {"linear", "ugimp", "lcpdi", "bspline2"})
    for (const char* update : {"flip", "pic"}) {
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      // Particles that cross a cell's edge feel a jump of the linear basis, which enlarges round-off from
      // then on.
      const int steps = std::string(basis) == "linear" ? 20 : 100;
      CHECK(difference<Dim>(basis, update, steps) < 1e-12);
    }
}

TEST_CASE("a perfect interface reproduces one field in every basis (2-D)") { check_all_bases<2>(); }
TEST_CASE("a perfect interface reproduces one field in every basis (3-D)") { check_all_bases<3>(); }

template <int Dim>
void check_all_orders(const char* strain, double bound) {
  for (const char* basis : {"ugimp", "lcpdi", "bspline2"})
    for (const char* update : {"xpic(2)", "xpic(5)"}) {
      CAPTURE(std::string(strain));
      CAPTURE(std::string(basis));
      CAPTURE(std::string(update));
      const double found = difference<Dim>(basis, update, 100, strain);
      CHECK(found < bound);
      CHECK(found > 1e-6);
    }
}

TEST_CASE("with XPIC(m) a perfect interface differs from one field by its own filter alone") {
  // N20 Eq. 47 leaves S (S⁺ − S⁺^α)(V − S v): large only where the blow is, as here. Measured 0.018 to 0.057.
  // The viscosity of the averaged strain damps this rough difference; without it more is left: 0.027 to
  // 0.090.
  check_all_orders<2>("average", 0.08);
  check_all_orders<3>("average", 0.08);
  check_all_orders<2>("average+", 0.1);
  check_all_orders<3>("average+", 0.1);
}

}  // namespace
}  // namespace mpmfast
