#pragma once

/// @file Surfaces of bodies for penalty contact (K24 §3.5). Boundary points are particles; how facets connect
/// them is here.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/geometry/outline.hpp"
#include "kernels/dimension.hpp"

namespace mpmfast {

/// Memory that vectors reserve, bytes.
template <class... Vectors>
std::size_t bytes_of(const Vectors&... vectors) {
  return (0 + ... + (vectors.capacity() * sizeof(typename Vectors::value_type)));
}

/// Memory of the elements of vectors, bytes: the system gives no pages for reserved memory before its use.
template <class... Vectors>
std::size_t bytes_in(const Vectors&... vectors) {
  return (0 + ... + (vectors.size() * sizeof(typename Vectors::value_type)));
}

/// Facets between the boundary points of all bodies. Points are numbered over all bodies, those of a body in
/// sequence.
template <int Dim>
struct Surfaces {
  struct Facet {
    std::array<int, Dim> point;        ///< its corners
    std::array<int, Dim> normal_cone;  ///< of each corner
    std::array<Joint, Dim> joint;      ///< as Outline::Facet
    int body;
    int patch;    ///< the smooth part of a surface that it belongs to, numbered over all bodies
    double area;  ///< undeformed, m²
  };
  /// Vertex normal cone: the facets of one patch at one point. They share a normal there, the mean of theirs.
  struct NormalCone {
    int point;
    int begin, end;  ///< into cone_facets
  };
  struct Body {
    std::uint32_t first_id{};  ///< of its boundary points, which are the last of its particles
    int first{}, count{};      ///< numbers of its boundary points
  };
  std::vector<Body> bodies;
  std::vector<int> point_body;  ///< by point
  std::vector<Facet> facets;
  std::vector<NormalCone> normal_cones;
  std::vector<int> cone_facets;

  bool empty() const { return point_body.empty(); }
  std::size_t points() const { return point_body.size(); }
  const Facet& facet(int f) const { return facets[static_cast<std::size_t>(f)]; }
  const NormalCone& normal_cone(int c) const { return normal_cones[static_cast<std::size_t>(c)]; }
  const Body& body_of(int point) const {
    return bodies[static_cast<std::size_t>(point_body[static_cast<std::size_t>(point)])];
  }
  /// Number of the boundary point that a particle is; −1 of other particles.
  int number(int body, std::uint32_t id) const {
    const Body& b = bodies[static_cast<std::size_t>(body)];
    return id >= b.first_id && b.count > 0 ? b.first + static_cast<int>(id - b.first_id) : -1;
  }
  /// Is this particle a boundary point?
  bool holds(int body, std::uint32_t id) const { return !empty() && number(body, id) >= 0; }
  std::size_t bytes() const { return bytes_of(bodies, point_body, facets, normal_cones, cone_facets); }
};

}  // namespace mpmfast
