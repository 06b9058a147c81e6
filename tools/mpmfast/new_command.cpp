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
#include "engine/quantities/code_point.hpp"
#include "engine/scene/text/suggest.hpp"
#include "exit_codes.hpp"
#include "shell_text.hpp"
#include "starters.hpp"

namespace mpmfast {

namespace {

namespace fs = std::filesystem;

int refuse_to_make(const std::string& what) {
  complain("mpmfast: {}\n", what);
  return kExitWrongInput;
}

bool is_utf8(const std::string& name) {
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t bytes = code_point(name, at).bytes;
    if (bytes == 0) return false;
    at += bytes;
  }
  return true;
}

/// The file that the name means, "die" or "scenes/die.yaml"; nothing when it cannot name an output folder or
/// stand in a study too.
std::optional<fs::path> file_of(const std::string& name) {
  fs::path file = name;
  if (file.extension() != ".yaml" && file.extension() != ".yml") file += ".yaml";
  const std::string stem = file.stem().string();
  const auto good = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte > 0x20 && byte != 0x7F && c != '/' && c != '\\';
  };
  if (!is_utf8(name) || has_control_character(name) || stem.empty() || stem.front() == '.' ||
      stem.front() == '-' || !std::all_of(stem.begin(), stem.end(), good))
    return std::nullopt;
  return file;
}

/// As YAML takes it for a text, whatever the name holds: a study expands no ${…}.
std::string yaml_text(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (std::all_of(name.begin(), name.end(), plain)) return name;
  std::string out = "\"";
  for (const char c : name) out += c == '"' ? std::string("\\\"") : std::string(1, c);
  return out + "\"";
}

struct NewFile {
  fs::path path;
  std::string text;
};

/// What is written under a name: the scene, or the study and the scene that it varies.
std::vector<NewFile> files_of(const Starter& starter, const fs::path& file) {
  std::string text(starter.text);
  if (starter.scene.empty()) return {{file, text}};
  fs::path scene = file;
  scene.replace_filename(file.stem().string() + "_scene" + file.extension().string());
  text.replace(text.find(kStudyScene), kStudyScene.size(), yaml_text(scene.filename().string()));
  return {{file, text}, {scene, std::string(starter.scene)}};
}

void print_next(const std::vector<NewFile>& files) {
  const auto command = [](const char* name, const NewFile& file) {
    return fmt::format("mpmfast {} {}", name, shell_text(file.path.string()));
  };
  for (const NewFile& file : files) say("{}\n", file.path.string());
  const bool study = files.size() > 1;
  say("to see its plan  {}\nto run it        {}\n", command("check", files.back()),
      command(study ? "study" : "run", files.front()));
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
    return refuse_to_make(fmt::format("--like: not known here (one of {}), got '{}'{}",
                                      fmt::join(known, ", "), kind, hint.empty() ? "" : ". " + hint));
  }
  const auto file = file_of(line.scene);
  if (!file)
    return refuse_to_make(
        fmt::format("not a name for a scene (such as impact or scenes/impact), got '{}'", line.scene));
  const std::vector<NewFile> files = files_of(*starter, *file);
  for (const NewFile& one : files) {
    std::error_code error;
    if (!line.force && fs::exists(fs::symlink_status(one.path, error)))
      return refuse_to_make(fmt::format("{} exists (--force replaces it)", one.path.string()));
  }
  for (const NewFile& one : files) write_aside(one.path, one.text);
  print_next(files);
  return 0;
}

}  // namespace mpmfast
