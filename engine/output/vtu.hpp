#pragma once

/// @file A VTU file of points: appended raw data in zlib-compressed blocks, as VTK 9 and ParaView read it.

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace mpmfast {

/// What a VTU file calls a type of number.
template <class T>
constexpr std::string_view vtu_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "UInt16";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "UInt32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
}

/// Gathers the arrays of one file; write() puts them to disk.
class VtuFile {
 public:
  /// @param points three coordinates a point
  explicit VtuFile(const std::vector<double>& points);

  /// @param components their names: as many as the values of one point
  template <class T>
  void add_point_data(std::string_view name, const std::vector<T>& values,
                      std::span<const std::string_view> components = {}) {
    point_data_ += array_tag(vtu_type<T>(), name, components.size(), components, bytes_of(values));
  }

  void write(const std::filesystem::path& path, double time) const;

 private:
  template <class T>
  static std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }
  /// Appends the data and returns the XML element that points to it.
  std::string array_tag(std::string_view type, std::string_view name, std::size_t components,
                        std::span<const std::string_view> component_names, std::string_view data);

  std::size_t points_;
  std::string point_tag_, cell_tags_, point_data_;
  std::vector<std::string> appended_;  ///< of each array: put together they would be there twice
  std::size_t offset_ = 0;
};

}  // namespace mpmfast
