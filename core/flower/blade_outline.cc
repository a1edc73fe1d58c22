#include "core/flower/blade_outline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/field_checks.h"

namespace terrane::core {
namespace {

constexpr double kTension = 0.5;
// Slopes and widths this far below 0 are rounding.
constexpr double kRounding = 1e-12;
constexpr int kPlaces = 64;

// Base, points and tip, between the end phantoms.
std::vector<SketchPoint> WithPhantoms(const Sketch& sketch) {
  const SketchPoint base = {0, 0};
  const SketchPoint tip = {0, 1};
  const SketchPoint first = sketch.points.front();
  const SketchPoint last = sketch.points.back();
  std::vector<SketchPoint> points;
  points.reserve(sketch.points.size() + 4);
  points.push_back(
      sketch.base == SketchEnd::kRound ? SketchPoint{-first.x, first.y} : base);
  points.push_back(base);
  for (const SketchPoint& point : sketch.points) points.push_back(point);
  points.push_back(tip);
  points.push_back(
      sketch.tip == SketchEnd::kRound ? SketchPoint{-last.x, last.y} : tip);
  return points;
}

}  // namespace

double BladeOutline::Cubic::LeastSlope() const {
  const auto slope = [this](double t) { return b + (2 * c + 3 * d * t) * t; };
  double least = std::min(slope(0), slope(1));
  const double vertex = d != 0 ? -c / (3 * d) : 0;
  if (vertex > 0 && vertex < 1) least = std::min(least, slope(vertex));
  return least;
}

double BladeOutline::Cubic::LeastInside() const {
  double least = At(0.5);
  const double square = c * c - 3 * b * d;
  if (square < 0) return least;
  // Both roots of the slope, in the form that does not divide by a small d.
  const double sum = -(c + std::copysign(std::sqrt(square), c));
  for (const double root : {b / sum, sum / (3 * d)}) {
    if (root > 0 && root < 1) least = std::min(least, At(root));
  }
  return least;
}

BladeOutline::Cubic BladeOutline::Through(double p0, double p1, double p2,
                                          double p3) {
  constexpr double kT = kTension;
  return {p1, kT * (p2 - p0),
          2 * kT * p0 + (kT - 3) * p1 + (3 - 2 * kT) * p2 - kT * p3,
          -kT * p0 + (2 - kT) * p1 + (kT - 2) * p2 + kT * p3};
}

BladeOutline::BladeOutline(const Sketch& sketch) {
  const std::vector<SketchPoint> points = WithPhantoms(sketch);
  for (std::size_t i = 0; i + 3 < points.size(); ++i) {
    const SketchPoint* p = points.data() + i;
    span_[i] = {Through(p[0].x, p[1].x, p[2].x, p[3].x),
                Through(p[0].y, p[1].y, p[2].y, p[3].y)};
    ++spans_;
  }
  for (int i = 0; i <= kPlaces; ++i) {
    widest_ = std::max(widest_, At(i * (spans_ / double{kPlaces})).x);
  }
  for (int i = 0; i <= kPlaces; ++i) {
    const SketchPoint p = At(i * (spans_ / double{kPlaces}));
    const double x = p.x / widest_;
    farthest_ = std::max(farthest_, x * x + p.y * p.y);
  }
}

SketchPoint BladeOutline::At(double t) const {
  const double first = std::clamp(std::floor(t), 0.0, spans_ - 1.0);
  const Span& span = span_[static_cast<std::size_t>(first)];
  return {span.x.At(t - first), span.y.At(t - first)};
}

std::string BladeOutline::Fault() const {
  for (int i = 0; i < spans_; ++i) {
    const Span& span = span_[static_cast<std::size_t>(i)];
    const std::string place = " between its points " + std::to_string(i) +
                              " and " + std::to_string(i + 1) +
                              " of 0 (base) to " + std::to_string(spans_) +
                              " (tip)";
    const double slope = span.y.LeastSlope();
    if (slope < -kRounding) {
      return "must not fold back" + place + ", got a slope of y of " +
             NumberText(slope);
    }
    const double width = span.x.LeastInside();
    if (width < kRounding) {
      return "must not cross the axis" + place + ", got a half width of " +
             NumberText(width);
    }
  }
  return "";
}

}  // namespace terrane::core
