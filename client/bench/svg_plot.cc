#include "client/bench/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrane::client {
namespace {

constexpr double kWidth = 640;
constexpr double kHeight = 280;
constexpr double kLeft = 64;
constexpr double kRight = 26;
constexpr double kTop = 10;
constexpr double kBottom = 44;
constexpr int kTicks = 5;

// An axis that knows its range: values to pixels.
class Scale {
 public:
  Scale(const PlotAxis& axis, std::pair<double, double> range, double from,
        double to)
      : logarithmic_(axis.logarithmic), range_(range), from_(from), to_(to) {}

  bool Shows(double value) const {
    return std::isfinite(value) && (!logarithmic_ || value > 0);
  }
  double operator()(double value) const {
    const double low = Position(range_.first);
    const double share =
        (Position(value) - low) / (Position(range_.second) - low);
    return from_ + std::clamp(share, 0.0, 1.0) * (to_ - from_);
  }

 private:
  double Position(double value) const {
    return logarithmic_ ? std::log10(value) : value;
  }

  bool logarithmic_;
  std::pair<double, double> range_;
  double from_;
  double to_;
};

// 1, 2 or 5 times a power of ten, so that `range` takes about kTicks steps.
double RoundStep(double range) {
  const double raw = range / kTicks;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) return factor * power;
  }
  return 10 * power;
}

std::pair<double, double> RangeOf(const Plot& plot, const PlotAxis& axis,
                                  double std::pair<double, double>::*member) {
  if (axis.range.has_value()) return *axis.range;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotSeries& series : plot.series) {
    for (const auto& point : series.points) {
      const double value = point.*member;
      if (!std::isfinite(value) || (axis.logarithmic && value <= 0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) return {axis.logarithmic ? 1.0 : 0.0, 10.0};
  if (axis.logarithmic) {
    low = std::pow(10.0, std::floor(std::log10(low)));
    high = std::pow(10.0, std::ceil(std::log10(high)));
    return {low, high > low ? high : 10 * low};
  }
  if (high <= 0) return {0.0, 1.0};
  const double step = RoundStep(high);
  return {0.0, step * std::ceil(high / step)};
}

std::vector<std::pair<double, std::string>> TicksOf(
    const PlotAxis& axis, std::pair<double, double> range) {
  if (!axis.ticks.empty()) return axis.ticks;
  const auto text = [&](double value) {
    return axis.text ? axis.text(value) : fmt::format("{:.4g}", value);
  };
  std::vector<std::pair<double, std::string>> ticks;
  if (axis.logarithmic) {
    double value = range.first;
    while (value <= range.second * 1.001) {
      ticks.emplace_back(value, text(value));
      value *= 10;
    }
    return ticks;
  }
  const double step = RoundStep(range.second - range.first);
  const auto steps =
      static_cast<int>(std::floor((range.second - range.first) / step + 1e-9));
  for (int i = 0; i <= steps; ++i) {
    const double value = range.first + i * step;
    ticks.emplace_back(value, text(value));
  }
  return ticks;
}

std::string GridSvg(const Plot& plot, const Scale& x, const Scale& y,
                    std::pair<double, double> x_range,
                    std::pair<double, double> y_range) {
  const double bottom = kHeight - kBottom;
  std::string svg;
  for (const auto& [value, text] : TicksOf(plot.y, y_range)) {
    svg += fmt::format(
        R"(<line class="grid" x1="{0}" x2="{1}" y1="{2:.1f}" y2="{2:.1f}"/>)"
        R"(<text class="tick" x="{3}" y="{4:.1f}" text-anchor="end">{5}</text>)",
        kLeft, kWidth - kRight, y(value), kLeft - 8, y(value) + 4,
        EscapeHtml(text));
  }
  for (const auto& [value, text] : TicksOf(plot.x, x_range)) {
    svg += fmt::format(
        R"(<line class="axis" x1="{0:.1f}" x2="{0:.1f}" y1="{1}" y2="{2}"/>)"
        R"(<text class="tick" x="{0:.1f}" y="{3}" text-anchor="middle">{4}</text>)",
        x(value), bottom, bottom + 4, bottom + 17, EscapeHtml(text));
  }
  svg += fmt::format(
      R"(<line class="axis" x1="{0}" x2="{1}" y1="{2}" y2="{2}"/>)"
      R"(<text class="label" x="{3}" y="{4}" text-anchor="middle">{5}</text>)"
      R"svg(<text class="label" text-anchor="middle")svg"
      R"svg( transform="rotate(-90) translate(-{6} 13)">{7}</text>)svg",
      kLeft, kWidth - kRight, bottom, (kLeft + kWidth - kRight) / 2,
      kHeight - 8, EscapeHtml(plot.x.label), (kTop + bottom) / 2,
      EscapeHtml(plot.y.label));
  return svg;
}

// The n of its class s<n>.
int ClassOf(const PlotSeries& series) { return static_cast<int>(series.color); }

// One run of points without a break.
std::string StretchSvg(const PlotSeries& series,
                       const std::vector<std::pair<double, double>>& pixels) {
  if (pixels.empty()) return "";
  std::string path;
  for (const auto& [x, y] : pixels) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
  }
  std::string svg;
  if (series.filled) {
    svg +=
        fmt::format(R"(<path class="s{} fill" d="{}L{:.1f} {}L{:.1f} {}Z"/>)",
                    ClassOf(series), path, pixels.back().first,
                    kHeight - kBottom, pixels.front().first, kHeight - kBottom);
  }
  svg += fmt::format(R"(<path class="s{} line{}" d="{}"/>)", ClassOf(series),
                     series.dashed ? " dashed" : "", path);
  if (series.has_dots || pixels.size() == 1) {
    for (const auto& [x, y] : pixels) {
      svg += fmt::format(
          R"(<circle class="s{} dot" cx="{:.1f}" cy="{:.1f}" r="3.5"/>)",
          ClassOf(series), x, y);
    }
  }
  return svg;
}

std::string SeriesSvg(const PlotSeries& series, const Scale& x,
                      const Scale& y) {
  std::string svg;
  std::vector<std::pair<double, double>> pixels;
  for (const auto& [at, value] : series.points) {
    if (x.Shows(at) && y.Shows(value)) {
      pixels.emplace_back(x(at), y(value));
    } else {
      svg += StretchSvg(series, pixels);
      pixels.clear();
    }
  }
  return svg + StretchSvg(series, pixels);
}

std::string LegendHtml(const Plot& plot) {
  std::string html = "<span class=\"legend\">";
  for (const PlotSeries& series : plot.series) {
    html +=
        fmt::format(R"(<span><i class="s{}{}"></i>{}</span>)", ClassOf(series),
                    series.dashed ? " dashed" : "", EscapeHtml(series.name));
  }
  return html + "</span>";
}

}  // namespace

std::string PlotHtml(const Plot& plot) {
  const auto x_range = RangeOf(plot, plot.x, &std::pair<double, double>::first);
  const auto y_range =
      RangeOf(plot, plot.y, &std::pair<double, double>::second);
  const Scale x(plot.x, x_range, kLeft, kWidth - kRight);
  const Scale y(plot.y, y_range, kHeight - kBottom, kTop);
  std::string html = fmt::format(
      "<figure><figcaption><b>{}</b>{}</figcaption>"
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
      EscapeHtml(plot.title), LegendHtml(plot), kWidth, kHeight,
      EscapeHtml(plot.title));
  html += GridSvg(plot, x, y, x_range, y_range);
  for (const PlotSeries& series : plot.series) html += SeriesSvg(series, x, y);
  return html + "</svg></figure>\n";
}

std::string EscapeHtml(const std::string& text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

}  // namespace terrane::client
