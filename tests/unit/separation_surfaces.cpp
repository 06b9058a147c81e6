/// Distances between surfaces: from ellipsoids (N20 Eq. 24, 25) and from the grid.

#include <doctest/doctest.h>

#include "kernels/contact/separation.hpp"
#include "tests/unit/contact_cloud.hpp"

using namespace mpmfast;
using namespace mpmfast::test;

namespace {

using TwoD = std::integral_constant<int, 2>;
using ThreeD = std::integral_constant<int, 3>;

template <int Dim>
Mat<Dim> random_deformation(Draw& draw) {
  Mat<Dim> f;
  do {
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) f(i, j) = (i == j) + uniform(draw, -0.6, 0.6);
  } while (f.determinant() < 0.2);
  return f;
}

template <int Dim>
void row_major(const Mat<Dim>& m, double (&out)[Dim * Dim]) {
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) out[Dim * i + j] = m(i, j);
}

/// F diag(R0), row-major.
template <int Dim>
void half_edges(const Mat<Dim>& f, const double (&half_size)[Dim], double (&out)[Dim * Dim]) {
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) out[Dim * i + j] = f(i, j) * half_size[j];
}

template <int Dim, Extent E = Extent::radial>
double radius(const Mat<Dim>& f, const double (&half_size)[Dim], const Vec<Dim>& n) {
  double edges[Dim * Dim];
  half_edges<Dim>(f, half_size, edges);
  double shape[shape_size<Dim>(E)];
  domain_shape<E, Dim>(edges, shape);
  return extent_along<E, Dim>(shape, n);
}

/// How far spheres reach along n, of one class.
template <int Dim>
double reach_of(const Cloud<Dim>& cloud, const std::vector<double>& radii, double side, const Vec<Dim>& n) {
  constexpr int kShape = shape_size<Dim>(Extent::radial);
  std::vector<double> xi[Dim], shape[kShape];
  CloudColumns<Dim> columns{};
  for (std::size_t p = 0; p < static_cast<std::size_t>(cloud.count); ++p) {
    if (cloud.side[p] != side) continue;
    ++columns.count;
    for (std::size_t d = 0; d < Dim; ++d) xi[d].push_back(cloud.xi[d][p]);
    double edges[Dim * Dim], numbers[kShape];
    row_major<Dim>(radii[p] * Mat<Dim>::Identity(), edges);
    domain_shape<Extent::radial, Dim>(edges, numbers);
    for (int e = 0; e < kShape; ++e) shape[e].push_back(numbers[e]);
  }
  const auto finish = [&](std::vector<double>& column) {  // what follows does not count
    column.resize(column.size() + kLanes, 99.0);
    return column.data();
  };
  for (int d = 0; d < Dim; ++d) columns.xi[d] = finish(xi[d]);
  for (int e = 0; e < kShape; ++e) columns.shape[e] = finish(shape[e]);
  return reach_along<Extent::radial>(columns, n).value;
}

template <int Dim>
double separation_of(const Cloud<Dim>& cloud, const std::vector<double>& radii, const Vec<Dim>& n) {
  return -reach_of<Dim>(cloud, radii, -1.0, n) - reach_of<Dim>(cloud, radii, 1.0, -n);
}

}  // namespace

TEST_CASE_TEMPLATE("the inverse of a deformation gradient is its inverse", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(1);
  for (int k = 0; k < 100; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    double rows[Dim * Dim], inverse[Dim * Dim], expected[Dim * Dim];
    row_major<Dim>(f, rows);
    invert<Dim>(rows, inverse);
    row_major<Dim>(f.inverse(), expected);
    for (int e = 0; e < Dim * Dim; ++e) CHECK(inverse[e] == doctest::Approx(expected[e]).epsilon(1e-12));
  }
}

TEST_CASE_TEMPLATE("the point R n lies on the deformed ellipsoid", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(2);
  for (int k = 0; k < 200; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    double half_size[Dim];
    for (double& h : half_size) h = uniform(draw, 0.1, 0.4);
    // The ray through a known point of the surface must find that point's distance.
    Vec<Dim> material = random_direction<Dim>(draw);
    for (int d = 0; d < Dim; ++d) material[d] *= half_size[d];
    const Vec<Dim> point = f * material;
    CHECK(radius<Dim>(f, half_size, point.normalized()) == doctest::Approx(point.norm()).epsilon(1e-12));
  }
}

TEST_CASE_TEMPLATE("undeformed: a sphere has its radius, a box its half-size along each axis", D, TwoD,
                   ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(3);
  double sphere[Dim], box[Dim];
  for (int d = 0; d < Dim; ++d) {
    sphere[d] = 0.25;
    box[d] = 0.1 + 0.07 * d;
  }
  for (int k = 0; k < 50; ++k)
    CHECK(radius<Dim>(Mat<Dim>::Identity(), sphere, random_direction<Dim>(draw)) ==
          doctest::Approx(0.25).epsilon(1e-14));
  for (int d = 0; d < Dim; ++d)
    CHECK(radius<Dim>(Mat<Dim>::Identity(), box, Vec<Dim>::Unit(d)) ==
          doctest::Approx(box[d]).epsilon(1e-14));
}

TEST_CASE("a stretched circle has the ellipse's radius in every direction, turned or not") {
  const double half_size[2] = {0.25, 0.25};
  for (int k = 0; k < 36; ++k) {
    const double angle = 0.1745 * k, turn = 0.7;
    const double a = 0.25 * 1.8, b = 0.25 * 0.6;  // semi-axes
    const Mat<2> stretch = Vec<2>(1.8, 0.6).asDiagonal(),
                 rotation = Eigen::Rotation2Dd(turn).toRotationMatrix();
    const double expected = a * b / std::hypot(b * std::cos(angle - turn), a * std::sin(angle - turn));
    const double found = radius<2>(rotation * stretch, half_size, {std::cos(angle), std::sin(angle)});
    CHECK(found == doctest::Approx(expected).epsilon(1e-13));
  }
}

TEST_CASE_TEMPLATE("lanes of radii equal the radii one by one", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(4);
  const Vec<Dim> n = random_direction<Dim>(draw);
  Lanes edges[Dim * Dim];
  double expected[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    double rows[Dim * Dim], h[Dim];
    const Mat<Dim> m = random_deformation<Dim>(draw);
    for (double& size : h) size = uniform(draw, 0.1, 0.4);
    half_edges<Dim>(m, h, rows);
    for (int e = 0; e < Dim * Dim; ++e) edges[e][i] = rows[e];
    expected[i] = radius<Dim>(m, h, n);
  }
  Lanes shape[shape_size<Dim>(Extent::radial)];
  domain_shape<Extent::radial, Dim>(edges, shape);
  const Lanes found = extent_along<Extent::radial, Dim>(shape, n);
  for (int i = 0; i < kLanes; ++i) CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-13));
}

TEST_CASE_TEMPLATE(
    "the extents of a domain are those of its furthest corner and of its ellipsoid's furthest point", D, TwoD,
    ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(41);
  for (int k = 0; k < 50; ++k) {
    const Mat<Dim> f = random_deformation<Dim>(draw);
    const Vec<Dim> n = random_direction<Dim>(draw);
    double half_size[Dim], corner = 0, point = 0;
    for (double& h : half_size) h = uniform(draw, 0.1, 0.4);
    const Vec<Dim> size = Eigen::Map<const Vec<Dim>>(half_size);
    for (int c = 0; c < power(2, Dim); ++c) {
      Vec<Dim> x = size;
      for (int d = 0; d < Dim; ++d) x[d] *= (c >> d & 1) ? 1 : -1;
      corner = std::max(corner, n.dot(f * x));
    }
    for (int i = 0; i < 20000; ++i) {
      const Vec<Dim> x = size.cwiseProduct(random_direction<Dim>(draw));
      point = std::max(point, n.dot(f * x));
    }
    const double ellipsoid = radius<Dim, Extent::ellipsoid>(f, half_size, n);
    CHECK(radius<Dim, Extent::parallelepiped>(f, half_size, n) == doctest::Approx(corner).epsilon(1e-13));
    CHECK(ellipsoid >= point);
    CHECK(ellipsoid < 1.01 * point);  // twenty thousand points come this near
    CHECK(radius<Dim>(f, half_size, n) <= ellipsoid * (1 + 1e-14));
  }
}

TEST_CASE_TEMPLATE("two spheres are as far apart as their centres less their radii", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(5);
  for (int k = 0; k < 50; ++k) {
    const Vec<Dim> n = random_direction<Dim>(draw), a = 0.4 * random_direction<Dim>(draw);
    const double distance = uniform(draw, 0.2, 1.0), r_a = uniform(draw, 0.1, 0.3),
                 r_b = uniform(draw, 0.1, 0.3);
    Cloud<Dim> cloud;
    cloud.add(a, -1.0);
    cloud.add(a + distance * n, 1.0);
    std::vector<double> radii(static_cast<std::size_t>(padded_count(2)), 99.0);
    radii[0] = r_a;
    radii[1] = r_b;
    CHECK(std::abs(separation_of<Dim>(cloud, radii, n) - (distance - r_a - r_b)) < 1e-10);
  }
}

TEST_CASE_TEMPLATE("a cloud's separation is that of its foremost surfaces", D, TwoD, ThreeD) {
  constexpr int Dim = D::value;
  Draw draw(6);
  for (int k = 0; k < 50; ++k) {
    const Mat<Dim> r = rotation_to<Dim>(random_direction<Dim>(draw), draw);
    const auto cloud = touching_blocks<Dim>(r, 0.1, 0.2, 1.25, draw);
    std::vector<double> radii(cloud.side.size(), 99.0);
    double front = -1e300, back = 1e300;
    for (std::size_t p = 0; p < static_cast<std::size_t>(cloud.count); ++p) {
      radii[p] = uniform(draw, 0.1, 0.3);
      double along = 0;
      for (std::size_t d = 0; d < Dim; ++d) along += cloud.xi[d][p] * r(static_cast<int>(d), 0);
      if (cloud.side[p] < 0)
        front = std::max(front, along + radii[p]);
      else
        back = std::min(back, along - radii[p]);
    }
    CHECK(std::abs(separation_of<Dim>(cloud, radii, r.col(0)) - (back - front)) < 1e-12);
  }
  CHECK(std::isinf(separation_of<Dim>({}, {}, Vec<Dim>::Unit(0))));
}

TEST_CASE("touching lattices of spheres have no separation, and lattices a gap apart have that gap") {
  Draw draw(7);
  for (const double gap : {0.0, 0.3, -0.05}) {
    const Mat<2> r = rotation_to<2>(random_direction<2>(draw), draw);
    Cloud<2> cloud;
    for (int i = -3; i < 3; ++i)
      for (int j = -3; j < 3; ++j)
        cloud.add(r * Vec<2>(0.5 * i + 0.25 + (i < 0 ? 0.0 : gap), 0.5 * j), i < 0 ? -1.0 : 1.0);
    const std::vector<double> radii(cloud.side.size(), 0.25);
    CHECK(std::abs(separation_of<2>(cloud, radii, r.col(0)) - gap) < 1e-10);
  }
}

TEST_CASE(
    "separations by the grid: zero at the calibrated distance, growing, mirrored, finite past the node") {
  CHECK(position_offset(-0.4, 0.4, 0.8) == doctest::Approx(0.0));
  CHECK(position_offset(-0.5, 0.6, 0.8) == doctest::Approx(0.3));
  // Each surface reaches the node where 2 (e/1.25)^0.58 = 1.
  const double touching = 1.25 * std::pow(0.5, 1.0 / 0.58);
  CHECK(std::abs(position_power(-touching, touching)) < 1e-14);
  CHECK(position_power(-1.25, 1.25) == doctest::Approx(2.0));
  for (double e = -0.5; e < 1.2; e += 0.05) {
    CHECK(position_power(-0.3, e + 0.05) > position_power(-0.3, e));
    CHECK(position_power(-e, 0.4) == doctest::Approx(position_power(-0.4, e)));
    CHECK(std::isfinite(position_power(e, e)));
  }
}

TEST_CASE(
    "the piecewise separations are continuous at their joints, odd at the node, and right where they are "
    "linear") {
  for (const int particles : {1, 2}) {
    CAPTURE(particles);
    const double joint = particles == 1 ? 0.5 : 0.75, offset = particles == 1 ? 0.5 : 0.25;
    const double below = position_piecewise(-joint, joint * (1 - 1e-12), particles),
                 above = position_piecewise(-joint, joint * (1 + 1e-12), particles);
    CHECK(std::abs(below - above) < 1e-10);
    // Surfaces at e = 1.25 − offset cells from the particle edge: the mean lies on a row of particle centres.
    CHECK(position_piecewise(-1.2, 1.1, particles) == doctest::Approx(2.3 - 2 * offset));
    CHECK(position_piecewise(0.0, 0.0, particles) == doctest::Approx(-2.0));  // both fill both cells
    for (double e = -0.6; e < 1.2; e += 0.05) {
      CHECK(position_piecewise(-0.3, e + 0.05, particles) > position_piecewise(-0.3, e, particles));
      CHECK(position_piecewise(-e, 0.4, particles) ==
            doctest::Approx(position_piecewise(-0.4, e, particles)));
    }
  }
}

TEST_CASE(
    "the piecewise fit finds a surface that GIMP extrapolates within 0.03 cells, "
    "as the power law does") {
  // A row of particles, two a cell, whose foremost edge lies at d from the node: mean position by uGIMP.
  const auto mean_of = [](double d) {
    double mass = 0, moment = 0;
    for (int p = 0; p < 8; ++p) {
      const double x = d - 0.25 - 0.5 * p, l = 0.25, a = std::abs(x);
      const double s = a < l       ? 1 - (x * x + l * l) / (2 * l)
                       : a < 1 - l ? 1 - a
                       : a < 1 + l ? (1 + l - a) * (1 + l - a) / (4 * l)
                                   : 0;
      mass += s;
      moment += s * x;
    }
    return moment / mass;
  };
  double piecewise = 0, power = 0;
  for (double d = -0.95; d < 0.75; d += 0.05) {
    const double e = mean_of(d);
    // Against a surface at the node itself (b's half: e_b where its distance is zero) the sum is −d.
    const double b_zero_piecewise = 0.75 * std::pow(2.0 / 3.0, 1 / 0.5546),
                 b_zero_power = 1.25 * std::pow(0.5, 1 / 0.58);
    const double error = std::abs(position_piecewise(e, b_zero_piecewise, 2) + d);
    piecewise = std::max(piecewise, error);
    if (d < -0.501) CHECK(error < 1e-12);  // one column of particles in the support: its centre is the mean
    power = std::max(power, std::abs(position_power(e, b_zero_power) + d));
  }
  CHECK(piecewise < 0.03);  // measured 0.028
  CHECK(power < 0.03);      // measured 0.026: better where more columns count, worse where one does
}
