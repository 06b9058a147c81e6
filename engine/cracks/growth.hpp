#pragma once

/// @file Growth of cracks at their ends. New crack sides are bonded by the cohesive law of the crack, whose
/// work of separation is the toughness. Sides that separate at once would leave that energy to waves.

#include <optional>
#include <vector>

#include "engine/cracks/crack_line.hpp"
#include "engine/cracks/tip_load.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/state.hpp"

namespace mpmfast {

/// What one end of a crack does.
struct GrowthStep {
  bool grows = false;
  double angle = 0;  ///< of the new piece to the direction of the end, to the left, rad
};

/// Growth by the load at an end. The first piece grows where J, or K_θ²/E′ of the largest hoop stress,
/// reaches the toughness. Later pieces keep the end kBondedLength ahead of the leading softening bond.
/// @param strength  normal strength of the bonds, Pa
/// @param cell      cell size, m
GrowthStep decide_growth(const GrowthSpec& spec, const CrackEnd& end, const TipLoad& load, double strength,
                         double cell);

/// The point of the crack lines of one body that is nearest to x, within a distance. Of the own line only
/// parts farther back than kOwnLine distances count.
/// @param crack,end  the end at x
/// @return nothing where all lines are farther away
template <int Dim>
std::optional<Vec<Dim>> nearest_on_lines(const std::vector<CrackLine<Dim>>& lines, int crack, bool end,
                                         const Vec<Dim>& x, double distance);

/// Lets one end of a crack grow, if its load suffices, and sets the time of its next check: a Rayleigh wave
/// passes one piece until then, which limits the speed of the crack. @return whether the line was extended
template <int Dim>
bool grow_end(const Scene& scene, const State<Dim>& state, int crack, bool end, const TipLoad& load,
              std::vector<CrackLine<Dim>>& lines);

/// Are the crack sides at a node new, since an end grew past it in the last step?
template <int Dim>
bool has_new_sides(const CrackLine<Dim>& line, const GridView<Dim>& grid, const NodeIndex<Dim>& node);

}  // namespace mpmfast
