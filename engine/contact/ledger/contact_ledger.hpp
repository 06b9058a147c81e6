#pragma once

/// @file What contact of any family did in one step, for the energy balance and the history.

#include <vector>

#include "kernels/dimension.hpp"

namespace mpmfast {

template <int Dim>
struct ContactLedger {
  double friction_work = 0;                ///< J
  double rigid_work = 0;                   ///< J, of rigid bodies on the others
  double stored = 0;                       ///< J, in the springs of interfaces at the end of the step
  double lost = 0;                         ///< J, of bonds that soften and break
  std::vector<Vec<Dim>> rigid_impulse;     ///< N s, on rigid bodies; by field
  std::vector<Vec<3>> rigid_moment;        ///< N m s, on rigid bodies about their pivots; by field
  std::vector<Vec<Dim>> pair_impulse;      ///< N s, on the first of the two; as ContactSpec::pairs
  std::vector<double> pair_friction_work;  ///< J; as ContactSpec::pairs
  std::vector<double> pair_area;           ///< m², of surfaces that press; likewise

  /// Sets all to zero. @param fields, pairs  how many there are
  void reset(std::size_t fields, std::size_t pairs) {
    friction_work = rigid_work = stored = lost = 0;
    rigid_impulse.assign(fields, Vec<Dim>::Zero());
    rigid_moment.assign(fields, Vec<3>::Zero());
    pair_impulse.assign(pairs, Vec<Dim>::Zero());
    pair_friction_work.assign(pairs, 0);
    pair_area.assign(pairs, 0);
  }
};

}  // namespace mpmfast
