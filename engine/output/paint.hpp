#pragma once

/// @file Pictures of the particles: one, or a series whose pictures share their box and their colours.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/canvas.hpp"
#include "engine/output/lines.hpp"
#include "engine/output/particle_access.hpp"
#include "engine/output/scales.hpp"
#include "engine/scene/scene.hpp"
#include "engine/state/particles.hpp"

namespace mpmfast {

/// What a picture shows: the box, m, and the values at the ends of its colours.
struct Framing {
  std::array<std::optional<Range>, 3> box;  ///< nothing where no particle has a place
  std::optional<Range> values;              ///< nothing for a field of names, such as bodies
  /// Widens it to what the other one shows too.
  void include(const Framing& other);
};

/// The unit of lengths on all pictures and pages of a run.
DisplayUnit length_unit(const Scene& scene);

/// What the colours do not reach, for a title: outliers, or what a range that was asked for leaves out.
std::string beyond_text(const FieldValues& field, const Range& colours);

/// The particles with their domains, and the field's range without its outliers.
/// @param field  as field_values, which says what it throws
template <int Dim>
Framing framing_of(const Particles<Dim>& particles, const Scene& scene, const std::string& field);

/// Draws the particles (true deformed parallelograms in 2-D; a shaded projection of balls in 3-D) coloured by
/// `field`, with title, equal axes and, where the field is a number, a colour bar with units.
/// @param lines  drawn over them, in the plane
template <int Dim>
Canvas paint_particles(const Particles<Dim>& particles, const Scene& scene, const std::string& field,
                       double time, const Framing& framing, PictureFormat format = PictureFormat::png,
                       const Polylines& lines = {});

}  // namespace mpmfast
