#pragma once

/// @file Contact laws of a pair of fields on a node (N20 §2.2). A law says how much of the tangential
/// momentum change that sticking would need the surfaces can carry; resolve_pair does the rest. To add one: a
/// struct like those below, and a line in the plan's dispatch.

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "kernels/dimension.hpp"

namespace mpmfast {

/// A parameter of a law, as scenes and `mpmfast list` name it.
struct LawKey {
  std::string_view name, quantity, description;
};

/// Where a law acts: on touching and approaching surfaces, on every node that two fields share, or nowhere.
enum class LawScope { contact, everywhere, nowhere };

/// The largest tangential momentum change is μ N; N = −Δp_a·n. The contact area and Δt cancel.
struct Coulomb {
  static constexpr std::string_view name = "coulomb",
                                    description = "friction proportional to the normal force";
  static constexpr std::array<LawKey, 1> keys{{{"friction", "number", "coefficient of friction, 0 or more"}}};
  static constexpr LawScope scope = LawScope::contact;
  double friction = 0;

  double operator()(double normal_impulse) const { return friction * normal_impulse; }
};

struct Frictionless {
  static constexpr std::string_view name = "frictionless",
                                    description = "surfaces slide freely and do not attract";
  static constexpr std::array<LawKey, 0> keys{};
  static constexpr LawScope scope = LawScope::contact;

  double operator()(double) const { return 0; }
};

struct Stick {
  static constexpr std::string_view name = "stick",
                                    description = "no sliding while in contact; surfaces may part";
  static constexpr std::array<LawKey, 0> keys{};
  static constexpr LawScope scope = LawScope::contact;

  double operator()(double) const { return std::numeric_limits<double>::infinity(); }
};

struct Perfect {
  static constexpr std::string_view name = "perfect", description = "tied for good: fields move as one";
  static constexpr std::array<LawKey, 0> keys{};
  static constexpr LawScope scope = LawScope::everywhere;

  double operator()(double) const { return std::numeric_limits<double>::infinity(); }
};

struct Ignore {
  static constexpr std::string_view name = "ignore",
                                    description = "no contact: fields pass through each other";
  static constexpr std::array<LawKey, 0> keys{};
  static constexpr LawScope scope = LawScope::nowhere;

  double operator()(double) const { return 0; }
};

/// Momentum change Δp_a of field a against the rest of the node, which takes −Δp_a (theory §4).
///
/// In contact ⇔ Δp_a(0)·n < 0 and separation < 0. Then the normal part is kept whole, so that the surfaces do
/// not approach; the tangential part is kept (stick) or cut to what the law carries (slide).
/// @param stick  Δp_a(0) = (m_a/m) p − p_a, which gives both sides one velocity
/// @param normal unit, from a to b
template <int Dim, class Law>
inline Vec<Dim> resolve_pair(const Vec<Dim>& stick, const Vec<Dim>& normal, double separation,
                             const Law& law) {
  if constexpr (Law::scope == LawScope::nowhere) return Vec<Dim>::Zero();
  if constexpr (Law::scope == LawScope::everywhere) return stick;
  const double along = stick.dot(normal);
  if (!(along < 0 && separation < 0)) return Vec<Dim>::Zero();
  const Vec<Dim> tangential = stick - along * normal;
  const double needed2 = tangential.squaredNorm(), limit = law(-along);
  if (!(needed2 > limit * limit)) return stick;
  return along * normal + (limit / std::sqrt(needed2)) * tangential;
}

}  // namespace mpmfast
