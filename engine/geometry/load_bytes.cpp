#include "engine/geometry/load.hpp"
#include "engine/geometry/read_regular.hpp"

namespace mpmfast {

std::optional<std::vector<unsigned char>> load_bytes(const std::filesystem::path& file,
                                                     std::string& why_not) {
  constexpr std::size_t kLargestFile = std::size_t{1} << 28;
  const auto text = read_regular(file, kLargestFile, why_not);
  if (!text) return std::nullopt;
  return std::vector<unsigned char>(text->begin(), text->end());
}

}  // namespace mpmfast
