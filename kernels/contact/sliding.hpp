#pragma once

/// @file What contact laws are asked, and what their descriptions have in common.

#include <array>
#include <limits>

#include "kernels/measure.hpp"

namespace mpmfast {

/// Where a law acts: on touching and approaching surfaces, also on such as are bonded, on every node that two
/// fields share, by springs there on what their displacements differ by, or nowhere.
enum class LawScope { contact, bonded, everywhere, interface, nowhere };

/// What a law is asked of a node.
struct Sliding {
  double normal;          ///< −Δp_a(0)·n, N s; positive in compression
  double stick;           ///< |Δp_a(0)·t|, N s: what sticking needs
  double reduced_mass{};  ///< m_red, kg
  double area_time{};     ///< A_c Δt, m² s, for laws that use the area
};

inline constexpr double kSticks = std::numeric_limits<double>::infinity();

inline constexpr Number kCoefficient{Measure::number, kNotNegative};
inline constexpr const char *kFrictionDescription =
                                "Coefficient of friction while sliding; may stand beside any law.",
                            *kStaticDescription =
                                "Coefficient up to which surfaces at rest stick; 0: as `friction`.";

/// What holds apart surfaces that press and are joined by springs or a bond.
enum class CompressionModel { spring, contact };
inline constexpr std::array<Keyword<CompressionModel>, 2> kCompressionModels{{
    {CompressionModel::spring, "spring", "springs of `compression_stiffness` (default)"},
    {CompressionModel::contact, "contact", "contact with friction: the jump never becomes an overlap"},
}};
inline constexpr const char* kCompressionModelDescription = "What holds apart surfaces that press.";
inline constexpr const char* kCompressionDescription =
    "Traction by overlap of surfaces that press; 0: by as much as by opening.";

}  // namespace mpmfast
