#pragma once

/// @file As much of HDF5 as a checkpoint needs: files of one-dimensional datasets, handles that close
/// themselves, failures as FileError.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "engine/state/archive.hpp"

namespace mpmfast {

/// An open object of HDF5, closed at the end of its life.
class Hdf5Handle {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Handle() = default;
  Hdf5Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { close(); }
  std::int64_t id() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// @return whether it went well (a file writes what it still holds)
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

class Hdf5File {
 public:
  /// A new file whose first `user_block` bytes (512 or a larger power of two) are left to others. Throws
  /// FileError.
  static Hdf5File create(const std::filesystem::path& path, std::size_t user_block);
  /// An existing file, to be read. Throws FileError.
  static Hdf5File open(const std::filesystem::path& path);

  /// Datasets are named by a path, "particles/mass". All throw FileError.
  void write(const std::string& name, NumberKind kind, const void* values, std::size_t n);
  void read(const std::string& name, NumberKind kind, void* values, std::size_t n) const;
  std::size_t length(const std::string& name) const;
  /// Writes what is not yet in the file.
  void close();

 private:
  using Lock = std::unique_lock<std::recursive_mutex>;
  static Lock lock();
  Hdf5File(std::filesystem::path path, Hdf5Handle file, Lock lock)
      : path_(std::move(path)), lock_(std::move(lock)), file_(std::move(file)) {}
  Hdf5Handle dataset(const std::string& name) const;

  std::filesystem::path path_;
  Lock lock_;  ///< the library knows one thread at a time; held as long as the file is open
  Hdf5Handle file_;
};

}  // namespace mpmfast
