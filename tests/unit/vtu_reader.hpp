#pragma once

/// @file Reads back what VtuFile writes.

#include <doctest/doctest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/unit/output_fixture.hpp"

namespace output_test {

inline std::string attribute(const std::string& tag, const std::string& name) {
  const auto start = tag.find(' ' + name + "=\"");
  if (start == std::string::npos) return "";
  const auto begin = start + name.size() + 3;
  return tag.substr(begin, tag.find('"', begin) - begin);
}

/// The least reader of what the writer must produce: appended raw blocks of zlib.
class Vtu {
 public:
  explicit Vtu(const std::filesystem::path& path) : text_(read_text(path)) {
    data_ = text_.find('_', text_.find("<AppendedData")) + 1;
  }
  std::string tag(const std::string& name) const {
    const auto at = text_.find("Name=\"" + name + "\"");
    REQUIRE(at != std::string::npos);
    const auto begin = text_.rfind('<', at);
    return text_.substr(begin, text_.find('>', at) - begin);
  }
  template <class T>
  std::vector<T> array(const std::string& name) const {
    std::size_t at = data_ + std::stoul(attribute(tag(name), "offset"));
    const auto integer = [&] {
      std::uint64_t value = 0;
      std::memcpy(&value, text_.data() + at, sizeof(value));
      at += sizeof(value);
      return value;
    };
    const std::uint64_t blocks = integer(), block_size = integer(), last = integer();
    std::vector<std::uint64_t> packed(blocks);
    for (auto& size : packed) size = integer();
    std::string bytes;
    for (std::size_t b = 0; b < blocks; ++b) {
      uLongf size = b + 1 == blocks && last != 0 ? last : block_size;
      const uLongf expected = size;
      std::string block(size, '\0');
      REQUIRE(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                         reinterpret_cast<const Bytef*>(text_.data() + at), packed[b]) == Z_OK);
      REQUIRE(size == expected);
      bytes += block;
      at += packed[b];
    }
    REQUIRE(bytes.size() % sizeof(T) == 0);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t data_ = 0;
};

}  // namespace output_test
