#pragma once

/// @file Writing files so that a reader, or a kill at any moment, never meets half of one.

#include <cerrno>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace mpmfast {

/// Writes the parts, one after the other, to a temporary name beside `path` and renames it. A link is
/// followed; what is there and is no regular file (a device, a pipe) is written to as it is. Throws
/// FileError.
void write_aside(const std::filesystem::path& path, std::span<const std::string_view> parts);
void write_aside(const std::filesystem::path& path, std::string_view content);

/// Does the name hold a character such as a line's end, which scripts and messages would take for more than
/// a name?
bool has_control_character(const std::filesystem::path& path);

/// Makes a folder and its parents. Throws FileError.
void make_folder(const std::filesystem::path& folder);

/// Throws FileError: what could not be done to which file, and the system's reason.
[[noreturn]] void throw_file_error(std::string_view action, const std::filesystem::path& path,
                                   int error = errno);

}  // namespace mpmfast
