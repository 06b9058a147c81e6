#pragma once

/// @file Contact laws of a pair of fields on a node (N20 §2.2, Eq. 8 to 10). A law says how much of the
/// tangential momentum change that sticking would need the surfaces carry; resolve_pair does the rest. None
/// of those that act by touch has a memory: what happens on a node follows from this step's momenta,
/// separation and area. (Springs remember jumps, bonds what they have lost: interface.hpp, bond.hpp.) Its
/// parameters are what a scene may say of it (`describe`, as of a material:
/// kernels/materials/parameters.hpp). To add one: a struct like those below, and a place in AnyLaw.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <variant>

#include "kernels/constants.hpp"
#include "kernels/contact/cohesive.hpp"
#include "kernels/contact/sliding.hpp"
#include "kernels/contact/traction_curve.hpp"

namespace mpmfast {

/// S = μN; before sliding up to μ_s N, where a scene gives that. Contact area and Δt cancel.
struct Coulomb {
  static constexpr const char *kKeyword = "coulomb",
                              *kDescription =
                                  "slides when friction × normal force is reached (default, friction 0)";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;
  double friction{}, static_friction{};

  template <class Keys>
  void describe(Keys& map) {
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.key("static_friction", kStaticDescription, static_friction, kCoefficient);
  }
  double operator()(const Sliding& s) const {
    return s.stick <= static_friction * s.normal ? kSticks : friction * s.normal;
  }
};

struct Frictionless {
  static constexpr const char *kKeyword = "frictionless", *kDescription = "slides freely";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;

  template <class Keys>
  void describe(Keys&) {}

  double operator()(const Sliding&) const { return 0; }
};

struct Stick {
  static constexpr const char *kKeyword = "stick", *kDescription = "never slides while in contact";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;

  template <class Keys>
  void describe(Keys&) {}

  double operator()(const Sliding&) const { return kSticks; }
};

struct Perfect {
  static constexpr const char *kKeyword = "perfect", *kDescription = "always tied, also in tension";
  static constexpr LawScope scope = LawScope::everywhere;
  static constexpr bool uses_area = false;

  template <class Keys>
  void describe(Keys&) {}

  double operator()(const Sliding&) const { return kSticks; }
};

struct Ignore {
  static constexpr const char *kKeyword = "ignore", *kDescription = "bodies pass through each other";
  static constexpr LawScope scope = LawScope::nowhere;
  static constexpr bool uses_area = false;

  template <class Keys>
  void describe(Keys&) {}

  double operator()(const Sliding&) const { return 0; }
};

/// A bond that holds tension σ and shear τ up to (σ/σ_c)² + (τ/τ_c)² = 1, in compression up to τ = τ_c + μN,
/// and Coulomb friction where it does not. A bond that broke lets its surfaces part or slide, and they stay
/// broken while the gap is beyond `reach` or the shear that would stop the sliding is beyond the strength;
/// surfaces that come to rest in touch bond again.
struct Adhesion {
  static constexpr const char *kKeyword = "adhesion",
                              *kDescription = "bonded up to a tensile and a shear strength, then coulomb";
  static constexpr LawScope scope = LawScope::bonded;
  static constexpr bool uses_area = true;
  double friction{}, normal_strength{}, shear_strength{};  ///< –, Pa, Pa
  double reach = 0.05, cell = 1;                           ///< cells; m, of the grid

  template <class Keys>
  void describe(Keys& map) {
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.need("normal_strength", "Tension at which a bond breaks.", normal_strength,
             Number{Measure::pressure, kPositive});
    map.need("shear_strength", "Shear at which a bond breaks.", shear_strength,
             Number{Measure::pressure, kPositive});
    map.key("reach", "Cells: a bond acts up to this gap.", reach, kCoefficient);
  }
  void set_cell(double edge) { cell = edge; }
  double longest_gap() const { return reach * cell; }  ///< m

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
  static constexpr const char *kKeyword = "velocity_friction",
                              *kDescription = "friction + (static_friction - friction) exp(-v/decay_speed)";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = false;
  double friction{}, static_friction{}, decay_speed = 1;  ///< –, –, m/s

  template <class Keys>
  void describe(Keys& map) {
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.key("static_friction", kStaticDescription, static_friction, kCoefficient);
    map.need("decay_speed", "Speed over which friction falls from static to sliding.", decay_speed,
             Number{Measure::velocity, kPositive});
  }
  double operator()(const Sliding& s) const {
    const double at_rest = std::max(friction, static_friction);  // zero: as `friction`
    if (s.stick <= at_rest * s.normal) return kSticks;
    double speed = (s.stick - friction * s.normal) / s.reduced_mass;
    for (int k = 0; k < constants::kSlipSpeedIterations; ++k) {
      const double falling = (at_rest - friction) * s.normal * std::exp(-speed / decay_speed);
      const double excess = s.reduced_mass * speed + friction * s.normal + falling - s.stick;
      const double step = excess / (s.reduced_mass - falling / decay_speed);
      speed -= step;
      if (!(std::abs(step) > constants::kSlipSpeedTolerance * speed)) break;
    }
    return s.stick - s.reduced_mass * std::max(0.0, speed);
  }
};

/// S = η v/h, v the slip speed that remains, of a film between touching surfaces.
/// m_red v = |Δp_t(0)| − S A_c Δt gives S A_c Δt = |Δp_t(0)| c/(m_red + c) with c = (η/h) A_c Δt.
struct Viscous {
  static constexpr const char *kKeyword = "viscous",
                              *kDescription =
                                  "a liquid film: shear traction viscosity × v/film, no dry friction";
  static constexpr LawScope scope = LawScope::contact;
  static constexpr bool uses_area = true;
  double viscosity{}, film = 1;  ///< η, Pa s; h, m

  template <class Keys>
  void describe(Keys& map) {
    map.need("viscosity", "Of the film between the surfaces.", viscosity,
             Number{Measure::viscosity, kNotNegative});
    map.need("film", "Thickness of the film.", film, Number{Measure::length, kPositive});
  }
  double operator()(const Sliding& s) const {
    const double c = viscosity / film * s.area_time;
    return s.stick * c / (s.reduced_mass + c);
  }
};

/// Surfaces joined by springs, on the jump of their displacements (NN §5.3, 5.5): traction D_n δ_n along the
/// normal, of another stiffness where they overlap, or in contact there (NN §5.6), D_t δ_t along the surface.
/// See interface.hpp.
struct Interface {
  static constexpr const char *kKeyword = "interface",
                              *kDescription = "joined by springs: traction = stiffness × displacement jump";
  static constexpr LawScope scope = LawScope::interface;
  static constexpr bool uses_area = true;
  double normal_stiffness{}, shear_stiffness{}, compression_stiffness{};  ///< Pa/m
  CompressionModel compression = CompressionModel::spring;
  double friction{}, static_friction{};  ///< where contact holds them apart

  template <class Keys>
  void describe(Keys& map) {
    constexpr Number kStiffness{Measure::interface_stiffness, kNotNegative};
    map.need("normal_stiffness", "Traction by opening; 0: nothing holds surfaces that part.",
             normal_stiffness, kStiffness);
    map.need("shear_stiffness", "Traction by slip; 0: they slide freely.", shear_stiffness, kStiffness);
    map.key("compression_stiffness", kCompressionDescription, compression_stiffness, kStiffness);
    map.key("compression", kCompressionModelDescription, compression, kCompressionModels);
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.key("static_friction", kStaticDescription, static_friction, kCoefficient);
  }
  double overlap_stiffness() const {
    if (compression == CompressionModel::contact) return 0;
    return compression_stiffness > 0 ? compression_stiffness : normal_stiffness;
  }
  double operator()(const Sliding&) const { return 0; }  ///< springs are forces, not contact
  Coulomb contact() const { return {friction, static_friction}; }
};

/// As Interface, where tractions are curves of the jump (NN §5.4): what is above 0 in the normal one is
/// opening. It has overlap too where its first point lies below 0. See curved_springs.hpp.
struct NonlinearInterface {
  static constexpr const char *kKeyword = "nonlinear_interface",
                              *kDescription = "joined by springs whose tractions are curves of the jump";
  static constexpr LawScope scope = LawScope::interface;
  static constexpr bool uses_area = true;
  TractionCurve normal_curve{{0}, {0}}, shear_curve{{0}, {0}};  ///< of the opening and of the slip
  double compression_stiffness{};                               ///< Pa/m
  CompressionModel compression = CompressionModel::spring;
  double friction{}, static_friction{};  ///< where contact holds them apart

  template <class Keys>
  void describe(Keys& map) {
    constexpr Points kCurve{Measure::length, Measure::pressure};
    map.need("normal_curve", "Traction by opening: points from [0, 0] on, or from an overlap on.",
             normal_curve, kCurve);
    map.need("shear_curve", "Traction by slip: points from [0, 0] on; [[0, 0]]: they slide freely.",
             shear_curve, kCurve);
    map.key("compression_stiffness", kCompressionDescription, compression_stiffness,
            Number{Measure::interface_stiffness, kNotNegative});
    map.key("compression", kCompressionModelDescription, compression, kCompressionModels);
    map.key("friction", kFrictionDescription, friction, kCoefficient);
    map.key("static_friction", kStaticDescription, static_friction, kCoefficient);
  }
  bool has_overlap() const { return normal_curve.jump.front() < 0; }
  /// The normal curve with what holds apart surfaces that press: a point where they overlap by so much.
  TractionCurve curve_with_overlap(double overlap) const {
    TractionCurve whole = normal_curve;
    if (has_overlap()) return whole;
    const double stiffness = compression == CompressionModel::contact ? 0
                             : compression_stiffness > 0              ? compression_stiffness
                                                         : normal_curve.slope(normal_curve.piece_of(0, true));
    whole.jump.insert(whole.jump.begin(), -overlap);
    whole.traction.insert(whole.traction.begin(), -stiffness * overlap);
    return whole;
  }
  double operator()(const Sliding&) const { return 0; }  ///< springs are forces, not contact
  Coulomb contact() const { return {friction, static_friction}; }
};

inline Coulomb Cohesive::contact() const { return {friction, static_friction}; }

/// In the order in which they are listed.
using AnyLaw = std::variant<Coulomb, Frictionless, Stick, Perfect, Ignore, Adhesion, VelocityFriction,
                            Viscous, Interface, NonlinearInterface, Cohesive>;

/// Has a law no friction, or that of Coulomb, or is there no contact by it?
template <class Law>
inline constexpr bool kDryFriction =
    std::is_same_v<Law, Coulomb> || std::is_same_v<Law, Frictionless> || std::is_same_v<Law, Ignore>;

/// Does it join surfaces by springs or a bond?
template <std::same_as<AnyLaw> Law>
bool has_springs(const Law& law) {
  return std::visit([](const auto& one) { return one.scope == LawScope::interface; }, law);
}

}  // namespace mpmfast
