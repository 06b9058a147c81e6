#pragma once

/// @file An open file of the system, where streams would hide what a full disk or a kill leaves behind.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

namespace mpmfast {

/// Closes itself. Everything throws FileError, which names `path`.
class Descriptor {
 public:
  static Descriptor open(const std::filesystem::path& path, bool writing = false);
  static Descriptor open_folder(const std::filesystem::path& path);
  static Descriptor create(const std::filesystem::path& path);  ///< or empties what is there
  /// Makes the file where there is none, and leaves what it holds.
  static Descriptor open_or_create(const std::filesystem::path& path);

  Descriptor() = default;
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();

  /// @return bytes that were read: fewer than n at the end of the file alone
  std::size_t read_at(char* out, std::size_t n, std::uint64_t offset,
                      const std::filesystem::path& path) const;
  void write_at(std::string_view content, std::uint64_t offset, const std::filesystem::path& path) const;
  void cut(std::uint64_t size, const std::filesystem::path& path) const;
  /// Waits until the disk has it.
  void sync(const std::filesystem::path& path) const;
  /// Claims the file for this process until its end. @return false when another one has it
  bool claim() const;
  /// Does the file still have a name?
  bool has_name() const;
  /// Is this file the one of that name?
  bool is_at(const std::filesystem::path& path) const;

 private:
  explicit Descriptor(int fd) : fd_(fd) {}
  int fd_ = -1;
};

/// Waits until the disk has the names of a folder, where its file system can tell.
void sync_folder(const std::filesystem::path& folder) noexcept;

}  // namespace mpmfast
