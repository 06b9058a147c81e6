#pragma once

/// @file Reads back the particle files that a run writes: particles.pvd and the VTU file of each frame. What
/// is no such file, or was cut or altered, is refused with a FileError that names it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/output/vtu.hpp"

namespace mpmfast {

/// One array of a VTU file: what it is, and where its data lie.
struct VtuArray {
  std::string name;
  std::string type;                     ///< as in the file: "Float64", "Float32", "UInt32" …
  std::size_t components = 1;           ///< values of one tuple
  std::vector<std::string> names = {};  ///< of the components; empty where they have none
  std::size_t tuples = 0;               ///< points, where it is not of the whole file
  std::uint64_t offset{};               ///< bytes, into the appended data
};

/// One VTU file of points, whole in memory; an array is unpacked when it is asked for.
class VtuReader {
 public:
  explicit VtuReader(const std::filesystem::path& path);

  double time() const { return time_; }  ///< s
  std::size_t size() const { return size_; }
  /// In the order of the file.
  const std::vector<VtuArray>& point_data() const { return point_data_; }
  /// Of the point data, "Points" or an array of the cells; nothing when there is no such array.
  const VtuArray* find(std::string_view name) const;
  /// Of the whole file, with as many values as it says.
  const VtuArray* find_of_file(std::string_view name) const;

  /// Three coordinates a point, m.
  std::vector<double> points() const { return read<double>("Points"); }
  /// All values of an array, whatever its type; those of a point lie together.
  std::vector<double> values(const VtuArray& array) const;
  /// The values as they were written. Throws FileError when there is no such array of this type.
  template <class T>
  std::vector<T> read(std::string_view name) const {
    return unpack<T>(checked(find(name), name, vtu_type<T>()));
  }

  template <class T>
  std::vector<T> read_of_file(std::string_view name) const {
    return unpack<T>(checked(find_of_file(name), name, vtu_type<T>()));
  }

 private:
  template <class T>
  std::vector<T> unpack(const VtuArray& array) const {
    std::vector<T> values(checked_bytes(array) / sizeof(T));
    unpack_bytes(array, reinterpret_cast<unsigned char*>(values.data()));
    return values;
  }
  template <class T>
  std::vector<double> widened(const VtuArray& array) const {
    const std::vector<T> values = unpack<T>(array);
    return std::vector<double>(values.begin(), values.end());
  }
  void read_header();
  const VtuArray& checked(const VtuArray* array, std::string_view name, std::string_view type) const;
  /// The size of the unpacked array, after its blocks were found to lie in the file and to make up that size.
  std::uint64_t checked_bytes(const VtuArray& array) const;
  void unpack_bytes(const VtuArray& array, unsigned char* out) const;
  [[noreturn]] void refuse(const std::string& why) const;

  std::filesystem::path path_;
  std::string text_;
  std::string_view appended_;  ///< of the text
  double time_{};
  std::size_t size_ = 0;
  std::vector<VtuArray> point_data_, others_, of_file_;
};

/// A frame of a series.
struct SeriesFrame {
  double time{};  ///< s
  std::filesystem::path file;
};

/// The frames that a PVD file lists, in its order; their paths count from its folder.
std::vector<SeriesFrame> read_pvd(const std::filesystem::path& path);

}  // namespace mpmfast
