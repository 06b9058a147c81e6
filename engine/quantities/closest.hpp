#pragma once

/// @file The known word nearest to a misspelt one.

#include <span>
#include <string>
#include <string_view>

namespace mpmfast {

/// Edits (insert, delete, replace, swap of neighbours) that turn one word into the other.
int edit_distance(std::string_view a, std::string_view b);

/// The nearest known word when it is near enough to be what was meant, else empty. A word that differs in
/// case alone wins over every other.
std::string closest(std::string_view word, std::span<const std::string> known);

/// "Did you mean 'x'?" or nothing.
std::string closest_hint(std::string_view word, std::span<const std::string> known);

std::string lower_case(std::string_view text);

}  // namespace mpmfast
