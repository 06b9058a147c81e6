#pragma once

/// @file "Did you mean …?": the known word nearest to a misspelt one.

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
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

/// "It belongs into 'method'": the section that has such a key, or nothing.
std::string home_of(std::string_view key);

}  // namespace mpmfast
