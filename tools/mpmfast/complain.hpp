#pragma once

/// @file What people read on a terminal. Names, titles and paths in it are anyone's: they are printed as
/// text.

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

#include "engine/quantities/printable.hpp"

namespace mpmfast {

/// Writes to stderr as fmt::print does, but nobody may be there to read it any more: that must not end a run.
template <class... Args>
void complain(fmt::format_string<Args...> text, Args&&... args) {
  std::fputs(printable(fmt::format(text, std::forward<Args>(args)...)).c_str(), stderr);
  std::fflush(stderr);
}

/// Writes to stdout. Throws std::system_error where that is closed or full.
template <class... Args>
void say(fmt::format_string<Args...> text, Args&&... args) {
  fmt::print("{}", printable(fmt::format(text, std::forward<Args>(args)...)));
}

}  // namespace mpmfast
