#pragma once

/// @file How a state is written to a checkpoint and read from it: by one function for both ways, so that
/// nothing is kept that does not come back.
///
/// `visit(archive)` hands every number that persists from step to step to an archive, under a name of
/// its own. One that writes takes the numbers, one that reads fills them in.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace mpmfast {

enum class NumberKind { real, whole64, whole32, whole16, whole8, signed32 };

template <class T>
constexpr NumberKind number_kind() {
  if constexpr (std::is_same_v<T, double>) return NumberKind::real;
  if constexpr (std::is_same_v<T, std::uint64_t>) return NumberKind::whole64;
  if constexpr (std::is_same_v<T, std::uint32_t>) return NumberKind::whole32;
  if constexpr (std::is_same_v<T, std::uint16_t>) return NumberKind::whole16;
  if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, char>) return NumberKind::whole8;
  if constexpr (std::is_same_v<T, int>) return NumberKind::signed32;
}

class Archive {
 public:
  virtual ~Archive() = default;
  virtual bool reading() const = 0;

  template <class T>
  void number(const std::string& name, T& value) {
    column(name, &value, 1);
  }
  void flag(const std::string& name, bool& value) {
    std::uint8_t whole = value;
    number(name, whole);
    value = whole != 0;
  }
  /// n numbers, as both sides know.
  template <class T>
  void column(const std::string& name, T* values, std::size_t n) {
    pass(name, number_kind<T>(), values, n);
  }
  /// A std::vector of numbers, or text: as many as were written.
  template <class List>
  void list(const std::string& name, List& values) {
    if (reading()) values.resize(length(name));
    column(name, values.data(), values.size());
  }

 protected:
  /// Takes or fills n values. Throws FileError; when reading, also where another number of them or none is
  /// there.
  virtual void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) = 0;
  /// Of what was written under the name. Only for reading.
  virtual std::size_t length(const std::string& name) = 0;
};

}  // namespace mpmfast
