#include "option_checks.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "engine/quantities/quantity.hpp"
#include "engine/run/threads.hpp"
#include "shell_text.hpp"
#include "tools/study/launcher.hpp"

namespace mpmfast {

namespace {

/// A name like an option is one that misses its value before it: --out --force.
bool is_name(const std::string& text) { return !text.empty() && text[0] != '-'; }

}  // namespace

std::string check_threads(std::string& text) {
  int value = 0;
  if (read_whole(text, value) && value >= 1 && value <= kMostThreads) return "";
  return fmt::format("not a number of threads (1 to {}), got '{}'", kMostThreads, text);
}

std::string check_jobs(std::string& text) {
  int value = 0;
  if (read_whole(text, value) && value >= 1 && value <= kMostThreads) return "";
  return fmt::format("not a number of runs (1 to {}), got '{}'", kMostThreads, text);
}

std::string check_launcher(std::string& text) {
  const auto words = shell_words(text);
  const std::string mistake = words ? launcher_mistake(*words) : "a quote is not closed";
  return mistake.empty() ? "" : fmt::format("{}, got '{}'", mistake, text);
}

std::string check_restarts(std::string& text) {
  int value = 0;
  if (read_whole(text, value) && value >= 0) return "";
  return fmt::format("not a number of restarts (0 or more), got '{}'", text);
}

std::string check_steps(std::string& text) {
  std::uint64_t value = 0;
  return read_whole(text, value) ? "" : fmt::format("not a number of steps (0 or more), got '{}'", text);
}

std::string check_until(std::string& text) {
  const auto parsed = parse_quantity(text, Measure::time);
  if (const auto* error = std::get_if<QuantityError>(&parsed)) {
    return fmt::format("{}, got '{}'{}", error->message, text, error->hint.empty() ? "" : ". " + error->hint);
  }
  return std::get<double>(parsed) > 0 ? ""
                                      : fmt::format("must be positive (a time such as 5 us), got '{}'", text);
}

std::string check_progress(std::string& text) {
  if (text == "auto" || text == "plain" || text == "none") return "";
  return fmt::format("not known (one of auto, plain, none), got '{}'", text);
}

std::string check_set(std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0) return "";
  return fmt::format("not an override (KEY=VALUE, such as time.cfl=0.3), got '{}'{}", text,
                     equals == std::string::npos ? ". No blanks may stand around '='" : "");
}

std::string check_out(std::string& text) {
  return is_name(text) ? "" : fmt::format("a folder was expected, got '{}'", text);
}

std::string check_out_file(std::string& text) {
  return is_name(text) ? "" : fmt::format("a file was expected, got '{}'", text);
}

}  // namespace mpmfast
