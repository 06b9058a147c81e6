#include "command_mistakes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "engine/scene/text/suggest.hpp"

namespace mpmfast {

namespace {

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) out.push_back(name);
  return out;
}

/// "--force" for --froce, -force, -f.
std::string nearest_option(const std::string& word, const std::vector<std::string>& names) {
  const std::string bare = word.substr(std::min(word.find_first_not_of('-'), word.size()));
  for (const std::string& name : names)
    if (name == bare || (bare.size() == 1 && name[0] == bare[0])) return "--" + name;
  const std::string found = closest(bare, names);
  return found.empty() ? "" : "--" + found;
}

std::string name_of(const CLI::App& command) {
  return command.get_parent() ? "mpmfast " + command.get_name() : command.get_name();
}

std::string unknown_option(const CLI::App& command, const std::string& argument) {
  const std::string word = argument.substr(0, argument.find('='));
  const std::vector<std::string> names = option_names(command);
  const std::string nearest = nearest_option(word, names);
  return fmt::format("unknown option '{}' of '{}'{}", word, name_of(command),
                     nearest.empty() ? fmt::format(" (it has --{})", fmt::join(names, ", --"))
                                     : fmt::format(". Did you mean '{}'?", nearest));
}

}  // namespace

std::string mistake_text(const CLI::App& command, const CLI::ParseError& error, const std::string& first) {
  if (!command.get_parent() && first.rfind('-', 0) == 0) return unknown_option(command, first);
  // What CLI11 left over tells more than that something else is missing then.
  const std::vector<std::string> left = command.remaining();
  for (const std::string& word : left)
    if (word.rfind('-', 0) == 0) return unknown_option(command, word);
  if (dynamic_cast<const CLI::ExtrasError*>(&error))
    return fmt::format("'{}' takes no '{}'", name_of(command), fmt::join(left, " "));
  const std::string said = error.what();
  if (!dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return said;
  const std::string option = said.substr(0, said.find(':'));
  if (said.find(" missing") == std::string::npos) return fmt::format("{} is given more than once", option);
  return fmt::format("{}: a value is missing ({})", option, command.get_option(option)->get_type_name());
}

}  // namespace mpmfast
