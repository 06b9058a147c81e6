#pragma once

/// @file Samples of the material around a crack tip, from particles and grid, and what they tell of the body
/// there.

#include <vector>

#include "engine/state/state.hpp"
#include "kernels/fracture/tip_sample.hpp"

namespace mpmfast {

using TipSamples = std::vector<TipSample>;

/// A disk in the plane.
struct Disk {
  Vec<2> centre;  ///< m
  double radius;  ///< m
};

/// The particles of a velocity field in a disk, in the axes of the scene. Acceleration and velocity gradient
/// are those of the grid.
/// @param thickness  of the plane, m
/// @param dt         of the last step, s
/// @param gravity    acceleration by body forces, which is subtracted, m/s²
template <int Dim>
void list_samples(State<Dim>& state, int field, const Disk& disk, double thickness, double dt,
                  const Vec<2>& gravity, TipSamples& samples);

/// Subtracts the mean velocity. J does not depend on a uniform velocity, but its sum over particles does.
void subtract_mean_velocity(TipSamples& samples);

/// Turns samples to axes with a new origin.
/// @param axes  unit vectors in its rows
void turn_to_axes(const Vec<2>& origin, const Mat<2>& axes, TipSamples& samples);

/// How far the body extends ahead of a tip at the origin, along x: the largest distance to which material
/// fills a wedge ahead, m; 0: the body ends at the tip.
/// @param radius  of the samples, m
double filled_length(const TipSamples& samples, double radius, double cell);

/// Mean tractions σ_tn and σ_nn across a straight band behind an end, Pa; zero without samples there.
/// @param direction  of the line at its end, unit
/// @param straight   length of the line without a turn, m
Vec<2> traction_behind(const TipSamples& samples, const Vec<2>& end, const Vec<2>& direction, double straight,
                       double cell);

}  // namespace mpmfast
