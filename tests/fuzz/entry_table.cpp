#include <stdexcept>
#include <string>

#include "engine/errors.hpp"
#include "entries.hpp"
#include "tools/study/table.hpp"

namespace mpmfast::fuzz {

void read_table_bytes(Bytes bytes) {
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Unended last : {Unended::whole, Unended::torn}) try {
      const Table table = parse_table(text, "history.csv", last);
      if (table.names.size() != table.columns.size()) throw std::logic_error("a column has no name");
      for (const auto& column : table.columns)
        if (column.size() != table.rows()) throw std::logic_error("a column is shorter than others");
    } catch (const FileError& error) {
      if (!std::string(error.what()).starts_with("history.csv:"))
        throw std::logic_error("refused without saying where");
    }
}

}  // namespace mpmfast::fuzz
