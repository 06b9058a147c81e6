#include "engine/cracks/crack_sides.hpp"

#include "engine/constants.hpp"

namespace mpmfast {

template <int Dim>
CrackContact<Dim> contact_at(const CrackedNode<Dim>* node, int k, int side_a, int side_b) {
  if (!node || element(node->crack, k) < 0) return {};
  const double length = element(node->normal, k).norm();
  if (!(length > crack_constants::kLeastNormal)) return {};
  const Vec<Dim> left = element(node->normal, k) / length;
  const int bit = 1 << k;
  const bool from_left = (side_a & bit) == 0;
  return {element(node->crack, k), from_left ? Vec<Dim>(-left) : left, (side_a & side_b & ~bit) != 0};
}

template CrackContact<2> contact_at(const CrackedNode<2>*, int, int, int);
template CrackContact<3> contact_at(const CrackedNode<3>*, int, int, int);

}  // namespace mpmfast
