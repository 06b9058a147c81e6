#pragma once

/// @file What is wrong with a scene, said for people (design: file:line:col: path: what (expected), got
/// VALUE).

#include <stdexcept>
#include <string>
#include <vector>

namespace mpmfast {

struct Diagnostic {
  std::string file;
  int line{}, column{};  ///< 1-based; 0 when the file as a whole is meant
  std::string path;      ///< dotted path of the key, e.g. materials.steel.young
  std::string message;
  std::string hint;  ///< e.g. "Did you mean 'GPa'?"; may be empty

  std::string text() const;
  /// The same of what is no error: "file:line:column: warning: path: message".
  std::string warning() const;
};

/// Every error found in a scene. what() is all of them, a line each.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<Diagnostic> diagnostics);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace mpmfast
