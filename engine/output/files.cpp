#include "engine/output/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>

#include "engine/errors.hpp"

namespace mpmfast {

void throw_file_error(std::string_view action, const std::filesystem::path& path, int error) {
  throw FileError(fmt::format("cannot {} {}: {}", action, path.string(),
                              error != 0 ? std::strerror(error) : "unknown reason"));
}

namespace {

/// Where a chain of links ends, whether or not there is a file.
std::filesystem::path end_of_links(std::filesystem::path path) {
  constexpr int kMost = 40;  // as the kernel follows
  std::error_code error;
  for (int k = 0; k < kMost && std::filesystem::is_symlink(path, error); ++k)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path;
}

/// Returns 0 or why it could not.
int write_parts(const std::filesystem::path& path, std::span<const std::string_view> parts) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  for (const std::string_view part : parts)
    file.write(part.data(), static_cast<std::streamsize>(part.size()));
  file.close();
  if (file) return 0;
  return errno != 0 ? errno : EIO;
}

}  // namespace

void write_aside(const std::filesystem::path& path, std::span<const std::string_view> parts) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    if (const int reason = write_parts(path, parts)) throw_file_error("write", path, reason);
    return;
  }
  const std::filesystem::path target = end_of_links(path);
  std::filesystem::path aside = target;
  aside += ".tmp";
  if (const int reason = write_parts(aside, parts)) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw_file_error("write", path, reason);
  }
  std::filesystem::rename(aside, target, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw_file_error("write", path, error.value());
  }
}

void write_aside(const std::filesystem::path& path, std::string_view content) {
  write_aside(path, std::span(&content, 1));
}

bool has_control_character(const std::filesystem::path& path) {
  const std::string& name = path.native();
  return std::any_of(name.begin(), name.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw_file_error("make the folder", folder, error.value());
}

}  // namespace mpmfast
