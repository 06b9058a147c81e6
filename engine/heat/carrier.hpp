#pragma once

/// @file What heat asks of the basis: the passes of kernels/transfer/heat.hpp over all tiles. The passes of a
/// step implement it.

#include "engine/state/state.hpp"
#include "kernels/transfer/heat.hpp"

namespace mpmfast {

template <int Dim>
class HeatCarrier {
 public:
  virtual ~HeatCarrier() = default;

  /// heat_capacity, heat_content, heat_slope and what conduction brings, heat_flow; they must be zero.
  virtual void project_heat(State<Dim>& state, HeatScale scale) = 0;
  /// heat_content and heat_slope of what temperature_filter is on the particles; they must be zero.
  virtual void filter_heat(State<Dim>& state) = 0;
  /// Temperatures, slopes and thermal stretches of particles, from `temperature`, `heat_flow` (ΔT) and, if
  /// they are filtered, temperature_series.
  virtual HeatReport update_heat(State<Dim>& state, HeatScale scale, bool filtered) = 0;
};

}  // namespace mpmfast
