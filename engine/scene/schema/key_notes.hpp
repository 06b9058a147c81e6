#pragma once

/// @file What each key of a scene means, in a sentence.

#include <span>
#include <string>

namespace mpmfast {

struct KeyNote {
  const char* pattern;  ///< as in recorder.hpp, with or without conditions
  const char* says;
};

std::span<const KeyNote> key_notes();
/// Top-level keys that are gone before the sections are read, so that no reader asks for them.
std::span<const KeyNote> early_keys();

/// The sentence on a pattern; none when there is none.
const KeyNote* note_on(const std::string& pattern);

}  // namespace mpmfast
