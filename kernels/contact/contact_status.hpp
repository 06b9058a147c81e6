#pragma once

/// @file What a contact does: its surfaces are apart, slip on each other, or stick. For one contact, or for
/// one of each of kLanes nodes.

#include <cstdint>
#include <type_traits>

#include "kernels/simd/lane_vector.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"

namespace mpmfast {

enum class ContactStatus { open, slip, stick };

/// The status of one contact, or the number of the status in each lane.
template <class Number>
using StatusOf = std::conditional_t<std::is_same_v<Number, double>, ContactStatus, IntLanes>;

inline bool has(ContactStatus status, ContactStatus asked) { return status == asked; }
inline IntLanes has(IntLanes status, ContactStatus asked) {
  return status == static_cast<std::int64_t>(asked);
}

/// The same status in every lane.
template <class Number>
inline StatusOf<Number> status_of(ContactStatus status) {
  if constexpr (std::is_same_v<Number, double>)
    return status;
  else
    return IntLanes{} + static_cast<std::int64_t>(status);
}

/// What a contact is given by its law while the others stay.
template <class Vector>
struct ResponseOf {
  Vector impulse;  ///< Δp_a, N s
  StatusOf<NumberOf<Vector>> status;
};
template <int Dim>
using Response = ResponseOf<Vec<Dim>>;

/// The response of a law that returns an impulse alone: one that is neither zero nor the trial impulse slips.
/// @param trial  Δp_a that sticking would need, N s
template <int Dim>
inline Response<Dim> response_of(const Vec<Dim>& impulse, const Vec<Dim>& trial) {
  const ContactStatus closed = impulse == trial ? ContactStatus::stick : ContactStatus::slip;
  return {impulse, impulse == Vec<Dim>::Zero() ? ContactStatus::open : closed};
}

}  // namespace mpmfast

#pragma GCC diagnostic pop
