#pragma once

/// @file A VTU file of points: appended raw data in zlib-compressed blocks, as VTK 9 and ParaView read it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
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

/// An array that is compressed while it is made, block by block: it is nowhere as a whole.
class PackedArray {
 public:
  void append(std::string_view data);
  /// VTK's layout: block count, block size, size of a last partial block (else 0), compressed sizes; the
  /// blocks.
  std::vector<std::string> finish();

 private:
  void pack();
  std::string block_;
  std::size_t bytes_ = 0;
  std::vector<std::string> packed_;
};

/// Gathers the arrays of one file; write() puts them to disk.
class VtuFile {
 public:
  /// @param fill  called with (i, values) for each point in turn: writes its three coordinates
  template <class Fill>
  VtuFile(std::size_t points, const Fill& fill) : points_(points) {
    point_tag_ = array_tag("Float64", "Points", 3, {}, packed<double>(3, fill));
    add_cells();
  }
  /// @param points  three coordinates a point
  explicit VtuFile(const std::vector<double>& points)
      : VtuFile(points.size() / 3, [&](std::size_t i, double* x) { std::copy_n(&points[3 * i], 3, x); }) {}

  /// @param fill  as for the points: writes as many values as there are names of components, or one
  template <class T, class Fill>
  void add_point_data(std::string_view name, const Fill& fill,
                      std::span<const std::string_view> components = {}) {
    point_data_ += array_tag(vtu_type<T>(), name, components.size(), components,
                             packed<T>(std::max<std::size_t>(components.size(), 1), fill));
  }
  template <class T>
  void add_point_data(std::string_view name, const std::vector<T>& values,
                      std::span<const std::string_view> components = {}) {
    const std::size_t n = std::max<std::size_t>(components.size(), 1);
    add_point_data<T>(
        name, [&](std::size_t i, T* out) { std::copy_n(&values[n * i], n, out); }, components);
  }

  /// Of the whole file, not of its points. @param components  values of one tuple
  template <class T>
  void add_field_data(std::string_view name, const std::vector<T>& values, std::size_t components = 1) {
    PackedArray array;
    array.append({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    field_data_ +=
        array_tag(vtu_type<T>(), name, components, {}, std::move(array), values.size() / components);
  }

  void write(const std::filesystem::path& path, double time) const;

 private:
  template <class T, class Fill>
  PackedArray packed(std::size_t components, const Fill& fill) const {
    PackedArray array;
    std::vector<T> values(components);
    for (std::size_t i = 0; i < points_; ++i) {
      fill(i, values.data());
      array.append({reinterpret_cast<const char*>(values.data()), components * sizeof(T)});
    }
    return array;
  }
  /// Appends the data and returns the XML element that points to it.
  /// @param tuples  that the element names, as those of a whole file must
  std::string array_tag(std::string_view type, std::string_view name, std::size_t components,
                        std::span<const std::string_view> component_names, PackedArray data,
                        std::optional<std::size_t> tuples = std::nullopt);
  void add_cells();

  std::size_t points_;
  std::string point_tag_, cell_tags_, point_data_, field_data_;
  std::vector<std::string> appended_;  ///< heads and blocks: put together they would be there twice
  std::size_t offset_ = 0;
};

}  // namespace mpmfast
