#pragma once

/// @file What the fuzzers call with any bytes at all, and a unit test with those of corpus/. Each reads its
/// input from memory as a run would from a file, and uses what was read.

#include <span>

namespace mpmfast::fuzz {

using Bytes = std::span<const unsigned char>;

/// Inputs beyond it are not tried: a scene of this many bytes holds everything.
inline constexpr std::size_t kMostBytes = 64 << 10;

/// A scene is read, or refused by located messages. One that is read writes itself as the same scene, and its
/// bodies fill. Throws std::logic_error where this does not hold.
void read_scene_bytes(Bytes bytes);
/// The same of a study, which writes nothing.
void read_study_bytes(Bytes bytes);
/// A picture has as many pixels as it says.
void read_bitmap_bytes(Bytes bytes);
/// A run.json is written out again, or is no such.
void read_json_bytes(Bytes bytes);
/// A table of numbers, as history.csv: all columns have as many rows. It is refused with its line otherwise.
void read_table_bytes(Bytes bytes);
/// A state of a small scene with columns altered, as lines "COLUMN ENTRY NUMBER" or "COLUMN length NUMBER"
/// say, is refused, or goes on for a step.
void read_checkpoint_bytes(Bytes bytes);
/// A closed surface encloses a volume, and a body of it fills.
void read_stl_bytes(Bytes bytes);

}  // namespace mpmfast::fuzz
