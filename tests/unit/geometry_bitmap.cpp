// Pictures of grey levels, and files that are read whole: what is damaged is told, whatever it is.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "engine/geometry/load.hpp"
#include "engine/geometry/read_regular.hpp"
#include "tests/unit/output_fixture.hpp"

using namespace output_test;

namespace {

using Bytes = std::vector<unsigned char>;

constexpr const char* kEndsEarly = "damaged: it ends before its IEND";
constexpr const char* kTooLong = "damaged: a chunk is longer than the rest of the file";
constexpr const char* kNoPicture = "damaged: its data are no compressed picture of its size";

void put(Bytes& out, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<unsigned char>(value >> shift));
}

void put_chunk(Bytes& out, const std::string& name, const Bytes& content) {
  put(out, static_cast<std::uint32_t>(content.size()));
  Bytes named(name.begin(), name.end());
  named.insert(named.end(), content.begin(), content.end());
  out.insert(out.end(), named.begin(), named.end());
  put(out, static_cast<std::uint32_t>(crc32(0, named.data(), static_cast<uInt>(named.size()))));
}

Bytes packed(const Bytes& raw) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  Bytes out(size);
  REQUIRE(compress(out.data(), &size, raw.data(), static_cast<uLong>(raw.size())) == Z_OK);
  out.resize(size);
  return out;
}

/// The signature and IHDR.
Bytes head(std::uint32_t width, std::uint32_t height, unsigned char depth = 8, unsigned char colour = 0) {
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 26, '\n'}, header;
  put(header, width);
  put(header, height);
  for (const int byte : {int{depth}, int{colour}, 0, 0, 0})
    header.push_back(static_cast<unsigned char>(byte));
  put_chunk(out, "IHDR", header);
  return out;
}

/// With these pieces of data and the end.
Bytes picture(std::uint32_t width, std::uint32_t height, const std::vector<Bytes>& pieces) {
  Bytes out = head(width, height);
  for (const Bytes& piece : pieces) put_chunk(out, "IDAT", piece);
  put_chunk(out, "IEND", {});
  return out;
}

Bytes random_bytes(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  Bytes out(n);
  for (unsigned char& byte : out) byte = static_cast<unsigned char>(random());
  return out;
}

/// Rows of pixels as they stand in a file, each behind the byte that says so.
Bytes rows_of(const Bytes& pixels, std::size_t width) {
  Bytes out;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    if (k % width == 0) out.push_back(0);
    out.push_back(pixels[k]);
  }
  return out;
}

std::string fault_of(const Bytes& bytes) {
  std::string why_not;
  return decode_grey_png(bytes, why_not) ? "" : why_not;
}

TEST_CASE("a picture has the pixels that were written, however many pieces its data are in") {
  for (const auto& [width, height] : {std::pair(1U, 1U), std::pair(5U, 3U), std::pair(211U, 190U)})
    for (const std::size_t pieces : {1U, 2U, 7U}) {
      CAPTURE(width);
      CAPTURE(pieces);
      const Bytes pixels = random_bytes(std::size_t{width} * height, width),
                  data = packed(rows_of(pixels, width));
      std::vector<Bytes> parts;
      for (std::size_t k = 0; k < pieces; ++k)
        parts.emplace_back(data.begin() + static_cast<std::ptrdiff_t>(k * data.size() / pieces),
                           data.begin() + static_cast<std::ptrdiff_t>((k + 1) * data.size() / pieces));
      std::string why_not;
      const auto image = decode_grey_png(picture(width, height, parts), why_not);
      REQUIRE(image);
      CHECK(image->width == static_cast<int>(width));
      CHECK(image->height == static_cast<int>(height));
      CHECK(image->pixel == pixels);
      CHECK(why_not == "");
    }
}

TEST_CASE("a grey level that is transparent is a level as any other") {
  const Bytes pixels = random_bytes(12, 5);
  Bytes bytes = head(4, 3);
  put_chunk(bytes, "tRNS", {0, pixels[5]});
  put_chunk(bytes, "IDAT", packed(rows_of(pixels, 4)));
  put_chunk(bytes, "IEND", {});
  std::string why_not;
  const auto image = decode_grey_png(bytes, why_not);
  REQUIRE(image);
  CHECK(image->pixel == pixels);
}

TEST_CASE("a picture that ends anywhere is damaged, and whether in a chunk or between two is told") {
  Bytes good = head(5, 3);
  const Bytes data = packed(rows_of(random_bytes(15, 1), 5));
  put_chunk(good, "tEXt", Bytes{'a', 0, 'b'});
  put_chunk(good, "IDAT", data);
  put_chunk(good, "IEND", {});
  REQUIRE(fault_of(good) == "");
  for (std::size_t size = 0; size < good.size(); ++size) {
    CAPTURE(size);
    std::string expected = kEndsEarly;
    // Where chunks begin, and what each holds.
    for (const auto& [begin, holds] : {std::pair<std::size_t, std::size_t>{33, 3}, {48, data.size()}})
      if (size >= begin + 12 && size < begin + 12 + holds) expected = kTooLong;
    if (size < 33) expected = kTooLong;
    if (size < 26) expected = "not a PNG file";
    CHECK(fault_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))) == expected);
  }
}

TEST_CASE("what does not begin as a picture is none, and another kind of picture is named") {
  const Bytes good = picture(1, 1, {packed({0, 7})});
  REQUIRE(fault_of(good) == "");
  for (std::size_t at = 0; at < 16; ++at) {
    CAPTURE(at);
    Bytes other = good;
    other[at] ^= 1;
    CHECK(fault_of(other) == (at < 8 ? "not a PNG file" : "damaged: it begins without IHDR"));
  }
  const std::array<std::string, 8> kinds{"grey",           "?", "RGB", "palette", "grey with alpha", "?",
                                         "RGB with alpha", "?"};
  for (const int depth : {1, 2, 4, 7, 8, 9, 16})
    for (std::size_t colour = 0; colour < kinds.size(); ++colour) {
      const std::string fault =
          fault_of(head(1, 1, static_cast<unsigned char>(depth), static_cast<unsigned char>(colour)));
      CHECK(fault == (depth == 8 && colour == 0 ? kEndsEarly
                                                : "a " + std::to_string(depth) + "-bit " + kinds[colour] +
                                                      " PNG (8-bit grey was expected)"));
    }
}

TEST_CASE("a picture has 32768 pixels along an edge at most, 2^26 in all, and one at least") {
  constexpr std::uint32_t kLong = 32768, kMany = 1U << 26;
  const std::vector<std::uint32_t> sides{0,    1,     2047,      2048,       2049,      8192,
                                         8193, kLong, kLong + 1, 0x7fffffff, 0xffffffff};
  for (const std::uint32_t width : sides)
    for (const std::uint32_t height : sides) {
      const bool fits = width > 0 && height > 0 && width <= kLong && height <= kLong &&
                        std::uint64_t{width} * height <= kMany;
      CHECK(fault_of(head(width, height)) ==
            (fits ? kEndsEarly
                  : "an image of " + std::to_string(width) + " × " + std::to_string(height) +
                        " pixels (at most 32768 along an edge, 67108864 in all)"));
    }
}

TEST_CASE("data of a picture that are none, that are empty or that expand to much more are refused") {
  const Bytes rows = rows_of(random_bytes(6, 2), 3);
  const Bytes data = packed(rows);
  CHECK(fault_of(picture(3, 2, {{}})) == "damaged: it has a piece of data without a byte");
  CHECK(fault_of(picture(3, 2, {data, {}})) == "damaged: it has a piece of data without a byte");
  CHECK(fault_of(picture(3, 2, {{'n', 'o', 'n', 'e'}})) == kNoPicture);
  Bytes spoilt = data;
  spoilt.back() ^= 1;  // the check sum
  CHECK(fault_of(picture(3, 2, {spoilt})) == kNoPicture);
  CHECK(fault_of(picture(3, 2, {})).starts_with("damaged: "));
  CHECK(fault_of(picture(3, 2, {packed(Bytes(rows.begin(), rows.end() - 1))})).starts_with("damaged: "));
  // Twice its rows and a few bytes are let through, as interlaced pictures have more of them.
  for (const auto& [width, height] : {std::pair(3U, 2U), std::pair(20U, 1U), std::pair(1U, 500U),
                                      std::pair(15U, 1022U), std::pair(199U, 100U)}) {
    const std::size_t most = 2 * (std::size_t{width} + 1) * height + 64;
    CHECK(fault_of(picture(width, height, {packed(Bytes(most, 0))})) != kNoPicture);
    CHECK(fault_of(picture(width, height, {packed(Bytes(most + 1, 0))})) == kNoPicture);
    CHECK(fault_of(picture(width, height, {packed(Bytes(1000000, 0))})) == kNoPicture);
  }
}

TEST_CASE("a file of a picture that is not there or is none is told") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "grains.png";
  std::string why_not;
  CHECK_FALSE(load_grey_png(file, why_not));
  CHECK(why_not == "no such file");
  const Bytes pixels = random_bytes(12, 3), good = picture(4, 3, {packed(rows_of(pixels, 4))});
  std::ofstream(file, std::ios::binary) << std::string(good.begin(), good.end());
  const auto image = load_grey_png(file, why_not);
  REQUIRE(image);
  CHECK(image->pixel == pixels);
  CHECK(load_bytes(file, why_not) == good);
  std::filesystem::resize_file(file, std::uintmax_t{1} << 29);  // without taking the space
  CHECK_FALSE(load_bytes(file, why_not));
  CHECK(why_not == "it is larger than 256 MiB");
}

TEST_CASE("a file is read whole up to a size, and refused unread beyond it") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  std::string why_not = "untouched";
  for (const std::size_t size : {0U, 1U, 7U, 65535U, 65536U, 65537U, 200000U}) {
    CAPTURE(size);
    const Bytes bytes = random_bytes(size, 4);
    const std::string text(bytes.begin(), bytes.end());
    std::ofstream(file, std::ios::binary) << text;
    why_not = "untouched";
    CHECK(read_regular(file, size, why_not) == text);
    CHECK(read_regular(file, std::uintmax_t{1} << 40, why_not) == text);
    CHECK(why_not == "untouched");
    if (size == 0) continue;
    CHECK_FALSE(read_regular(file, size - 1, why_not));
    CHECK(why_not == "it is larger than " + std::to_string(size - 1) + " bytes");
  }
  constexpr std::uintmax_t kMebibyte = std::uintmax_t{1} << 20;
  std::filesystem::resize_file(file, 16 * kMebibyte);
  for (const auto& [most, told] : {std::pair<std::uintmax_t, std::string>{kMebibyte - 1, "1048575 bytes"},
                                   {kMebibyte, "1 MiB"},
                                   {2 * kMebibyte - 1, "1 MiB"},
                                   {7 * kMebibyte, "7 MiB"}}) {
    CHECK_FALSE(read_regular(file, most, why_not));
    CHECK(why_not == "it is larger than " + told);
  }
}

TEST_CASE("a file that tells no size is read to its end") {
  std::string why_not;
  const auto text = read_regular("/proc/self/maps", 1 << 24, why_not);  // some kilobytes, of size 0
  REQUIRE(text);
  CHECK(text->size() > 1000);
  CHECK(text->back() == '\n');
  CHECK_FALSE(read_regular("/proc/self/maps", 100, why_not));
  CHECK(why_not == "it is larger than 100 bytes");
}

TEST_CASE("what the system says of a file is told, whatever call was interrupted before") {
  std::string why_not;
  errno = EINTR;
  CHECK(read_regular("/proc/self/status", 1 << 24, why_not));
  CHECK_FALSE(read_regular("/proc/self/mem", 1 << 24, why_not));  // nothing is at its first place
  CHECK(why_not == "Input/output error");
}

TEST_CASE("a file that is read is closed, whatever its number") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "text";
  const int kept = dup(0);
  REQUIRE(kept > 0);
  close(0);
  std::string why_not;
  const auto text = read_regular(folder.path() / "file", 100, why_not);
  const bool closed = fcntl(0, F_GETFD) < 0;
  dup2(kept, 0);
  close(kept);
  CHECK(text == "text");
  CHECK(closed);
}

TEST_CASE("what is no file is told, and nobody waits for it") {
  const TemporaryFolder folder;
  std::string why_not;
  const auto refused = [&](const std::filesystem::path& path) {
    CHECK_FALSE(read_regular(path, 100, why_not));
    return why_not;
  };
  CHECK(refused(folder.path() / "nowhere") == "no such file");
  CHECK(refused(folder.path()) == "it is a folder");
  CHECK(refused("/dev/null") == "it is not a file but a device, a pipe or a socket");
  const auto pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(refused(pipe) == "it is not a file but a device, a pipe or a socket");
  std::ofstream(folder.path() / "file") << "text";
  CHECK(refused(folder.path() / "file" / "below") == "Not a directory");
}

}  // namespace
