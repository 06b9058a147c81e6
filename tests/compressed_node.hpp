#pragma once

/// @file Fields around a node that are pressed together, for tests and benchmarks of their contacts.

#include <cmath>
#include <random>
#include <vector>

#include "kernels/contact/node_solver.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// Each field leaves a place of its own for the node; all pairs are in contact, with normals from place to
/// place.
template <int Dim>
struct CompressedNode {
  std::vector<MovingField<Dim>> fields;
  std::vector<FieldContact<Dim>> contacts;

  CompressedNode() = default;
  /// @param orders  of magnitude that the masses span, 1 kg at most: the corners of grains have some four
  template <class Generator>
  CompressedNode(int count, double orders, Generator& draw) {
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> exponent(-orders, 0);
    const auto vector = [&] {
      Vec<Dim> v;
      for (int d = 0; d < Dim; ++d) v[d] = gauss(draw);
      return v;
    };
    std::vector<Vec<Dim>> places;
    for (int k = 0; k < count; ++k) {
      places.push_back(vector());
      fields.push_back({vector() - places.back(), std::pow(10.0, -exponent(draw))});
    }
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        add_contact(a, b, places[static_cast<std::size_t>(b)] - places[static_cast<std::size_t>(a)]);
  }

  /// @param along  the normal, of any length
  void add_contact(int a, int b, const Vec<Dim>& along) {
    const double inverse =
        fields[static_cast<std::size_t>(a)].inverse_mass + fields[static_cast<std::size_t>(b)].inverse_mass;
    contacts.push_back({a, b, along.normalized(), 1 / inverse});
  }
};

}  // namespace mpmfast
