#pragma once

/// @file What a scene's contact asks of the clouds of particles around its nodes.

#include "engine/scene/scene.hpp"
#include "kernels/contact/regression.hpp"
#include "kernels/contact/separation.hpp"

namespace mpmfast {

struct FitChoice {
  bool regress;    ///< normals come from a fit
  bool margin;     ///< of the widest margin
  bool smooth;     ///< they are the mean over the nodes around
  bool separate;   ///< separations come from the domains of particles
  bool all_pairs;  ///< nodes of three or more fields have a pair for every two of them, and no lumped pairs
  Extent extent;
  RegressionRule rule;

  explicit FitChoice(const ContactSpec& spec) {
    all_pairs = spec.fields == ManyFields::simultaneous;
    smooth = spec.normal == NormalKind::smoothed_logistic_regression ||
             spec.normal == NormalKind::smoothed_max_margin;
    margin = spec.normal == NormalKind::max_margin || spec.normal == NormalKind::smoothed_max_margin;
    regress = smooth || margin || spec.normal == NormalKind::logistic_regression ||
              spec.normal == NormalKind::logistic_irls || spec.normal == NormalKind::linear_regression;
    separate = spec.detection != DetectionKind::velocity &&
               (spec.separation == SeparationKind::ellipsoid ||
                spec.separation == SeparationKind::ellipsoid_support ||
                spec.separation == SeparationKind::parallelogram_support);
    extent = spec.separation == SeparationKind::ellipsoid_support       ? Extent::ellipsoid
             : spec.separation == SeparationKind::parallelogram_support ? Extent::parallelepiped
                                                                        : Extent::radial;
    rule.fit = spec.normal == NormalKind::logistic_irls       ? Fit::likelihood
               : spec.normal == NormalKind::linear_regression ? Fit::linear
                                                              : Fit::least_squares;
    rule.penalty = spec.penalty;
    rule.offset_penalty = spec.offset_penalty;
    rule.tolerance = spec.tolerance;
    rule.max_iterations = spec.max_iterations;
  }
};

}  // namespace mpmfast
