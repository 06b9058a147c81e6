#include "kernels/contact/delassus_operator.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <random>
#include <vector>

namespace {

using namespace mpmfast;

/// The Delassus operator of contacts among `fields` fields, and the matrix of their equations, written out
/// one by one.
template <int Dim>
struct Case {
  DelassusOperator<Dim> delassus;
  std::vector<typename DelassusOperator<Dim>::Row> all;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd left;

  Case(int fields, int count, std::mt19937_64& draw) : matrix(count, count), left(count) {
    std::normal_distribution<double> gauss;
    std::uniform_int_distribution<int> pick(0, fields - 1);
    std::vector<double> inverse;
    for (int f = 0; f < fields; ++f) inverse.push_back(std::exp(gauss(draw)));
    const auto direction = [&] {
      Vec<Dim> v;
      for (int d = 0; d < Dim; ++d) v[d] = gauss(draw);
      return Vec<Dim>(v.normalized());
    };
    for (int i = 0; i < count; ++i) {
      const int a = pick(draw), b = (a + 1 + pick(draw) % (fields - 1)) % fields;
      const double one = inverse[static_cast<std::size_t>(a)], two = inverse[static_cast<std::size_t>(b)];
      const Vec<Dim> along = direction();
      all.push_back({i, a, b, one / (one + two), two / (one + two), along, along, gauss(draw)});
      delassus.push(all.back());
      left[i] = all.back().residual;
    }
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const auto &k = all[static_cast<std::size_t>(i)], &l = all[static_cast<std::size_t>(j)];
        const double share =
            k.share_a * ((l.a == k.a) - (l.b == k.a)) + k.share_b * ((l.b == k.b) - (l.a == k.b));
        matrix(i, j) = share * k.motion.dot(l.impulse);
      }
  }
};

}  // namespace

TEST_CASE_TEMPLATE("the impulses of any number of delassus end all that they hinder", D,
                   std::integral_constant<int, 2>, std::integral_constant<int, 3>) {
  constexpr int kDim = D::value;
  std::mt19937_64 draw(11);
  for (int count : {1, 2, 3, 7, 8, 9, 12, 15, 16, 17, 20, 33}) {
    CAPTURE(count);
    Case<kDim> some(count + 1, count, draw);  // more fields than contacts: hardly any follows from the others
    Eigen::VectorXd found = Eigen::VectorXd::Zero(count);
    CHECK(some.delassus.solve());
    some.delassus.for_each_change([&](int k, const Vec<kDim>& change) {
      found[k] += change.dot(some.all[static_cast<std::size_t>(k)].impulse);
    });
    CHECK((some.matrix * found - some.left).norm() < 1e-8 * (1 + found.norm()));
  }
}

TEST_CASE("a hindrance that follows from those before gets no impulse, and no other is lost") {
  // Also where what is left of its motion differs from theirs, by round-off or more.
  for (const double more : {0.0, 1e-15, -1e-9, 0.5})
    for (int copies : {1, 4, 8, 15, 40}) {
      CAPTURE(copies);
      CAPTURE(more);
      DelassusOperator<2> h;
      for (int k = 0; k <= copies; ++k) h.push({k, 0, 1, 0.25, 0.75, {1, 0}, {1, 0}, 2.0 + more * k});
      h.push({copies + 1, 0, 1, 0.25, 0.75, {0, 1}, {0, 1}, 3.0});
      CHECK(h.solve());
      h.for_each_change([&](int k, const Vec<2>& change) {
        CHECK(change == (k == 0 ? Vec<2>(2, 0) : k == copies + 1 ? Vec<2>(0, 3) : Vec<2>(0, 0)));
      });
    }
}
