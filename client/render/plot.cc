#include "client/render/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrane::client {
namespace {

constexpr Rgb kPaper{1, 1, 1};
constexpr Rgb kInk{0.15, 0.15, 0.17};
constexpr Rgb kGrid{0.90, 0.90, 0.91};
constexpr Rgb kMark{0.80, 0.25, 0.20};
constexpr Rgb kWater{0.80, 0.89, 0.96};

constexpr int kTickTextSize = 15;
constexpr int kLabelSize = 16;
constexpr int kTitleSize = 19;
constexpr int kTop = 64;
constexpr int kBottom = 62;
constexpr int kRight = 26;

struct Range {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();

  void Include(double value) {
    if (std::isnan(value)) return;
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
  }
  bool empty() const { return minimum > maximum; }
  // A range of some extent, wider by `share` on both sides.
  Range Widened(double share) const {
    const double extent = maximum - minimum;
    const double margin =
        extent > 0 ? extent * share : std::max(std::abs(minimum), 1.0) * 0.1;
    return {minimum - margin, maximum + margin};
  }
};

// The plot's rectangle on the canvas and the world's rectangle that it shows.
struct Frame {
  double left, top, right, bottom;
  Range x, y;

  PixelPoint At(double world_x, double world_y) const {
    return {
        left + (world_x - x.minimum) / (x.maximum - x.minimum) * (right - left),
        bottom -
            (world_y - y.minimum) / (y.maximum - y.minimum) * (bottom - top)};
  }
};

double StepOf(const std::vector<double>& ticks) {
  return ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
}

void DrawAxes(const Frame& frame, const std::vector<double>& x_ticks,
              const std::vector<double>& y_ticks, const PlotOptions& options,
              Canvas* canvas) {
  for (const double tick : x_ticks) {
    const PixelPoint foot = frame.At(tick, frame.y.minimum);
    canvas->DrawLine({foot.x, frame.top}, {foot.x, frame.bottom}, 1, kGrid);
    canvas->DrawLine(foot, {foot.x, frame.bottom + 5}, 1, kInk);
    canvas->DrawText({foot.x, frame.bottom + 17},
                     TickText(tick, StepOf(x_ticks)), kTickTextSize,
                     TextAlign::kMiddle, kInk);
  }
  for (const double tick : y_ticks) {
    const PixelPoint foot = frame.At(frame.x.minimum, tick);
    canvas->DrawLine({frame.left, foot.y}, {frame.right, foot.y}, 1, kGrid);
    canvas->DrawLine({frame.left - 5, foot.y}, foot, 1, kInk);
    canvas->DrawText({frame.left - 9, foot.y}, TickText(tick, StepOf(y_ticks)),
                     kTickTextSize, TextAlign::kRight, kInk);
  }
  canvas->DrawLine({frame.left, frame.top}, {frame.left, frame.bottom}, 1,
                   kInk);
  canvas->DrawLine({frame.left, frame.bottom}, {frame.right, frame.bottom}, 1,
                   kInk);
  canvas->DrawText({(frame.left + frame.right) / 2, frame.bottom + 44},
                   options.x_label, kLabelSize, TextAlign::kMiddle, kInk);
  canvas->DrawText({frame.left, 20}, options.title, kTitleSize,
                   TextAlign::kLeft, kInk);
  canvas->DrawText({14, frame.top - 14}, options.y_label, kLabelSize,
                   TextAlign::kLeft, kInk);
}

void DrawSeries(const Frame& frame, const Series& series, Canvas* canvas) {
  for (std::size_t i = 1; i < series.x.size(); ++i) {
    if (std::isnan(series.y[i - 1]) || std::isnan(series.y[i])) continue;
    canvas->DrawLine(frame.At(series.x[i - 1], series.y[i - 1]),
                     frame.At(series.x[i], series.y[i]), series.line_width,
                     series.colour);
  }
}

// Names of the series at the top right, each after a piece of its line.
void DrawLegend(const Frame& frame, const std::vector<Series>& series,
                Canvas* canvas) {
  if (series.size() < 2) return;
  double right = frame.right;
  for (auto one = series.rbegin(); one != series.rend(); ++one) {
    right -= Canvas::TextWidth(one->name, kTickTextSize);
    canvas->DrawText({right, 20}, one->name, kTickTextSize, TextAlign::kLeft,
                     kInk);
    canvas->DrawLine({right - 34, 20}, {right - 8, 20}, one->line_width + 0.6,
                     one->colour);
    right -= 58;
  }
}

// Height of a series at x, between its points.
double HeightAt(const Series& series, double x) {
  const auto after = std::lower_bound(series.x.begin(), series.x.end(), x);
  if (after == series.x.end()) return series.y.back();
  const auto at = static_cast<std::size_t>(after - series.x.begin());
  if (at == 0 || *after == x) return series.y[at];
  const double share =
      (x - series.x[at - 1]) / (series.x[at] - series.x[at - 1]);
  return series.y[at - 1] + share * (series.y[at] - series.y[at - 1]);
}

void DrawMarks(const Frame& frame, const Series& series,
               const std::vector<double>& marks, Canvas* canvas) {
  for (const double mark : marks) {
    if (mark < frame.x.minimum || mark > frame.x.maximum) continue;
    const PixelPoint top = frame.At(mark, HeightAt(series, mark));
    if (std::isnan(top.y)) continue;
    canvas->DrawLine({top.x, frame.bottom}, top, 1.4, kMark);
    canvas->DrawLine(top, top, 7, kMark);
  }
}

}  // namespace

absl::StatusOr<Picture> RenderPlot(const std::vector<Series>& series,
                                   const PlotOptions& options) {
  Range x;
  Range y;
  for (const Series& one : series) {
    for (const double value : one.x) x.Include(value);
    for (const double value : one.y) y.Include(value);
  }
  if (x.empty() || y.empty()) {
    return absl::InvalidArgumentError("profile: there is no height to draw");
  }
  if (options.water_level.has_value()) y.Include(*options.water_level);
  y = y.Widened(0.06);
  if (x.minimum == x.maximum) x = x.Widened(0);

  const std::vector<double> y_ticks = NiceTicks(y.minimum, y.maximum, 6);
  int widest = 0;
  for (const double tick : y_ticks) {
    widest = std::max(widest, Canvas::TextWidth(TickText(tick, StepOf(y_ticks)),
                                                kTickTextSize));
  }
  const Frame frame{widest + 30.0,
                    kTop,
                    static_cast<double>(options.width - kRight),
                    static_cast<double>(options.height - kBottom),
                    x,
                    y};
  Canvas canvas(options.width, options.height, kPaper);
  if (options.water_level.has_value()) {
    const int top = static_cast<int>(frame.At(0, *options.water_level).y);
    canvas.FillBox(static_cast<int>(frame.left), top,
                   static_cast<int>(frame.right - frame.left),
                   static_cast<int>(frame.bottom) - top, kWater);
  }
  DrawAxes(frame, NiceTicks(x.minimum, x.maximum, options.width / 110), y_ticks,
           options, &canvas);
  for (const Series& one : series) DrawSeries(frame, one, &canvas);
  DrawMarks(frame, series.back(), options.marks, &canvas);
  DrawLegend(frame, series, &canvas);
  return canvas.picture();
}

std::vector<double> NiceTicks(double minimum, double maximum, int count) {
  const double raw = (maximum - minimum) / std::max(count, 1);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  // Whole multiples of the step, so that no error adds up.
  for (double k = std::ceil(minimum / step); k * step <= maximum; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

std::string TickText(double value, double step) {
  const int digits = std::clamp(
      static_cast<int>(std::ceil(-std::log10(std::abs(step)) - 1e-9)), 0, 9);
  // Rounding may leave a negative zero.
  if (std::abs(value) < step * 1e-6) value = 0;
  return fmt::format("{:.{}f}", value, digits);
}

}  // namespace terrane::client
