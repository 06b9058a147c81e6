#pragma once

/// @file What a study file says, and the runs that it asks for.

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/problems.hpp"
#include "engine/scene/read_scene.hpp"
#include "error_measure.hpp"

namespace mpmfast {

/// An expression, and where it was written.
struct Formula {
  Expression expression;
  Place place;
  std::string path;
};

/// One override of the scene, and where it was written.
struct Setting {
  Override override;
  Place place;
  std::string path;
};

/// Axis → the values that are meant.
using Only = std::map<std::string, std::vector<std::string>>;

/// One value of an axis.
struct Choice {
  std::string name;
  std::vector<Setting> set;
  Constants let;                   ///< names for the study's expressions
  Only only;                       ///< what this one goes with
  std::optional<Setting> program;  ///< what runs it instead; the value is the path as written
};

/// The runs are the product of all axes. `variants:` is the first axis.
struct Axis {
  std::string name;
  Place place;
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

/// An error rule whose constants may be expressions.
struct ErrorSpec {
  std::string name = "error";
  std::optional<Formula> quantity, x, from, to, threshold, expected;
  ErrorRule rule;  ///< without its numbers
};

enum class Cost { wall, particle_steps };
inline constexpr std::array<Word<Cost>, 2> kCosts{{
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
  ErrorSpec error;
  std::vector<ErrorSpec> more;
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

/// Is the combination of choices allowed by `only`?
bool goes_with(const std::vector<Axis>& axes, const std::vector<std::size_t>& choice, const Only& only);

}  // namespace mpmfast
