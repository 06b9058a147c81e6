#pragma once

/// @file The format of a scene for programs and for people, from what the reader itself says that it accepts.

#include <string>

namespace mpmfast {

/// JSON Schema (draft 7), for editors.
std::string write_schema();

/// The reference page, Markdown.
std::string write_reference();

}  // namespace mpmfast
