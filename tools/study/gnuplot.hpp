#pragma once

/// @file Charts: a script for gnuplot beside the pictures that it draws.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mpmfast {

/// "text" as gnuplot reads it: the only way of a name, a title or a label into a script. No quote, escape,
/// command or macro in it is read as such; control characters become blanks.
std::string gnuplot_text(const std::string& text);

/// The same for the label of a tic, where gnuplot would read formats such as %g.
std::string gnuplot_tic(const std::string& text);

/// A block of data named $NAME, a row for each x.
std::string gnuplot_data(const std::string& name, std::span<const double> x, std::span<const double> y);

/// Where a chart goes: STEM.png and STEM.svg, drawn by STEM.gp; or with a format (png, svg, pdf) STEM.FORMAT
/// alone, drawn by STEM.FORMAT.gp, since STEM.gp may be someone's own. The stem may be any name of a file.
struct ChartFiles {
  std::filesystem::path folder;
  std::string stem;
  std::string format = "";
};

/// Writes the script and lets gnuplot draw from it, in a folder of its own: the pictures get their names from
/// this program.
/// @param data blocks; @param plot what is drawn once for each picture; sizes of points are multiples of
/// `point` there, since gnuplot draws them larger in SVG
/// @return empty, or why there is no picture (gnuplot is missing or refuses). Throws FileError.
std::string draw_with_gnuplot(const ChartFiles& files, const std::string& data, const std::string& plot,
                              int width, int height);

/// A colour for each of a few things that are easy to tell apart, then again from the first.
std::string chart_colour(std::size_t index);

/// The colour of a line; from the second time round dashed too, so that no two of some sixty look the same.
std::string chart_line(std::size_t index);

}  // namespace mpmfast
