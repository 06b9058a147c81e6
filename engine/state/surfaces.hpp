#pragma once

/// @file Surfaces that penalty contact follows (K24 §3.5): boundary points are particles; what joins them is
/// here.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/geometry/outline.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// What vectors hold, and keep for more.
template <class... Vectors>
std::size_t bytes_of(const Vectors&... vectors) {
  return (0 + ... + (vectors.capacity() * sizeof(typename Vectors::value_type)));
}

/// What is in vectors: where they have room for more, the system gives no pages yet.
template <class... Vectors>
std::size_t bytes_in(const Vectors&... vectors) {
  return (0 + ... + (vectors.size() * sizeof(typename Vectors::value_type)));
}

template <int Dim>
struct Surfaces {
  struct Facet {
    std::array<int, Dim> point, wedge;
    std::array<Joint, Dim> joint;  ///< as Outline::Facet
    int body, piece;               ///< pieces are numbered over all bodies
    double area;                   ///< undeformed, m²
  };
  /// The corner of a piece of surface at one point: one normal, the mean of those of its facets.
  struct Wedge {
    int point, begin, end;  ///< into wedge_facets
  };
  struct Body {
    std::uint32_t first_id{};  ///< of its boundary points, which are the last of its particles
    int first{}, count{};      ///< their numbers
  };
  std::vector<Body> bodies;
  std::vector<int> point_body;
  std::vector<Facet> facets;
  std::vector<Wedge> wedges;
  std::vector<int> wedge_facets;

  bool empty() const { return point_body.empty(); }
  std::size_t points() const { return point_body.size(); }
  /// The number of a boundary point; −1 of a particle that is none.
  int number(int body, std::uint32_t id) const {
    const Body& b = bodies[static_cast<std::size_t>(body)];
    return id >= b.first_id && b.count > 0 ? b.first + static_cast<int>(id - b.first_id) : -1;
  }
  std::size_t bytes() const { return bytes_of(bodies, point_body, facets, wedges, wedge_facets); }
  bool holds(int body, std::uint32_t id) const { return !empty() && number(body, id) >= 0; }
};

}  // namespace mpmfast
