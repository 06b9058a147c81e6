#pragma once

/// @file Reading a whole file. What may never end (a device, a pipe) is refused before a byte of it is read.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace mpmfast {

/// The content of a regular file.
/// @param most     bytes; a larger file is refused unread
/// @param why_not  filled where nothing is returned: "no such file", "it is a folder", the system's reason
std::optional<std::string> read_regular(const std::filesystem::path& file, std::uintmax_t most,
                                        std::string& why_not);

}  // namespace mpmfast
