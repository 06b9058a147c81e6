#include "engine/scene/schema/write_schema.hpp"

#include <fmt/format.h>

#include "commands.hpp"

namespace mpmfast {

int schema_command(const CommandLine& line) {
  fmt::print("{}", line.markdown ? write_reference() : write_schema());
  return 0;
}

}  // namespace mpmfast
