#pragma once

/// @file checkpoint.h5: an HDF5 file, one dataset a column, behind a seal of 512 bytes.
///
/// The seal is text: what the file is, its version, the number of columns, its length, and the XXH3-128 of
/// all bytes that follow. It is checked before HDF5 sees the file, so that whatever was cut off or altered is
/// refused.

#include <filesystem>
#include <set>
#include <string>

#include "engine/output/hdf5_file.hpp"
#include "engine/state/archive.hpp"

namespace mpmfast {

/// Of the names and meanings of the columns: raise it when they change.
inline constexpr int kCheckpointVersion = 15;

/// A file beside the one that is wanted: it is gone in the end, unless it took that one's place.
class AsideFile {
 public:
  explicit AsideFile(const std::filesystem::path& path);  ///< Throws FileError.
  AsideFile(const AsideFile&) = delete;
  ~AsideFile();
  const std::filesystem::path& path() const { return aside_; }
  void commit();  ///< Throws FileError.

 private:
  std::filesystem::path path_, aside_;
  bool done_ = false;
};

/// Writes beside the file and puts it in place when it is whole and on the disk: without keep(), nothing is
/// left of it.
class CheckpointWriter final : public Archive {
 public:
  /// Throws FileError, as all that follows.
  explicit CheckpointWriter(const std::filesystem::path& path);
  bool reading() const override { return false; }
  /// Seals the file and gives it its name. @param version for tests
  void keep(int version = kCheckpointVersion);

 private:
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override {
    file_.write(name, kind, values, n);
    ++columns_;
  }
  std::size_t length(const std::string&) override { return 0; }

  AsideFile aside_;
  Hdf5File file_;
  std::uint64_t columns_ = 0;
};

class CheckpointReader final : public Archive {
 public:
  /// Throws FileError: not there, truncated, of another version, altered.
  explicit CheckpointReader(const std::filesystem::path& path);
  bool reading() const override { return true; }
  /// Throws FileError if there are columns that nobody asked for.
  void finish() const;

 private:
  /// Throws FileError also where a real number is none (NaN): no state has one.
  void pass(const std::string& name, NumberKind kind, void* values, std::size_t n) override;
  std::size_t length(const std::string& name) override { return file_.length(name); }

  std::filesystem::path path_;
  std::uint64_t columns_;  ///< that were written
  Hdf5File file_;
  std::set<std::string> passed_;
};

}  // namespace mpmfast
