#include "engine/scene/text/diagnostic.hpp"

#include <fmt/format.h>

#include <utility>

namespace mpmfast {

std::string Diagnostic::text() const {
  std::string out = file;
  if (line > 0) out += fmt::format(":{}:{}", line, column);
  if (!path.empty()) out += ": " + path;
  out += ": " + message;
  if (!hint.empty()) out += ". " + hint;
  return out;
}

std::string Diagnostic::warning() const {
  Diagnostic marked = *this;
  marked.path = path.empty() ? "warning" : "warning: " + path;
  return marked.text();
}

namespace {

std::string all_of(const std::vector<Diagnostic>& diagnostics) {
  std::string out;
  for (const Diagnostic& diagnostic : diagnostics) {
    if (!out.empty()) out += '\n';
    out += diagnostic.text();
  }
  return out;
}

}  // namespace

SceneError::SceneError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(all_of(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace mpmfast
