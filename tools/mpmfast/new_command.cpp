#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "commands.hpp"
#include "complain.hpp"
#include "engine/output/files.hpp"
#include "engine/scene/text/suggest.hpp"
#include "exit_codes.hpp"
#include "shell_text.hpp"
#include "starters.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

int refuse(const std::string& what) {
  complain("mpmfast: {}\n", what);
  return kExitWrongInput;
}

/// The file that the name means, "die" or "scenes/die.yaml"; nothing when it cannot name an output folder
/// too.
std::optional<fs::path> file_of(const std::string& name) {
  fs::path file = name;
  if (file.extension() != ".yaml" && file.extension() != ".yml") file += ".yaml";
  const std::string stem = file.stem().string();
  const auto good = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte > 0x20 && byte != 0x7F && c != '/' && c != '\\';
  };
  if (stem.empty() || stem.front() == '.' || stem.front() == '-' ||
      !std::all_of(stem.begin(), stem.end(), good))
    return std::nullopt;
  return file;
}

}  // namespace

int new_command(const CommandLine& line) {
  const std::string kind = line.like.empty() ? kStarters[0].name : line.like;
  const Starter* starter = nullptr;
  std::vector<std::string> known;
  for (const Starter& one : kStarters) {
    known.emplace_back(one.name);
    if (kind == one.name) starter = &one;
  }
  if (!starter) {
    const std::string hint = did_you_mean(kind, known);
    return refuse(fmt::format("--like: no such scene (one of {}), got '{}'{}", fmt::join(known, ", "), kind,
                              hint.empty() ? "" : ". " + hint));
  }
  const auto file = file_of(line.scene);
  if (!file)
    return refuse(
        fmt::format("not a name for a scene (such as impact or scenes/impact), got '{}'", line.scene));
  std::error_code error;
  if (!line.force && fs::exists(fs::symlink_status(*file, error)))
    return refuse(fmt::format("{} exists (--force replaces it)", file->string()));
  write_aside(*file, starter->text);
  fmt::print("{}\n", file->string());
  fmt::print("to see its plan  mpmfast check {}\nto run it        mpmfast run {}\n",
             shell_text(file->string()), shell_text(file->string()));
  return 0;
}

}  // namespace mpmfast
