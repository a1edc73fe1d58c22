// A line plot of profiles: axes with ticks and numbers, one line a series,
// verticals at marked places. Error: INVALID_ARGUMENT when there is no point to
// draw.
#ifndef TERRANE_CLIENT_RENDER_PLOT_H_
#define TERRANE_CLIENT_RENDER_PLOT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/render/canvas.h"

namespace terrane::client {

// y over x, both of one length; a NaN in y breaks the line.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  Rgb colour;
  double line_width = 1.6;
};

struct PlotOptions {
  int width = 1200;
  int height = 420;
  std::string title;
  std::string x_label;
  std::string y_label;
  // Verticals from the bottom axis up to the last series, with a dot there.
  std::vector<double> marks;
  // A horizontal sheet of water, under the lines.
  std::optional<double> water_level;
};

absl::StatusOr<Picture> RenderPlot(const std::vector<Series>& series,
                                   const PlotOptions& options);

// Tick positions that cover [minimum, maximum] with about `count` steps of 1, 2
// or 5 times a power of ten. minimum < maximum.
std::vector<double> NiceTicks(double minimum, double maximum, int count);

// A tick's number without superfluous digits; `step` is the ticks' distance.
std::string TickText(double value, double step);

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_RENDER_PLOT_H_
