#include "engine/step/basis_passes.hpp"
#include "kernels/basis/separable.hpp"

namespace mpmfast {

template <int Dim>
std::unique_ptr<Passes<Dim>> make_bspline3_passes() {
  return std::make_unique<BasisPasses<Dim, BSpline3Basis<Dim>>>();
}
template std::unique_ptr<Passes<2>> make_bspline3_passes<2>();
template std::unique_ptr<Passes<3>> make_bspline3_passes<3>();

}  // namespace mpmfast
