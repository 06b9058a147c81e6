#include "engine/output/animated_png.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <string_view>

#include "engine/output/files.hpp"

namespace mpmfast {

namespace {

void put(std::string& out, std::uint32_t value, int bytes) {
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(value >> (8 * k) & 255);
}

/// Length, name, content and the check sum of both.
void put_chunk(std::string& out, std::string_view name, const std::string& content) {
  const std::string named = std::string(name) + content;
  put(out, static_cast<std::uint32_t>(content.size()), 4);
  out += named;
  put(out,
      static_cast<std::uint32_t>(
          crc32(0, reinterpret_cast<const Bytef*>(named.data()), static_cast<uInt>(named.size()))),
      4);
}

std::string compressed(const std::string& rows) {
  constexpr int kLevel = 6;
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                static_cast<uLong>(rows.size()), kLevel) != Z_OK)
    throw_file_error("encode", "an animation", ENOMEM);
  out.resize(size);
  return out;
}

}  // namespace

void AnimatedPng::add(const std::vector<std::uint8_t>& pixels) {
  const auto row = 3 * static_cast<std::ptrdiff_t>(width_);
  const bool whole = frames_.empty();  // else at first nothing
  int left = whole ? 0 : width_, right = width_ - left, top = whole ? 0 : height_, bottom = height_ - top;
  for (int y = 0; y < height_ && !whole; ++y) {
    const auto begin = pixels.cbegin() + y * row, end = begin + row, last = last_.cbegin() + y * row;
    const auto first = std::mismatch(begin, end, last).first;
    if (first == end) continue;
    const auto back = std::mismatch(std::reverse_iterator(end), std::reverse_iterator(begin),
                                    std::reverse_iterator(last + row))
                          .first;
    left = std::min(left, static_cast<int>((first - begin) / 3));
    right = std::max(right, static_cast<int>((back.base() - begin + 2) / 3));
    top = std::min(top, y);
    bottom = y + 1;
  }
  if (left >= right) left = top = 0, right = bottom = 1;  // a still: it must have a pixel
  Frame frame{left, top, right - left, bottom - top, ""};
  std::string rows(static_cast<std::size_t>((3 * frame.width + 1) * frame.height), '\1');
  auto to = rows.begin();
  for (int y = top; y < bottom; ++y) {
    // Differences to the pixel on the left: areas of one colour become zeros.
    const auto begin = pixels.begin() + y * row + 3 * left, end = begin + 3 * frame.width;
    to = std::copy(begin, begin + 3, to + 1);
    to = std::transform(begin + 3, end, begin, to, [](std::uint8_t pixel, std::uint8_t before) {
      return static_cast<char>(pixel - before);
    });
  }
  frame.data = compressed(rows);
  frames_.push_back(std::move(frame));
  last_ = pixels;
}

void AnimatedPng::write(const std::filesystem::path& path) const {
  std::string out = "\x89PNG\r\n\x1a\n", header;
  put(header, static_cast<std::uint32_t>(width_), 4);
  put(header, static_cast<std::uint32_t>(height_), 4);
  header += std::string("\x08\x02\0\0\0", 5);  // 8 bits, red green blue
  put_chunk(out, "IHDR", header);
  std::string control;
  put(control, static_cast<std::uint32_t>(frames_.size()), 4);
  put(control, 0, 4);  // without end
  put_chunk(out, "acTL", control);
  std::uint32_t sequence = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const Frame& frame = frames_[k];
    std::string control;
    put(control, sequence++, 4);
    for (const int number : {frame.width, frame.height, frame.x, frame.y})
      put(control, static_cast<std::uint32_t>(number), 4);
    put(control, 1, 2);  // a second over the rate
    put(control, static_cast<std::uint32_t>(rate_), 2);
    control += std::string(2, '\0');  // stays, and replaces what is under it
    put_chunk(out, "fcTL", control);
    if (k == 0) {
      put_chunk(out, "IDAT", frame.data);
      continue;
    }
    std::string numbered;
    put(numbered, sequence++, 4);
    put_chunk(out, "fdAT", numbered + frame.data);
  }
  put_chunk(out, "IEND", "");
  write_aside(path, out);
}

}  // namespace mpmfast
