#include "engine/step/passes.hpp"

namespace mpmfast {

// Each is compiled in a file of its own: passes_<basis>.cpp.
template <int Dim>
std::unique_ptr<Passes<Dim>> make_linear_passes();
template <int Dim>
std::unique_ptr<Passes<Dim>> make_ugimp_passes();
template <int Dim>
std::unique_ptr<Passes<Dim>> make_lcpdi_passes();
template <int Dim>
std::unique_ptr<Passes<Dim>> make_qcpdi_passes();
template <int Dim>
std::unique_ptr<Passes<Dim>> make_bspline2_passes();
template <int Dim>
std::unique_ptr<Passes<Dim>> make_bspline3_passes();

template <int Dim>
std::unique_ptr<Passes<Dim>> make_passes(BasisKind basis) {
  switch (basis) {
    case BasisKind::linear:
      return make_linear_passes<Dim>();
    case BasisKind::ugimp:
      return make_ugimp_passes<Dim>();
    case BasisKind::lcpdi:
      return make_lcpdi_passes<Dim>();
    case BasisKind::qcpdi:
      return make_qcpdi_passes<Dim>();
    case BasisKind::bspline2:
      return make_bspline2_passes<Dim>();
    case BasisKind::bspline3:
      return make_bspline3_passes<Dim>();
  }
  return nullptr;
}
template std::unique_ptr<Passes<2>> make_passes<2>(BasisKind);
template std::unique_ptr<Passes<3>> make_passes<3>(BasisKind);

}  // namespace mpmfast
