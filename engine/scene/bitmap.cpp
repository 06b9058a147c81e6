#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include "engine/scene/sections.hpp"

namespace mpmfast {

namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 28;  // bytes
constexpr std::uint32_t kLongestEdge = 32768;               // pixels; checked before anything is decoded

std::uint32_t big_endian(const std::vector<unsigned char>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = (value << 8) | bytes[at + k];
  return value;
}

/// Looks at the PNG header (signature, then IHDR: width, height, depth, colour type).
std::string header_fault(const std::vector<unsigned char>& bytes) {
  constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::size_t kHeaderEnd = 26;
  if (bytes.size() < kHeaderEnd || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) {
    return "not a PNG file";
  }
  const int depth = bytes[24], colour = bytes[25];
  if (depth != 8 || colour != 0) {
    static const char* const kColours[] = {"grey",          "?", "RGB", "palette", "grey with alpha", "?",
                                           "RGB with alpha"};
    return fmt::format("a {}-bit {} PNG (8-bit grey was expected)", depth,
                       colour <= 6 ? kColours[colour] : "?");
  }
  const std::uint32_t width = big_endian(bytes, 16), height = big_endian(bytes, 20);
  if (width == 0 || height == 0 || width > kLongestEdge || height > kLongestEdge) {
    return fmt::format("an image of {} × {} pixels (at most {} along an edge)", width, height, kLongestEdge);
  }
  return "";
}

}  // namespace

std::shared_ptr<const GreyImage> load_grey_png(const std::filesystem::path& file, std::string& why_not) {
  const auto refuse = [&](std::string why) {
    why_not = std::move(why);
    return nullptr;
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return refuse("no such file");
  if (!std::filesystem::is_regular_file(file, error)) return refuse("not a file");
  if (std::filesystem::file_size(file, error) > kLargestFile || error) return refuse("too large a file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refuse("cannot be opened");
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream),
                                         std::istreambuf_iterator<char>()};
  if (std::string fault = header_fault(bytes); !fault.empty()) return refuse(std::move(fault));
  auto image = std::make_shared<GreyImage>();
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &image->width, &image->height,
                            &channels, 1),
      stbi_image_free);
  if (!pixels) return refuse(std::string("damaged: ") + stbi_failure_reason());
  const auto count = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  image->pixel.assign(pixels.get(), pixels.get() + count);
  return image;
}

}  // namespace mpmfast
