#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "engine/geometry/load.hpp"
#include "engine/geometry/surface.hpp"

namespace mpmfast {

namespace {

using Corners = std::vector<Vec3>;  ///< of all triangles, three each

constexpr std::size_t kHead = 84;      // bytes: 80 of text, the number of triangles
constexpr std::size_t kTriangle = 50;  // bytes: normal and corners as float, 2 unused

template <class T>
T little_endian(std::span<const unsigned char> bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::size_t binary_size(std::span<const unsigned char> bytes) {
  return bytes.size() < kHead ? 0 : kHead + kTriangle * std::size_t{little_endian<std::uint32_t>(bytes, 80)};
}

Corners read_binary(std::span<const unsigned char> bytes) {
  Corners corners;
  corners.reserve(3 * (bytes.size() - kHead) / kTriangle);
  for (std::size_t at = kHead; at < bytes.size(); at += kTriangle) {
    for (std::size_t corner = 1; corner <= 3; ++corner) {  // after the normal, which the corners tell better
      Vec3& point = corners.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) point[k] = little_endian<float>(bytes, at + 12 * corner + 4 * k);
    }
  }
  return corners;
}

/// The words of a text, in lower case, and the line of the last.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    std::string word;
    while (at_ < text_.size() && !is_blank(text_[at_]) && word.size() < kLongest)
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(text_[at_++])));
    return word;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  int line() const { return line_; }

 private:
  static constexpr std::size_t kLongest = 60;  // no word of an STL file is longer
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// Reads `solid NAME {facet normal … outer loop {vertex x y z} × 3 endloop endfacet} endsolid NAME`, one
/// after another.
class TextReader {
 public:
  explicit TextReader(std::string_view text) : words_(text) {}

  /// Empty, and a fault, where the text is not an STL file.
  Corners read() {
    Corners corners;
    for (std::string word = words_.next(); !word.empty() && fault.empty(); word = words_.next()) {
      if (word != "solid") return refuse("'solid'", word);
      words_.skip_line();
      while (fault.empty() && (word = words_.next()) == "facet") read_facet(corners);
      if (fault.empty() && word != "endsolid") return refuse("'facet' or 'endsolid'", word);
      words_.skip_line();
    }
    return fault.empty() ? corners : Corners();
  }

  std::string fault;

 private:
  Corners refuse(const std::string& expected, const std::string& word) {
    if (fault.empty())
      fault = fmt::format("line {}: {} was expected, got {}", words_.line(), expected,
                          word.empty() ? "the end of the file" : "'" + word + "'");
    return {};
  }

  void expect(std::initializer_list<const char*> words) {
    for (const char* expected : words) {
      if (!fault.empty()) return;
      if (const std::string word = words_.next(); word != expected)
        refuse(fmt::format("'{}'", expected), word);
    }
  }

  double number() {
    if (!fault.empty()) return 0;
    const std::string word = words_.next();
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
    const bool whole = end == word.data() + word.size() && end != first;
    // Below what a double can hold is zero.
    if (whole && error == std::errc::result_out_of_range && std::abs(std::strtod(first, nullptr)) < 1)
      return 0;
    if (!whole || error != std::errc() || !std::isfinite(value)) refuse("a number", word);
    return value;
  }

  void read_facet(Corners& corners) {
    expect({"normal"});
    for (int k = 0; k < 3; ++k) number();
    expect({"outer", "loop"});
    for (int corner = 0; corner < 3; ++corner) {
      expect({"vertex"});
      Vec3 point;
      for (double& x : point) x = number();
      corners.push_back(point);
    }
    expect({"endloop", "endfacet"});
  }

  Words words_;
};

/// Corners at the same place (to the bit) become one point; triangles without three corners are left out, as
/// their neighbours meet where they were.
struct StlMesh {
  std::vector<Vec3> points;
  std::vector<Surface::Triangle> triangles;
};
StlMesh join_corners(const Corners& corners) {
  std::vector<std::uint32_t> order(corners.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::uint32_t>(k);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return corners[a] < corners[b]; });
  StlMesh mesh;
  std::vector<std::uint32_t> point_of(corners.size());
  for (const std::uint32_t k : order) {
    if (mesh.points.empty() || mesh.points.back() != corners[k]) mesh.points.push_back(corners[k]);
    point_of[k] = static_cast<std::uint32_t>(mesh.points.size() - 1);
  }
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    const Surface::Triangle t{point_of[k], point_of[k + 1], point_of[k + 2]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const Surface> decode_stl(std::span<const unsigned char> bytes, std::string& why_not) {
  const auto refuse = [&](std::string why) {
    why_not = std::move(why);
    return nullptr;
  };
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // Binary files may begin with 'solid' too; their size tells.
  const bool binary = binary_size(bytes) == bytes.size() && bytes.size() >= kHead;
  Corners corners;
  if (binary) {
    corners = read_binary(bytes);
  } else if (text.starts_with("solid") && text.find('\0') == std::string_view::npos) {
    TextReader reader(text);
    corners = reader.read();
    if (!reader.fault.empty()) return refuse(reader.fault);
  } else if (bytes.size() < kHead) {
    return refuse("not an STL file (text that begins with 'solid', or 84 bytes and 50 for each triangle)");
  } else {
    return refuse(
        fmt::format("not an STL file, or cut short: {} bytes, but {} triangles, as its head says, have {}",
                    bytes.size(), little_endian<std::uint32_t>(bytes, 80), binary_size(bytes)));
  }
  for (std::size_t k = 0; k < corners.size(); ++k)
    for (const double x : corners[k])
      if (!std::isfinite(x))
        return refuse(fmt::format("triangle {} has a corner at {} (finite numbers)", k / 3, x));
  StlMesh mesh = join_corners(corners);
  if (std::string fault = Surface::fault(mesh.points, mesh.triangles); !fault.empty())
    return refuse(std::move(fault));
  return std::make_shared<Surface>(std::move(mesh.points), std::move(mesh.triangles));
}

std::shared_ptr<const Surface> load_stl(const std::filesystem::path& file, std::string& why_not) {
  const auto bytes = load_bytes(file, why_not);
  return bytes ? decode_stl(*bytes, why_not) : nullptr;
}

}  // namespace mpmfast
