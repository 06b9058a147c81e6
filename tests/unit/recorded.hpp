#pragma once

/// @file Texts against recorded ones (tests/recorded/), which a person can read.
///
/// With the environment variable MPMFAST_RECORD what is compared is written to the folder of that name: read
/// it before it takes the place of what was recorded.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/source_folder.hpp"

namespace mpmfast::test {

/// Where what is compared goes, if it is to be recorded; else empty.
inline std::filesystem::path record_folder() {
  const char* folder = std::getenv("MPMFAST_RECORD");
  return folder != nullptr ? folder : "";
}

inline std::filesystem::path recorded_file(const std::string& name) {
  return source_folder() / "tests/recorded" / name;
}

/// The same words, and numbers that differ by no more than a millionth.
inline bool same_words(const std::string& a, const std::string& b) {
  const auto words = [](const std::string& line) {
    std::istringstream stream(line);
    std::vector<std::string> out;
    for (std::string word; stream >> word;) out.push_back(word);
    return out;
  };
  return std::ranges::equal(words(a), words(b), [](const std::string& one, const std::string& other) {
    if (one == other) return true;
    char *one_end = nullptr, *other_end = nullptr;
    const double x = std::strtod(one.c_str(), &one_end), y = std::strtod(other.c_str(), &other_end);
    return *one_end == '\0' && *other_end == '\0' &&
           std::abs(x - y) <= 1e-6 * std::max(std::abs(x), std::abs(y));
  });
}

inline void check_recorded_text(const std::string& name, const std::string& text) {
  CAPTURE(name);
  if (const auto folder = record_folder(); !folder.empty()) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return;
  }
  const auto lines = [](std::istream& stream) {
    std::vector<std::string> out;
    for (std::string line; std::getline(stream, line);) out.push_back(line);
    return out;
  };
  std::ifstream file(recorded_file(name), std::ios::binary);
  std::istringstream stream(text);
  const std::vector<std::string> recorded = lines(file), written = lines(stream);
  CHECK(written.size() == recorded.size());
  for (std::size_t k = 0; k < std::min(written.size(), recorded.size()); ++k) {
    if (same_words(written[k], recorded[k])) continue;
    FAIL_CHECK("line " << k + 1 << ": " << written[k] << "\nrecorded: " << recorded[k]);
    return;
  }
}

}  // namespace mpmfast::test
