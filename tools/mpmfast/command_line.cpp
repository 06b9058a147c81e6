#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "command_mistakes.hpp"
#include "complain.hpp"
#include "describe_command_line.hpp"
#include "engine/output/files.hpp"
#include "engine/quantities/quantity.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/text/suggest.hpp"
#include "exit_codes.hpp"
#include "mpmfast_version.hpp"
#include "option_checks.hpp"
#include "shell_text.hpp"
#include "starters.hpp"

namespace mpmfast {

namespace {

/// The option values as text; our own checks give messages that people can read.
struct RawOptions {
  std::string scene, out, topic, like, threads, jobs, launcher, restarts, steps, until, title,
      x = "time_s", progress = "auto";
  std::string frame, range, x_label, y_label;
  std::vector<std::string> set, folders, columns, fields, labels;
  bool force = false, markdown = false, verbose = false;
};

void add_scene_options(CLI::App& command, RawOptions& raw) {
  command.add_option("SCENE", raw.scene, "The scene, a YAML file")->required()->type_name("");
  // One value each time: a list option would swallow the scene that follows it.
  command
      .add_option("--set", raw.set, "Override a value of the scene, such as time.cfl=0.3; may be repeated")
      ->take_all()
      ->allow_extra_args(false)
      ->check(CLI::Validator(check_set, ""))
      ->type_name("KEY=VALUE");
}

void add_threads(CLI::App& command, RawOptions& raw) {
  command.add_option("--threads", raw.threads, "Threads; OMP_NUM_THREADS or the cores if not given")
      ->check(CLI::Validator(check_threads, ""))
      ->type_name("N");
}

void add_out(CLI::App& command, RawOptions& raw, const std::string& description) {
  command.add_option("--out", raw.out, description)->check(CLI::Validator(check_out, ""))->type_name("DIR");
}

void add_progress(CLI::App& command, RawOptions& raw) {
  command.add_option("--progress", raw.progress, "auto (a bar on a terminal, else lines), plain or none")
      ->check(CLI::Validator(check_progress, ""))
      ->type_name("auto|plain|none");
}

void add_until(CLI::App& command, RawOptions& raw, const std::string& description) {
  command.add_option("--until", raw.until, description)
      ->check(CLI::Validator(check_until, ""))
      ->type_name("TIME");
}

void add_resume_options(CLI::App& command, RawOptions& raw) {
  command.add_option("DIR", raw.scene, "The output folder of a run")->required()->type_name("");
  add_until(command, raw, "Stop at this time; where the run was to end if not given");
  add_threads(command, raw);
  add_progress(command, raw);
}

void add_study_options(CLI::App& command, RawOptions& raw) {
  command.add_option("STUDY", raw.scene, "The study, a YAML file")->required()->type_name("");
  add_out(command, raw, "Output folder; runs/<study> if not given. What has ended there is not run again");
  add_threads(command, raw);
  add_progress(command, raw);
  command
      .add_option("--jobs", raw.jobs,
                  "Runs side by side, here a thread each (default 1; more spoil the wall times of a chart)")
      ->check(CLI::Validator(check_jobs, ""))
      ->type_name("N");
  CLI::Option* launcher =
      command
          .add_option("--launcher", raw.launcher,
                      "Start each run by this command, such as \"srun -n1 -c{threads} -J {name}\"; a run "
                      "has 1 thread if --threads is not given")
          ->check(CLI::Validator(check_launcher, ""))
          ->type_name("COMMAND");
  command
      .add_option("--restarts", raw.restarts,
                  "How often a run that the launcher loses is started again; 2 if not given")
      ->check(CLI::Validator(check_restarts, ""))
      ->needs(launcher)
      ->type_name("N");
  command.add_flag("--force", raw.force,
                   "Run also what has ended already, and replace another study in the folder");
}

void add_plot_options(CLI::App& command, RawOptions& raw) {
  command.add_option("DIR", raw.folders, "Output folders of runs: of several, --columns in one chart")
      ->required()
      ->type_name("");
  const auto add_several = [&](const char* name, std::vector<std::string>& values, const char* description) {
    return command.add_option(name, values, description)->take_all()->allow_extra_args(false);
  };
  add_several(
      "--columns", raw.columns,
      "A column of history.csv or an expression of columns, instead of the usual charts; may be repeated")
      ->type_name("EXPR");
  command.add_option("--x", raw.x, "What they are drawn against; time_s if not given")->type_name("EXPR");
  command.add_option("--title", raw.title, "The title of that chart")->type_name("TEXT");
  add_several("--label", raw.labels,
              "A name in the legend: of a run, or with one run of a column; once for each, in their order")
      ->type_name("TEXT");
  command.add_option("--x-label", raw.x_label, "Label of the axis below; its unit follows")
      ->type_name("TEXT");
  command.add_option("--y-label", raw.y_label, "Label of the axis on the left; its unit follows")
      ->type_name("TEXT");
  command
      .add_option(
          "--out", raw.out,
          "A folder for what is drawn, or the one picture: .svg, .png or .pdf; that of the run if not given")
      ->check(CLI::Validator(check_out_file, ""))
      ->type_name("FILE_OR_DIR");
  add_several("--field", raw.fields,
              "Animate the particles coloured by pressure, von_mises, stress_xx, speed, plastic_strain, "
              "body, ... (as .pdf and .svg the last frame); may be repeated")
      ->type_name("FIELD");
  command.add_option("--frame", raw.frame, "Draw this frame alone: first, last or its number")
      ->type_name("N");
  command
      .add_option("--range", raw.range,
                  "Ends of the colours, such as \"50:300 MPa\" (both are MPa); all values if not given")
      ->type_name("LOW:HIGH");
}

void add_report_options(CLI::App& command, RawOptions& raw) {
  command.add_option("DIR", raw.scene, "The output folder of a run")->required()->type_name("");
  command.add_option("--out", raw.out, "The page; DIR/report.html, which is replaced, if not given")
      ->check(CLI::Validator(check_out_file, ""))
      ->type_name("FILE");
  command.add_flag("--force", raw.force, "Replace the file of --out");
}

void add_new_options(CLI::App& command, RawOptions& raw) {
  command.add_option("NAME", raw.scene, "The name: NAME.yaml is written, of a study NAME_scene.yaml too")
      ->required()
      ->type_name("");
  std::vector<std::string> kinds;
  for (const Starter& starter : kStarters) kinds.emplace_back(starter.name);
  command
      .add_option("--like", raw.like,
                  fmt::format("What it is like: one of these scenes, or a study; {} if not given", kinds[0]))
      ->type_name(fmt::format("{}", fmt::join(kinds, "|")));
  command.add_flag("--force", raw.force, "Replace files of that name");
}

/// Builds the commands; `raw` receives the values.
struct Commands {
  CLI::App app{"mpmfast: material point method with multimaterial contact", "mpmfast"};
  CLI::App *begin, *run, *resume, *check, *study, *plot, *report, *list, *schema, *man, *completion;

  explicit Commands(RawOptions& raw) {
    app.set_version_flag("--version",
                         fmt::format("mpmfast {} ({})\n{}, {}", kVersion, kGit, kCompiler, kFlags));
    app.require_subcommand(1);
    begin = app.add_subcommand("new", "Write a scene, or a study, to begin with");
    run = app.add_subcommand("run", "Run a scene");
    resume = app.add_subcommand("resume", "Go on with a run that was stopped, from its last checkpoint");
    check = app.add_subcommand("check", "Validate a scene and print the plan, without running it");
    study = app.add_subcommand("study", "Run the variants of a scene; table and chart of error against cost");
    plot = app.add_subcommand("plot", "Draw the history and the particles of a run");
    report = app.add_subcommand("report", "Write a page that shows a run: its histories and its particles");
    list = app.add_subcommand("list", "What this build offers");
    man = app.add_subcommand("man", "Print the man page: mpmfast man | man -l -");
    completion =
        app.add_subcommand("completion", "Print the completion for bash: source <(mpmfast completion)");
    add_new_options(*begin, raw);
    add_scene_options(*run, raw);
    add_scene_options(*check, raw);
    check->add_flag("--verbose", raw.verbose,
                    "Also all bodies, the passes of a step, and what particles and nodes carry");
    add_resume_options(*resume, raw);
    add_study_options(*study, raw);
    add_plot_options(*plot, raw);
    add_report_options(*report, raw);
    add_out(*run, raw, "Output folder; runs/<scene> if not given");
    add_threads(*run, raw);
    run->add_option("--steps", raw.steps, "Stop after so many steps")
        ->check(CLI::Validator(check_steps, ""))
        ->type_name("N");
    add_until(*run, raw, "Stop at this time, such as \"5 us\"");
    add_progress(*run, raw);
    run->add_flag("--force", raw.force, "Replace what an earlier run left in the output folder");
    schema = app.add_subcommand("schema", "The format of a scene as JSON Schema, for editors");
    schema->add_flag("--markdown", raw.markdown, "As a page to read: all keys, with examples");
    list->add_option("TOPIC", raw.topic, fmt::format("One of {}", fmt::join(catalogue_topics(), ", ")))
        ->type_name("");
  }

  std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const CLI::App* command : app.get_subcommands({})) out.push_back(command->get_name());
    return out;
  }

  /// The command that was chosen, or the program.
  const CLI::App& chosen() const {
    const std::vector<CLI::App*> all = app.get_subcommands();
    return all.empty() ? app : *all[0];
  }
};

int refuse(const std::string& message, const std::string& command = "") {
  complain("mpmfast: {}\nTry 'mpmfast {}--help'.\n", message, command.empty() ? "" : command + " ");
  return kExitWrongInput;
}

/// Is the word more likely a scene than a command?
bool file_like(const std::string& word) {
  const std::string end = std::filesystem::path(word).extension().string();
  std::error_code error;
  return end == ".yaml" || end == ".yml" || std::filesystem::is_regular_file(word, error);
}

/// What is wrong with a name of a file or folder; empty when nothing is.
std::string wrong_name(const RawOptions& raw) {
  std::vector<std::string> names = raw.folders;
  names.insert(names.end(), {raw.scene, raw.out});
  for (std::string& name : names) {
    if (!has_control_character(name)) continue;
    for (char& c : name)
      if (has_control_character(std::string(1, c))) c = '?';
    return fmt::format("a name holds a control character (a line's end, say; here '?'), got '{}'", name);
  }
  return "";
}

/// The command as a shell would take it again.
std::string command_text(int count, const char* const* arguments) {
  std::string out;
  for (int k = 0; k < count; ++k) out += (k ? " " : "") + shell_text(arguments[k]);
  return out;
}

CommandLine make_line(const Commands& commands, const RawOptions& raw) {
  CommandLine line;
  line.command = *commands.begin    ? Command::new_scene
                 : *commands.run    ? Command::run
                 : *commands.resume ? Command::resume
                 : *commands.check  ? Command::check
                 : *commands.study  ? Command::study
                 : *commands.plot   ? Command::plot
                 : *commands.report ? Command::report
                 : *commands.schema ? Command::schema
                                    : Command::list;
  line.folders = raw.folders;
  line.scene = raw.folders.empty() ? raw.scene : raw.folders[0];
  line.out = raw.out;
  line.topic = raw.topic;
  line.like = raw.like;
  line.set = raw.set;
  line.columns = raw.columns;
  line.title = raw.title;
  line.labels = raw.labels;
  line.x_label = raw.x_label;
  line.y_label = raw.y_label;
  line.fields = raw.fields;
  line.frame = raw.frame;
  line.range = raw.range;
  line.x = raw.x;
  line.force = raw.force;
  line.verbose = raw.verbose;
  line.markdown = raw.markdown;
  if (!raw.threads.empty()) read_whole(raw.threads, line.threads);
  if (!raw.jobs.empty()) read_whole(raw.jobs, line.jobs);
  if (!raw.launcher.empty()) line.launcher = *shell_words(raw.launcher);
  if (!raw.restarts.empty()) read_whole(raw.restarts, line.restarts);
  if (!raw.steps.empty()) read_whole(raw.steps, line.steps);
  if (!raw.until.empty()) line.until = std::get<double>(parse_quantity(raw.until, Measure::time));
  if (raw.progress == "plain") line.progress = ProgressStyle::plain;
  if (raw.progress == "none") line.progress = ProgressStyle::none;
  return line;
}

}  // namespace

std::vector<Override> CommandLine::overrides() const {
  std::vector<Override> out;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    out.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return out;
}

ParsedCommandLine parse_command_line(int count, const char* const* arguments) {
  RawOptions raw;
  Commands commands(raw);
  if (count < 2) {
    complain("{}", commands.app.help());
    return {std::nullopt, kExitWrongInput};
  }
  const std::string first = arguments[1];
  const std::vector<std::string> names = commands.names();
  if (first.rfind('-', 0) != 0 && std::find(names.begin(), names.end(), first) == names.end()) {
    const std::string hint =
        file_like(first) ? fmt::format("Did you mean 'mpmfast run {}'?", first) : did_you_mean(first, names);
    return {std::nullopt, refuse(fmt::format("unknown command '{}' (one of {}){}{}", first,
                                             fmt::join(names, ", "), hint.empty() ? "" : ". ", hint))};
  }
  try {
    commands.app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return {std::nullopt, commands.app.exit(error)};  // help, version
    const CLI::App& command = commands.chosen();
    return {std::nullopt,
            refuse(mistake_text(command, error, first), command.get_parent() ? command.get_name() : "")};
  }
  if (*commands.man || *commands.completion) {
    fmt::print("{}", *commands.man ? man_page(commands.app) : bash_completion(commands.app));
    return {std::nullopt, 0};
  }
  if (const std::string wrong = wrong_name(raw); !wrong.empty() && !*commands.begin)
    return {std::nullopt, refuse(wrong)};
  CommandLine line = make_line(commands, raw);
  line.text = command_text(count, arguments);
  return {line, 0};
}

}  // namespace mpmfast
