#pragma once

/// @file A state in memory whose columns can be altered: what a checkpoint holds that somebody made.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/errors.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast::test {

/// Written once, it reads as a file does: other lengths and what is missing are FileErrors.
class Forged final : public Archive {
 public:
  bool reading() const override { return reading_; }
  void rewind() { reading_ = true; }

  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& [name, column] : columns_) out.push_back(name);
    return out;
  }
  bool has(const std::string& name) const { return columns_.contains(name); }
  std::size_t count(const std::string& name) const { return columns_.at(name).count; }
  bool is_real(const std::string& name) const { return columns_.at(name).kind == NumberKind::real; }
  /// As many entries, new ones zero.
  void resize(const std::string& name, std::size_t count) {
    Kept& column = columns_.at(name);
    column.bytes.resize(count * size_of(column.kind), '\0');
    column.count = count;
  }
  /// Puts a number in place of the k-th, bent to what the column can hold.
  void set(const std::string& name, std::size_t k, double value) {
    Kept& column = columns_.at(name);
    if (k >= column.count) return;
    with_type(column.kind, [&]<class T>(T) {
      const T bent = bend<T>(value);
      std::memcpy(column.bytes.data() + k * sizeof(T), &bent, sizeof(T));
    });
  }
  void set_all(const std::string& name, double value) {
    for (std::size_t k = 0; k < count(name); ++k) set(name, k, value);
  }
  /// Hands all columns to another archive that is written.
  void write(Archive& out) const {
    for (const auto& [name, column] : columns_)
      with_type(column.kind, [&]<class T>(T) {
        std::vector<T> values(column.count);
        if (column.count > 0) std::memcpy(values.data(), column.bytes.data(), column.bytes.size());
        out.column(name, values.data(), values.size());
      });
  }

 private:
  struct Kept {
    NumberKind kind;
    std::size_t count;
    std::string bytes;
  };

  template <class F>
  static void with_type(NumberKind kind, const F& f) {
    switch (kind) {
      case NumberKind::real:
        return f(double{});
      case NumberKind::whole64:
        return f(std::uint64_t{});
      case NumberKind::whole32:
        return f(std::uint32_t{});
      case NumberKind::whole16:
        return f(std::uint16_t{});
      case NumberKind::whole8:
        return f(std::uint8_t{});
      case NumberKind::signed32:
        return f(int{});
    }
  }
  static std::size_t size_of(NumberKind kind) {
    std::size_t size = 0;
    with_type(kind, [&]<class T>(T) { size = sizeof(T); });
    return size;
  }
  template <class T>
  static T bend(double value) {
    if constexpr (std::is_same_v<T, double>) return value;
    constexpr auto kLeast = static_cast<double>(std::numeric_limits<T>::lowest());
    if (!(value > kLeast)) return std::numeric_limits<T>::lowest();
    if (value >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
    return static_cast<T>(value);
  }

  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    const std::size_t bytes = n * size_of(kind);
    if (!reading_) {
      columns_[name] = {kind, n, std::string(static_cast<const char*>(values), bytes)};
      return;
    }
    if (!has(name) || columns_[name].count != n) throw FileError(name + " has another length");
    if (n > 0) std::memcpy(values, columns_[name].bytes.data(), bytes);
  }
  std::size_t length(const std::string& name) override {
    if (!has(name)) throw FileError("no " + name);
    return columns_.at(name).count;
  }

  std::map<std::string, Kept> columns_;
  bool reading_ = false;
};

}  // namespace mpmfast::test
