#include "engine/output/files.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <system_error>

#include "engine/errors.hpp"

namespace mpmfast {

void throw_file_error(std::string_view action, const std::filesystem::path& path, int error) {
  throw FileError(fmt::format("cannot {} {}: {}", action, path.string(),
                              error != 0 ? std::strerror(error) : "unknown reason"));
}

void write_aside(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path aside = path;
  aside += ".tmp";
  errno = 0;
  std::ofstream file(aside, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    const int reason = errno;
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw_file_error("write", path, reason);
  }
  std::error_code error;
  std::filesystem::rename(aside, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw_file_error("write", path, error.value());
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw_file_error("make the folder", folder, error.value());
}

}  // namespace mpmfast
