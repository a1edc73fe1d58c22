// SvgPlot: lines over two axes as inline SVG, for a page that needs no script
// and nothing from elsewhere.
//
// Colours are the page's own: the SVG names the classes s0, s1, ... of a
// series, and axis, grid, tick and label. Pure functions. Values that are not
// finite, and on a logarithmic axis those that are not above 0, break a line.
#ifndef TERRANE_CLIENT_BENCH_SVG_PLOT_H_
#define TERRANE_CLIENT_BENCH_SVG_PLOT_H_

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace terrane::client {

struct PlotAxis {
  std::string label;
  bool logarithmic = false;
  // Default: what the values take, and 0 on a linear axis.
  std::optional<std::pair<double, double>> range;
  // Default: round numbers.
  std::vector<std::pair<double, std::string>> ticks;
  // Default: a short number.
  std::function<std::string(double)> text;
};

// In the order of the classes s0, s1, ...
enum class PlotColor { kGreen, kOchre, kRed, kBlue, kViolet, kGrey };

struct PlotSeries {
  std::string name;
  PlotColor color = PlotColor::kGreen;
  std::vector<std::pair<double, double>> points;
  bool filled = false;    // down to the axis
  bool dashed = false;    // a line to compare with
  bool has_dots = false;  // each point is a run of its own
};

struct Plot {
  std::string title;
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotSeries> series;  // later ones over earlier ones
};

// A figure: title, legend and plot.
std::string PlotHtml(const Plot& plot);

// &, <, >, " as entities.
std::string EscapeHtml(const std::string& text);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_SVG_PLOT_H_
