#include "engine/step/passes.hpp"

namespace mpmfast {

template <int Dim>
std::unique_ptr<Passes<Dim>> make_passes(BasisKind basis) {
#define MPMFAST_CASE(word, Basis) \
  case BasisKind::word:           \
    return make_passes_of<Dim, BasisKind::word>();
  switch (basis) { MPMFAST_BASES(MPMFAST_CASE) }
#undef MPMFAST_CASE
  return nullptr;
}
template std::unique_ptr<Passes<2>> make_passes<2>(BasisKind);
template std::unique_ptr<Passes<3>> make_passes<3>(BasisKind);

}  // namespace mpmfast
