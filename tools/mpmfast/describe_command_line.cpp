#include "describe_command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "engine/output/particle_access.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/schema/write_schema.hpp"
#include "mpmfast_version.hpp"

namespace mpmfast {

namespace {

/// Text as the page shows it: a '-' is a minus, a first '.' no request.
std::string roff(std::string_view text) {
  std::string out = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\') out += "\\e";
    if (c == '-') out += "\\-";
    if (c != '\\' && c != '-') out += c;
  }
  return out;
}

std::string positional_of(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) return option->get_name();
  return "";
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> out;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional() && !option->get_lnames().empty()) out.push_back(option);
  return out;
}

std::string man_command(const CLI::App& command) {
  const std::string positional = positional_of(command);
  std::string out = fmt::format(".SS mpmfast {}{}\n{}.\n", roff(command.get_name()),
                                positional.empty() ? "" : " \\fI" + roff(positional) + "\\fR",
                                roff(command.get_description()));
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_lnames()[0] == "help") continue;
    out += fmt::format(".TP\n\\fB\\-\\-{}\\fR", roff(option->get_lnames()[0]));
    if (option->get_items_expected_max() > 0)
      out += fmt::format(" \\fI{}\\fR", roff(option->get_type_name()));
    out += fmt::format("\n{}.\n", roff(option->get_description()));
  }
  return out;
}

constexpr std::string_view kManEnd = R"(.SH EXIT STATUS
.TP
0
finished
.TP
2
the command line or the scene is wrong; nothing was written
.TP
3
the run failed; the message says step, time, particle, body, place and cause, and what there was is kept
.TP
4
a file could not be read or written, or a launcher lost runs of a study
.TP
129, 130, 131, 138, 140, 142, 143, 152
stopped after a step by SIGHUP, SIGINT, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGTERM or SIGXCPU (128 and the number of
the signal); \fBmpmfast resume\fR goes on
.SH FILES
An output folder holds \fIscene.yaml\fR (the scene with every default), \fIrun.json\fR (figures and warnings),
\fIhistory.csv\fR, \fIparticles.pvd\fR (opens in ParaView), \fIcheckpoint.h5\fR and pictures.
.SH ENVIRONMENT
.TP
\fBOMP_NUM_THREADS\fR
threads where \-\-threads does not say
.TP
\fBOMP_WAIT_POLICY\fR
if set, or GOMP_SPINCOUNT, the program does not start itself again at launch with threads that sleep soon between steps
.SH EXAMPLES
.TP
mpmfast run ellipses.yaml \-\-set grid.cell="1/20 mm" \-\-out small
a scene, coarser than it is written
.TP
mpmfast check ellipses.yaml
what a run would need, without running it
)";

/// What a word after the command may be.
std::string completed_positional(const std::string& positional) {
  if (positional == "SCENE" || positional == "STUDY")
    return "_mpmfast_offer -f -X '!*.yaml' -- \"$word\"; _mpmfast_offer -d -- \"$word\"";
  if (positional == "DIR") return "_mpmfast_offer -d -- \"$word\"";
  if (positional == "TOPIC")
    return fmt::format("_mpmfast_offer -W '{}' -- \"$word\"", fmt::join(catalogue_topics(), " "));
  return ":";
}

/// The words of "auto|plain|none"; nothing for other type names.
std::string choices(const std::string& type_name) {
  std::string out = type_name;
  if (out.find('|') == std::string::npos) return "";
  for (char& c : out) c = c == '|' ? ' ' : c;
  return out;
}

/// "grid.cell=", "gravity=": what --set may change but for bodies, materials and boundaries, whose names are
/// the scene's.
std::vector<std::string> settings() {
  std::vector<std::string> out;
  const auto schema = nlohmann::json::parse(write_schema());
  for (const auto& [section, says] : schema["properties"].items()) {
    if ((says.contains("type") && says["type"] == "array") || section == "materials" ||
        section == "boundaries")
      continue;
    std::vector<nlohmann::json> forms = says.value("anyOf", std::vector<nlohmann::json>{});
    forms.push_back(says);
    const std::size_t before = out.size();
    for (const auto& form : forms)
      if (form.contains("properties"))
        for (const auto& key : form["properties"].items()) out.push_back(section + "." + key.key() + "=");
    if (out.size() == before) out.push_back(section + "=");
  }
  return out;
}

/// A case of the word before, after which these words may stand.
std::string offer(const std::string& option, const std::vector<std::string>& words) {
  return fmt::format("    --{}) _mpmfast_offer -W '{}' -- \"$word\"; return ;;\n", option,
                     fmt::join(words, " "));
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string out = fmt::format(
      ".TH MPMFAST 1 \"\" \"mpmfast {}\" \"User Commands\"\n"
      ".SH NAME\nmpmfast \\- material point method with multimaterial frictional contact\n"
      ".SH SYNOPSIS\n\\fBmpmfast\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
      ".SH DESCRIPTION\nRuns scenes written in YAML: solid bodies in two or three dimensions that deform, "
      "touch, slide and\n"
      "stick. \\fBmpmfast list\\fR names what a scene may hold.\n.SH COMMANDS\n",
      kVersion);
  for (const CLI::App* command : app.get_subcommands({})) out += man_command(*command);
  return out + std::string(kManEnd);
}

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string cases, values = offer("field", field_names(3)) + offer("frame", {"first", "last"});
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    std::vector<std::string> options;
    for (const CLI::Option* option : options_of(*command)) {
      const std::string& name = option->get_lnames()[0];
      options.push_back("--" + name);
      const std::string words = choices(option->get_type_name());
      const std::string line = offer(name, {words});
      if (!words.empty() && values.find(line) == std::string::npos) values += line;
    }
    cases += fmt::format("    {}) options='{}'; {} ;;\n", command->get_name(), fmt::join(options, " "),
                         completed_positional(positional_of(*command)));
  }
  return fmt::format(
      "# Completion of mpmfast for bash: printed by `mpmfast completion`.\n"
      "# A line of compgen is a word, whatever blanks and stars are in it.\n"
      "_mpmfast_offer() {{\n"
      "  local line\n"
      "  while IFS= read -r line; do COMPREPLY+=(\"$line\"); done < <(compgen \"$@\")\n"
      "}}\n"
      "_mpmfast() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} options=\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    _mpmfast_offer -W '{} --help --version' -- \"$word\"\n"
      "    return\n"
      "  fi\n"
      "  case $before in\n{}"
      "    --out) _mpmfast_offer -d -- \"$word\"; return ;;\n"
      "    --set) _mpmfast_offer -W '{}' -- \"$word\"; compopt -o nospace 2>/dev/null; return ;;\n"
      "  esac\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  case $word in -*) COMPREPLY=(); _mpmfast_offer -W \"$options\" -- \"$word\" ;; esac\n"
      "}}\n"
      "complete -o filenames -F _mpmfast mpmfast\n",
      fmt::join(names, " "), values, fmt::join(settings(), " "), cases);
}

}  // namespace mpmfast
