#pragma once

/// @file "Did you mean …?": what a word of a scene, or of the command line, stands for here.

#include <span>
#include <string>
#include <string_view>

#include "engine/quantities/closest.hpp"

namespace mpmfast {

/// As closest_hint; but first for what other programs, or people, call by this word.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

/// "It belongs to 'method'": the section that has such a key, or nothing.
std::string home_of(std::string_view key);

}  // namespace mpmfast
