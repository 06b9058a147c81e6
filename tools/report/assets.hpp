#pragma once

/// @file The parts of the page that embed.cmake compiles in.

#include <string_view>

namespace mpmfast::report_assets {

extern const std::string_view kTemplate, kStyle, kScript;

}  // namespace mpmfast::report_assets
