#pragma once

/// @file Files that a scene names. What cannot be read gives nothing, and `why_not` says why.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shapes.hpp"

namespace mpmfast {

/// The content of a file.
std::optional<std::vector<unsigned char>> load_bytes(const std::filesystem::path& file, std::string& why_not);

/// Decodes an 8-bit grey PNG.
std::shared_ptr<const GreyImage> load_grey_png(const std::filesystem::path& file, std::string& why_not);
std::shared_ptr<const GreyImage> decode_grey_png(std::span<const unsigned char> bytes, std::string& why_not);

/// Reads an STL file, text or binary, in its own lengths: a closed surface, or nothing.
std::shared_ptr<const Surface> load_stl(const std::filesystem::path& file, std::string& why_not);
std::shared_ptr<const Surface> decode_stl(std::span<const unsigned char> bytes, std::string& why_not);

}  // namespace mpmfast
