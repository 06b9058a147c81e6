#include "line_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace mpmfast {

namespace {

constexpr std::size_t kMostPoints = 250;  // of a curve: more than a picture shows

Curve thinned(const Curve& curve) {
  const std::size_t stride = (curve.x.size() + kMostPoints - 1) / kMostPoints;
  if (stride <= 1) return curve;
  Curve out;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    if (k % stride != 0 && k + 1 != curve.x.size()) continue;
    out.x.push_back(curve.x[k]);
    out.y.push_back(curve.y[k]);
  }
  return out;
}

std::string style_of(const ChartCurve& curve) {
  return curve.dashed ? "with lines lw 2 dt 2 lc rgb 'black'"
                      : "with lines lw 1.5 " + chart_line(curve.colour);
}

/// A panel that holds nothing but what the colours of the others mean.
std::string legend_panel(const LineChart& chart) {
  std::vector<const ChartCurve*> curves;
  for (const ChartPanel& panel : chart.panels)
    for (const ChartCurve& curve : panel.curves)
      if (std::none_of(curves.begin(), curves.end(),
                       [&](const ChartCurve* c) { return c->title == curve.title; }))
        curves.push_back(&curve);
  std::stable_sort(curves.begin(), curves.end(), [](const ChartCurve* a, const ChartCurve* b) {
    return std::pair(a->dashed, a->colour) < std::pair(b->dashed, b->colour);
  });
  std::string plot;
  for (const ChartCurve* curve : curves)
    plot += fmt::format("{}NaN {} title {}", plot.empty() ? "plot [0:1][0:1] " : ", \\\n  ", style_of(*curve),
                        gnuplot_text(curve->title));
  return "unset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\nunset grid\n"
         "set key at graph 0,1 left top Left reverse samplen 2\n" +
         plot + "\nset border\nset tics\n";
}

}  // namespace

std::string draw_line_chart(const ChartFiles& files, const LineChart& chart) {
  const bool several = chart.panels.size() > 1;
  const std::size_t cells = chart.panels.size() + (several ? 1 : 0);
  const std::size_t across = several ? (cells <= 4 ? 2 : 3) : 1, down = (cells + across - 1) / across;
  std::string data, plot;
  if (several) {
    plot = fmt::format("set multiplot layout {},{} title {}\nunset key\n", down, across,
                       gnuplot_text(chart.title));
  } else {
    plot = "set key outside right top Left reverse samplen 2\n";
  }
  plot += "set grid lt 1 lc rgb '#dddddd'\nset autoscale xfix\n";
  plot +=
      fmt::format("set xlabel {}\nset ylabel {}\n", gnuplot_text(chart.x_label), gnuplot_text(chart.y_label));
  std::size_t blocks = 0;
  for (const ChartPanel& panel : chart.panels) {
    plot += fmt::format("set title {}\nplot ", gnuplot_text(several ? panel.title : chart.title));
    for (std::size_t k = 0; k < panel.curves.size(); ++k) {
      const Curve shown = thinned(panel.curves[k].curve);
      const std::string name = fmt::format("curve{}", blocks++);
      data += gnuplot_data(name, shown.x, shown.y);
      plot += fmt::format("{}${} {} title {}", k ? ", \\\n  " : "", name, style_of(panel.curves[k]),
                          gnuplot_text(panel.curves[k].title));
    }
    if (panel.curves.empty()) plot += "NaN notitle";
    plot += "\n";
  }
  if (several) plot += legend_panel(chart) + "unset multiplot\n";
  const int width = several ? static_cast<int>(480 * across) : 1000;
  const int height = several ? static_cast<int>(360 * down + 30) : 560;
  return draw_with_gnuplot(files, data, plot, width, height);
}

}  // namespace mpmfast
