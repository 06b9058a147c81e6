#include <nlohmann/json.hpp>
#include <string>

#include "engine/output/json_depth.hpp"
#include "entries.hpp"

namespace mpmfast::fuzz {

void read_json_bytes(Bytes bytes) {
  using Json = nlohmann::ordered_json;
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!is_shallow_json(text)) return;
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return;
  (void)json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mpmfast::fuzz
