#pragma once

/// @file What a study file says, and the runs that it asks for.

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/read_scene.hpp"
#include "engine/scene/text/problems.hpp"
#include "error_measure.hpp"

namespace mpmfast {

/// An expression, and where it was written.
struct Formula {
  Expression expression;
  SourceLocation location;
  std::string path;
};

/// One override of the scene, and where it was written.
struct Setting {
  Override override;
  SourceLocation location;
  std::string path;
};

/// Axis → the values that are meant.
using Only = std::map<std::string, std::vector<std::string>>;

/// An error rule whose constants may be expressions.
struct ErrorSpec {
  std::string name = "error";
  std::optional<Formula> quantity, x, from, to, threshold, expected;
  ErrorRule rule;  ///< without its numbers
};

/// One value of an axis.
struct Choice {
  std::string name;
  std::string label;  ///< in names of runs; with the key where the value alone is ambiguous: "cfl=0.2"
  std::vector<Setting> set;
  Constants let;                               ///< names for the study's expressions
  Only only;                                   ///< what this one goes with
  std::optional<std::filesystem::path> scene;  ///< instead of the study's
  std::optional<ErrorSpec> error;              ///< instead of the study's
  std::optional<Setting> program;              ///< what runs it instead; the value is the path as written
};

/// The runs are the product of all axes. `variants:` is the first axis.
struct Axis {
  std::string name;
  SourceLocation location;
  std::vector<Choice> choices;
};

struct Reference {
  enum class Kind { none, runs, expression, table } kind = Kind::none;
  std::vector<Setting> set;           ///< runs
  std::vector<std::size_t> per;       ///< runs: the axes that are repeated, by index
  std::optional<Formula> expression;  ///< over the columns of the variant's own history
  Table table;
  std::optional<Formula> x, y;  ///< of the table; those of the error when not given
};

/// What must hold in a run, row by row of its history.
struct Condition {
  std::string name;  ///< what is wrong where it does not hold: a word or two for a cell of a map
  std::optional<Formula> quantity, over, at_least, at_most;
  std::optional<Formula> from, to;  ///< the window of time_s in which it must hold
  bool change = false;              ///< the quantity less its first value
  bool at_end = false;              ///< judged in the last row alone
  Only only;
};

enum class Over { final_value, maximum, minimum, mean };
inline constexpr std::array<Keyword<Over>, 4> kOvers{{
    {Over::final_value, "final", "the value of the last row (default)"},
    {Over::maximum, "max", "the largest value of the history"},
    {Over::minimum, "min", "the smallest value of the history"},
    {Over::mean, "mean", "the mean of the history's rows"},
}};

/// A number of each run that is reported, without an error.
struct QuantitySpec {
  std::string name;
  std::optional<Formula> quantity;
  Over over = Over::final_value;
};

/// A chart and a list of what holds: a map for each value of one axis.
struct MapSpec {
  std::size_t panels = 0, columns = 0;  ///< axes
  std::optional<std::size_t> judged;    ///< the column up to which the first row must hold
};

enum class Cost { wall, particle_steps };
inline constexpr std::array<Keyword<Cost>, 2> kCosts{{
    {Cost::wall, "wall_s", "wall time of the run"},
    {Cost::particle_steps, "particle_steps", "particles x steps"},
}};

/// A chart of one quantity of all runs.
struct CurveSpec {
  std::string name, title, x_label, y_label;
  std::optional<Formula> x, y;
  std::optional<Formula> from, to;    ///< the window of x that is shown
  std::optional<std::size_t> panels;  ///< the axis that has a panel for each value
  Only only;
};

struct Study {
  std::filesystem::path file, scene;
  std::string title, text;
  std::vector<Setting> common;
  std::vector<Axis> axes;
  Reference reference;
  std::optional<ErrorSpec> error;  ///< without one, the error is the largest share of a condition's bound
  std::vector<ErrorSpec> more;
  std::vector<Condition> conditions;
  std::vector<QuantitySpec> quantities;
  std::optional<MapSpec> map;
  std::optional<std::size_t> panels;  ///< the axis of which each value has a front and a chart of its own
  std::vector<Cost> costs{Cost::wall};
  std::vector<CurveSpec> curves;
};

/// Throws SceneError with every error found, FileError when a file cannot be read.
Study read_study(const std::filesystem::path& file);
Study parse_study(const std::string& text, const std::filesystem::path& file);

/// One run of a study.
struct StudyRun {
  std::string name, folder;
  std::vector<std::size_t> choice;  ///< of each axis; of a reference, 0 where the axis does not matter
  Constants let;
  std::filesystem::path scene_file;
  Scene scene;
  std::filesystem::path program;  ///< that runs it; empty: this one
  std::size_t reference = 0;      ///< index among the references
};

struct StudyRuns {
  std::vector<StudyRun> references, variants;
};

/// Reads the scene of every run and checks all expressions against the columns of its history. Throws
/// SceneError: an override that the scene refuses is reported where the study gives it.
StudyRuns expand_study(const Study& study);

/// "LR, xpic(5)" → "lr_xpic5": what every file system takes.
std::string file_name_of(const std::string& name);

/// Of a combination of choices: the error, where there is one (that of the last axis that has its own, or the
/// study's), then Study::more.
std::vector<ErrorSpec> error_specs(const Study& study, const std::vector<std::size_t>& choice);

/// Are the runs compared by an error, or only reported?
inline bool has_error(const Study& study) { return study.error || !study.conditions.empty(); }

/// The scene that a combination of choices runs: that of the last axis that names one, or the study's.
std::filesystem::path scene_of(const Study& study, const std::vector<std::size_t>& choice);

/// Is the combination of choices allowed by `only`?
bool goes_with(const std::vector<Axis>& axes, const std::vector<std::size_t>& choice, const Only& only);

}  // namespace mpmfast
