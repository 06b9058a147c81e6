#pragma once

/// @file Charts of curves, in one panel or several.

#include <string>
#include <vector>

#include "gnuplot.hpp"
#include "table.hpp"

namespace mpmfast {

struct ChartCurve {
  std::string title;
  Curve curve;
  std::size_t colour = 0;  ///< curves with one title share it
  bool dashed = false;     ///< black: what the others are compared with
};

struct ChartPanel {
  std::string title;
  std::vector<ChartCurve> curves;
};

struct LineChart {
  std::string title, x_label, y_label;
  std::vector<ChartPanel> panels;
};

/// Long curves are thinned. Returns why there is no picture, or nothing.
std::string draw_line_chart(const ChartFiles& files, const LineChart& chart);

}  // namespace mpmfast
