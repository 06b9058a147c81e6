#pragma once

/// @file The two ways a run ends badly besides a bad scene (SceneError).

#include <stdexcept>
#include <string>

namespace mpmfast {

/// A file could not be read or written (exit 4).
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run failed physically (exit 3). what() says step, time, particle, body, position and cause.
class RunFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mpmfast
