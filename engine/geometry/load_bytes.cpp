#include <fstream>
#include <iterator>
#include <system_error>

#include "engine/geometry/load.hpp"

namespace mpmfast {

std::optional<std::vector<unsigned char>> load_bytes(const std::filesystem::path& file,
                                                     std::string& why_not) {
  constexpr std::size_t kLargestFile = std::size_t{1} << 28;
  const auto refuse = [&](const char* why) {
    why_not = why;
    return std::nullopt;
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return refuse("no such file");
  if (!std::filesystem::is_regular_file(file, error)) return refuse("not a file");
  if (std::filesystem::file_size(file, error) > kLargestFile || error)
    return refuse("too large a file (at most 256 MiB)");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refuse("cannot be opened");
  std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) return refuse("reading failed");
  return bytes;
}

}  // namespace mpmfast
