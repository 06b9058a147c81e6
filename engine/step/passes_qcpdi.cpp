#include "engine/step/basis_passes.hpp"
#include "kernels/basis/cpdi.hpp"

namespace mpmfast {

template <int Dim>
std::unique_ptr<Passes<Dim>> make_qcpdi_passes() {
  return std::make_unique<BasisPasses<Dim, QcpdiBasis<Dim>>>();
}
template std::unique_ptr<Passes<2>> make_qcpdi_passes<2>();
template std::unique_ptr<Passes<3>> make_qcpdi_passes<3>();

}  // namespace mpmfast
