#pragma once

/// @file Contact laws of a pair of fields on a node (N20 §2.2, Eq. 8 to 10). A law says how much of the
/// tangential momentum change that sticking would need the surfaces carry; resolve_pair does the rest. None
/// of them has a memory: what happens on a node follows from this step's momenta, separation and area. To add
/// one: a struct like those below, a place in AnyLaw, and a line in make_law (engine/plan/contact_law.hpp).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <variant>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// Where a law acts: on touching and approaching surfaces, also on such as are bonded, on every node that two
/// fields share, or nowhere.
enum class LawScope { contact, bonded, everywhere, nowhere };

/// What a law is asked of a node.
struct Sliding {
  double normal;         ///< −Δp_a(0)·n, N s; positive in compression
  double stick;          ///< |Δp_a(0)·t|, N s: what sticking needs
  double reduced = 0;    ///< m_red, kg
  double area_time = 0;  ///< A_c Δt, m² s, for laws that use the area
};

inline constexpr double kSticks = std::numeric_limits<double>::infinity();

/// S = μN; before sliding up to μ_s N, where a scene gives that. Contact area and Δt cancel.
struct Coulomb {
  static constexpr std::string_view name = "coulomb",
                                    description = "friction proportional to the normal force";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;
  double friction = 0, static_friction = 0;

  double operator()(const Sliding& s) const {
    return s.stick <= static_friction * s.normal ? kSticks : friction * s.normal;
  }
};

struct Frictionless {
  static constexpr std::string_view name = "frictionless",
                                    description = "surfaces slide freely and do not attract";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;

  double operator()(const Sliding&) const { return 0; }
};

struct Stick {
  static constexpr std::string_view name = "stick",
                                    description = "no sliding while in contact; surfaces may part";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;

  double operator()(const Sliding&) const { return kSticks; }
};

struct Perfect {
  static constexpr std::string_view name = "perfect", description = "tied for good: fields move as one";
  static constexpr LawScope scope = LawScope::everywhere;
  static constexpr bool uses_area = false;

  double operator()(const Sliding&) const { return kSticks; }
};

struct Ignore {
  static constexpr std::string_view name = "ignore",
                                    description = "no contact: fields pass through each other";
  static constexpr LawScope scope = LawScope::nowhere;
  static constexpr bool uses_area = false;

  double operator()(const Sliding&) const { return 0; }
};

/// A bond that holds tension σ and shear τ up to (σ/σ_c)² + (τ/τ_c)² = 1, in compression up to τ = τ_c + μN,
/// and Coulomb friction where it does not. A bond that broke lets its surfaces part or slide, and they stay
/// broken while the gap is beyond `reach` or the shear that would stop the sliding is beyond the strength;
/// surfaces that come to rest in touch bond again.
struct Adhesion {
  static constexpr std::string_view name = "adhesion",
                                    description = "a bond with tensile and shear strength, then friction";
  static constexpr LawScope scope = LawScope::bonded;
  static constexpr bool uses_area = true;
  double friction = 0, normal_strength = 0, shear_strength = 0;  ///< –, Pa, Pa
  double reach = 0;                                              ///< m

  bool holds(const Sliding& s) const {
    if (s.normal >= 0) return s.stick <= shear_strength * s.area_time + friction * s.normal;
    const double tension = -s.normal / normal_strength, shear = s.stick / shear_strength;
    return tension * tension + shear * shear <= s.area_time * s.area_time;
  }
  double operator()(const Sliding& s) const { return friction * s.normal; }
};

/// S = μ(v) N with μ = μ_d + (μ_s − μ_d) exp(−v/v_c), v the slip speed that remains (N20 Eq. 10).
///
/// g(v) = m_red v + μ(v) N − |Δp_t(0)| = 0 is convex, g(0) < 0 once μ_s N is exceeded, and g ≥ 0 at the slip
/// v_0 that μ_d would leave: Newton from v_0 runs down to the only root.
struct VelocityFriction {
  static constexpr std::string_view name = "velocity_friction",
                                    description = "friction that falls with the speed of sliding";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;
  double friction = 0, static_friction = 0, decay_speed = 1;  ///< –, –, m/s

  double operator()(const Sliding& s) const {
    if (s.stick <= static_friction * s.normal) return kSticks;
    double speed = (s.stick - friction * s.normal) / s.reduced;
    for (int k = 0; k < 50; ++k) {
      const double falling = (static_friction - friction) * s.normal * std::exp(-speed / decay_speed);
      const double excess = s.reduced * speed + friction * s.normal + falling - s.stick;
      const double step = excess / (s.reduced - falling / decay_speed);
      speed -= step;
      if (!(std::abs(step) > 1e-14 * speed)) break;
    }
    return s.stick - s.reduced * std::max(0.0, speed);
  }
};

/// S = η v/h, v the slip speed that remains, of a film between touching surfaces.
/// m_red v = |Δp_t(0)| − S A_c Δt gives S A_c Δt = |Δp_t(0)| c/(m_red + c) with c = (η/h) A_c Δt.
struct Viscous {
  static constexpr std::string_view name = "viscous",
                                    description = "shear of a liquid film between touching surfaces";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = true;
  double resistance = 0;  ///< η/h, Pa s/m

  double operator()(const Sliding& s) const {
    const double c = resistance * s.area_time;
    return s.stick * c / (s.reduced + c);
  }
};

using AnyLaw =
    std::variant<Coulomb, Frictionless, Stick, Perfect, Ignore, Adhesion, VelocityFriction, Viscous>;

/// Momentum change Δp_a of field a against the rest of the node, which takes −Δp_a (theory §4).
///
/// In contact ⇔ Δp_a(0)·n < 0 and separation < 0. Then the normal part is kept whole, so that the surfaces do
/// not approach; the tangential part is kept (stick) or cut to what the law carries (slide).
/// @param stick  Δp_a(0) = (m_a/m) p − p_a, which gives both sides one velocity
/// @param normal unit, from a to b
template <int Dim, class Law>
inline Vec<Dim> resolve_pair(const Vec<Dim>& stick, const Vec<Dim>& normal, double separation, const Law& law,
                             double reduced = 0, double area_time = 0) {
  if constexpr (Law::scope == LawScope::nowhere) return Vec<Dim>::Zero();
  if constexpr (Law::scope == LawScope::everywhere) return stick;
  const double along = stick.dot(normal);
  if constexpr (Law::scope == LawScope::bonded) {
    const double shear = (stick - along * normal).norm();
    if (separation < law.reach && law.holds({-along, shear, reduced, area_time})) return stick;
  }
  if (!(along < 0 && separation < 0)) return Vec<Dim>::Zero();
  const Vec<Dim> tangential = stick - along * normal;
  const double needed = tangential.norm(), limit = law({-along, needed, reduced, area_time});
  if (!(needed > limit)) return stick;
  return along * normal + (limit / needed) * tangential;
}

}  // namespace mpmfast
