#include "engine/step/basis_passes.hpp"
#include "kernels/basis/cpdi.hpp"

namespace mpmfast {

template <int Dim>
std::unique_ptr<Passes<Dim>> make_lcpdi_passes() {
  return std::make_unique<BasisPasses<Dim, LcpdiBasis<Dim>>>();
}
template std::unique_ptr<Passes<2>> make_lcpdi_passes<2>();
template std::unique_ptr<Passes<3>> make_lcpdi_passes<3>();

}  // namespace mpmfast
