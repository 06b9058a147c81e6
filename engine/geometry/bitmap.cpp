#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

#include <fmt/format.h>
#define ZLIB_CONST
#include <zlib.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "engine/geometry/load.hpp"

namespace mpmfast {

namespace {

// Checked before anything is decoded. A megabyte of a file may hold a thousand megabytes of pixels.
constexpr std::uint32_t kLongestEdge = 32768;                  // pixels
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;  // of one picture; decoding takes 3 bytes each

std::uint32_t big_endian(std::span<const unsigned char> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = (value << 8) | bytes[at + k];
  return value;
}

std::string_view name_of_chunk(std::span<const unsigned char> bytes, std::size_t at) {
  return {reinterpret_cast<const char*>(bytes.data()) + at + 4, 4};
}

/// Looks at the PNG header (signature, then IHDR: width, height, depth, colour type).
std::string header_fault(std::span<const unsigned char> bytes) {
  constexpr std::array<unsigned char, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::size_t kHeaderEnd = 26;
  if (bytes.size() < kHeaderEnd || !std::equal(kSignature.begin(), kSignature.end(), bytes.begin())) {
    return "not a PNG file";
  }
  if (big_endian(bytes, 8) != 13 || name_of_chunk(bytes, 8) != "IHDR")
    return "damaged: it begins without IHDR";
  const int depth = bytes[24], colour = bytes[25];
  if (depth != 8 || colour != 0) {
    static const char* const kColours[] = {"grey",          "?", "RGB", "palette", "grey with alpha", "?",
                                           "RGB with alpha"};
    return fmt::format("a {}-bit {} PNG (8-bit grey was expected)", depth,
                       colour <= 6 ? kColours[colour] : "?");
  }
  const std::uint32_t width = big_endian(bytes, 16), height = big_endian(bytes, 20);
  if (width == 0 || height == 0 || width > kLongestEdge || height > kLongestEdge ||
      std::uint64_t{width} * height > kMostPixels) {
    return fmt::format("an image of {} × {} pixels (at most {} along an edge, {} in all)", width, height,
                       kLongestEdge, kMostPixels);
  }
  return "";
}

/// Counts what compressed data, given in pieces, expands to.
class Inflater {
 public:
  Inflater() { inflateInit(&stream_); }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// False where the data are no such, or expand to more than `most` bytes in all.
  bool feed(std::span<const unsigned char> piece, std::uint64_t most) {
    stream_.next_in = piece.data();
    stream_.avail_in = static_cast<uInt>(piece.size());
    int result = Z_OK;
    do {
      stream_.next_out = buffer_.data();
      stream_.avail_out = static_cast<uInt>(buffer_.size());
      result = inflate(&stream_, Z_NO_FLUSH);
    } while (result == Z_OK && stream_.avail_out == 0 && stream_.total_out <= most);
    return (result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR) && stream_.total_out <= most;
  }

 private:
  z_stream stream_{};
  std::array<unsigned char, 32768> buffer_;
};

/// stb_image takes the memory that a chunk says it needs, and all that its data expand to: looks whether each
/// chunk is in the file, and whether the data are no more than the picture.
std::string chunk_fault(std::span<const unsigned char> bytes) {
  constexpr std::size_t kAround = 12;  // bytes: length, name, checksum
  const std::uint64_t width = big_endian(bytes, 16), height = big_endian(bytes, 20);
  const std::uint64_t most = 2 * (width + 1) * height + 64;  // a line has a byte more; interlaced: more lines
  Inflater inflater;
  std::size_t at = 8;
  while (true) {
    if (at + kAround > bytes.size()) return "damaged: it ends before its IEND";
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - kAround) return "damaged: a chunk is longer than the rest of the file";
    if (name_of_chunk(bytes, at) == "IEND") return "";
    const bool data = name_of_chunk(bytes, at) == "IDAT";
    if (data && length == 0)
      return "damaged: it has a piece of data without a byte";  // stb_image would copy to null
    if (data && !inflater.feed(bytes.subspan(at + 8, length), most))
      return "damaged: its data are no compressed picture of its size";
    at += kAround + length;
  }
}

}  // namespace

std::shared_ptr<const GreyImage> decode_grey_png(std::span<const unsigned char> bytes, std::string& why_not) {
  const auto refuse = [&](std::string why) {
    why_not = std::move(why);
    return nullptr;
  };
  if (std::string fault = header_fault(bytes); !fault.empty()) return refuse(std::move(fault));
  if (std::string fault = chunk_fault(bytes); !fault.empty()) return refuse(std::move(fault));
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

std::shared_ptr<const GreyImage> load_grey_png(const std::filesystem::path& file, std::string& why_not) {
  const auto bytes = load_bytes(file, why_not);
  return bytes ? decode_grey_png(*bytes, why_not) : nullptr;
}

}  // namespace mpmfast
