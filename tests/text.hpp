#pragma once

#include <string>

namespace mpmfast::test {

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace mpmfast::test
