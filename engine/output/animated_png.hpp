#pragma once

/// @file An animated PNG (APNG): browsers and viewers play it, others show its first picture.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace mpmfast {

/// Pictures of one size, shown one after another, for ever.
class AnimatedPng {
 public:
  /// @param rate  pictures a second
  AnimatedPng(int width, int height, int rate) : width_(width), height_(height), rate_(rate) {}

  /// @param pixels  red, green and blue of every pixel, row by row
  void add(const std::vector<std::uint8_t>& pixels);

  /// Written to a temporary name and renamed; throws FileError.
  void write(const std::filesystem::path& path) const;

 private:
  /// What of a picture differs from the one before, compressed.
  struct Frame {
    int x = 0, y = 0, width = 0, height = 0;
    std::string data;
  };

  int width_, height_, rate_;
  std::vector<Frame> frames_;
  std::vector<std::uint8_t> last_;
};

}  // namespace mpmfast
