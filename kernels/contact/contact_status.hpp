#pragma once

/// @file What a contact does: its surfaces are apart, slip on each other, or stick.

namespace mpmfast {

enum class ContactStatus { open, slip, stick };

}  // namespace mpmfast
