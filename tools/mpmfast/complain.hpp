#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace mpmfast {

/// Writes to stderr as fmt::print does, but nobody may be there to read it any more: that must not end a run.
template <class... Args>
void complain(fmt::format_string<Args...> text, Args&&... args) {
  std::fputs(fmt::format(text, std::forward<Args>(args)...).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace mpmfast
