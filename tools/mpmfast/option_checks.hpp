#pragma once

/// @file What the values of options must be: each check is empty, or says what is wrong with the text.

#include <charconv>
#include <string>
#include <system_error>

namespace mpmfast {

/// A number that is the whole of the text.
template <class Number>
bool read_whole(const std::string& text, Number& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

// CLI11 wants a text that a check might change; ours do not.
std::string check_threads(std::string& text);
std::string check_jobs(std::string& text);
std::string check_launcher(std::string& text);
std::string check_restarts(std::string& text);
std::string check_steps(std::string& text);
std::string check_until(std::string& text);
std::string check_progress(std::string& text);
std::string check_set(std::string& text);
std::string check_out(std::string& text);
std::string check_out_file(std::string& text);

}  // namespace mpmfast
