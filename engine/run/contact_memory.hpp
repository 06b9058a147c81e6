#pragma once

/// @file What contact will ask of the memory when more surfaces meet than do now.

#include "engine/step/step.hpp"

namespace mpmfast {

struct ContactNeed {
  double nodes{};  ///< contact nodes, were two fifths of what can meet to do so
  double bytes{};  ///< of the nodes, their entries, and the clouds that are kept at once
};

/// @param step  that has advanced: its nodes know their masses
template <int Dim>
ContactNeed contact_need(const Step<Dim>& step, const Scene& scene);

}  // namespace mpmfast
