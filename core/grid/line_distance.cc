#include "core/grid/line_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/distance_kernels.h"

namespace terrane::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Below this many candidates or samples, splitting costs more than it saves.
constexpr std::size_t kFewSegments = 4;
constexpr std::size_t kFewSamples = 16;

// A segment is left out only when it is farther than another by more than what
// rounding can have made of either distance: relative to the distance, and to
// the size of the geometry.
constexpr double kRelativeSlack = 1e-9;
constexpr double kAbsoluteSlack = 1e-12;

Box BoxOfVertices(std::span<const LineDistance::Vertex> vertices) {
  Box box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (const LineDistance::Vertex& vertex : vertices) {
    box.min_x = std::min(box.min_x, vertex.x);
    box.min_y = std::min(box.min_y, vertex.y);
    box.max_x = std::max(box.max_x, vertex.x);
    box.max_y = std::max(box.max_y, vertex.y);
  }
  return box;
}

}  // namespace

LineDistance::LineDistance(std::span<const Vertex> vertices, Form form,
                           Norm norm, int dimensions)
    : norm_(norm),
      form_(form),
      ignores_y_(dimensions == 1),
      box_(BoxOfVertices(vertices)) {
  extent_ = std::max(box_.max_x - box_.min_x, box_.max_y - box_.min_y);
  if (ignores_y_) {
    // The interval on the x axis; inside it the distance is 0 already.
    form_ = Form::kPolyline;
    segments_ = {MakeSegment({box_.min_x, 0}, {box_.max_x, 0})};
    box_.min_y = -kInfinity;
    box_.max_y = kInfinity;
    return;
  }
  const std::size_t count = vertices.size();
  const std::size_t segments =
      form == Form::kPolygon ? count : std::max<std::size_t>(count - 1, 1);
  segments_.reserve(segments);
  for (std::size_t i = 0; i < segments; ++i) {
    segments_.push_back(MakeSegment(vertices[i], vertices[(i + 1) % count]));
  }
}

LineDistance::Segment LineDistance::MakeSegment(const Vertex& a,
                                                const Vertex& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  return {a.x,
          a.y,
          dx,
          dy,
          b.y,
          square > 0 ? 1.0 / square : 0.0,
          {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x),
           std::max(a.y, b.y)}};
}

void LineDistance::Squared(const SampleGrid& grid, const SampleRect& rect,
                           double reach, double* out) const {
  if (rect.empty()) return;
  std::fill_n(out, rect.columns() * rect.rows(), kInfinity);
  const Target target{grid, rect, reach * reach, out};
  if (segments_.size() <= kFewSegments) {
    FillPlainly(target, rect, segments_);
  } else {
    Fill(target, rect, segments_);
  }
  if (form_ == Form::kPolygon) ZeroInside(target);
}

Box LineDistance::SampleBox(const Target& target,
                            const SampleRect& rect) const {
  Box box = BoxOf(target.grid, rect);
  if (ignores_y_) box.min_y = box.max_y = 0;
  return box;
}

template <LineDistance::Norm kNorm>
double LineDistance::SquaredTo(const Segment& segment, double x, double y) {
  const double ex = x - segment.x;
  const double ey = y - segment.y;
  if constexpr (kNorm == Norm::kL2) {
    const double t = std::clamp(
        (ex * segment.dx + ey * segment.dy) * segment.inverse_square, 0.0, 1.0);
    const double fx = ex - t * segment.dx;
    const double fy = ey - t * segment.dy;
    return fx * fx + fy * fy;
  }
  // |fx| + |fy| is convex and piecewise linear in t: its minimum is at an end
  // or where a component is 0.
  const auto at = [&](double t) {
    return std::fabs(ex - t * segment.dx) + std::fabs(ey - t * segment.dy);
  };
  double least = std::min(at(0.0), at(1.0));
  if (segment.dx != 0) {
    least = std::min(least, at(std::clamp(ex / segment.dx, 0.0, 1.0)));
  }
  if (segment.dy != 0) {
    least = std::min(least, at(std::clamp(ey / segment.dy, 0.0, 1.0)));
  }
  return least * least;
}

template <LineDistance::Norm kNorm>
void LineDistance::LowerRow(const Segment& segment, std::span<const double> x,
                            double y, double* row) {
  if (segment.inverse_square != 0) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      row[i] = std::min(row[i], SquaredTo<kNorm>(segment, x[i], y));
    }
    return;
  }
  // A point: the most frequent source of all.
  const double gap = std::fabs(y - segment.y);
  if constexpr (kNorm == Norm::kL2) {
    LowerToPointL2(x.data(), x.size(), segment.x, gap, row);
  } else {
    LowerToPointL1(x.data(), x.size(), segment.x, gap, row);
  }
}

double LineDistance::SquaredGap(const Box& segment, const Box& samples) const {
  const double x = std::max(
      {0.0, segment.min_x - samples.max_x, samples.min_x - segment.max_x});
  const double y = std::max(
      {0.0, segment.min_y - samples.max_y, samples.min_y - segment.max_y});
  return norm_ == Norm::kL2 ? x * x + y * y : (x + y) * (x + y);
}

double LineDistance::SquaredFarthest(const Segment& segment,
                                     const Box& samples) const {
  const double x = std::max(std::fabs(samples.min_x - segment.x),
                            std::fabs(samples.max_x - segment.x));
  const double y = std::max(std::fabs(samples.min_y - segment.y),
                            std::fabs(samples.max_y - segment.y));
  return norm_ == Norm::kL2 ? x * x + y * y : (x + y) * (x + y);
}

std::vector<LineDistance::Segment> LineDistance::Nearest(
    const Box& samples, double reach_squared,
    std::span<const Segment> candidates) const {
  double least = reach_squared;
  for (const Segment& segment : candidates) {
    least = std::min(least, SquaredFarthest(segment, samples));
  }
  const double limit =
      std::sqrt(least) * (1.0 + kRelativeSlack) + kAbsoluteSlack * extent_;
  std::vector<Segment> nearest;
  for (const Segment& segment : candidates) {
    if (SquaredGap(segment.box, samples) <= limit * limit) {
      nearest.push_back(segment);
    }
  }
  return nearest;
}

void LineDistance::Fill(const Target& target, const SampleRect& rect,
                        std::span<const Segment> candidates) const {
  const std::vector<Segment> nearest =
      Nearest(SampleBox(target, rect), target.reach_squared, candidates);
  if (nearest.empty()) return;
  if (nearest.size() <= kFewSegments ||
      rect.columns() * rect.rows() <= kFewSamples) {
    FillPlainly(target, rect, nearest);
    return;
  }
  SampleRect first = rect;
  SampleRect second = rect;
  if (rect.columns() >= rect.rows()) {
    first.column_end = second.column_begin =
        rect.column_begin + rect.columns() / 2;
  } else {
    first.row_end = second.row_begin = rect.row_begin + rect.rows() / 2;
  }
  Fill(target, first, nearest);
  Fill(target, second, nearest);
}

void LineDistance::FillPlainly(const Target& target, const SampleRect& rect,
                               std::span<const Segment> candidates) const {
  const std::span<const double> x =
      std::span(target.grid.x).subspan(rect.column_begin, rect.columns());
  for (std::size_t j = rect.row_begin; j < rect.row_end; ++j) {
    const double y = ignores_y_ ? 0.0 : target.grid.y[j];
    double* row = target.out +
                  (j - target.whole.row_begin) * target.whole.columns() +
                  (rect.column_begin - target.whole.column_begin);
    for (const Segment& segment : candidates) {
      if (norm_ == Norm::kL2) {
        LowerRow<Norm::kL2>(segment, x, y, row);
      } else {
        LowerRow<Norm::kL1>(segment, x, y, row);
      }
    }
    CutAbove(target.reach_squared, rect.columns(), row);
  }
}

void LineDistance::ZeroInside(const Target& target) const {
  const Box box = SampleBox(target, target.whole);
  std::vector<const Segment*> edges;
  for (const Segment& segment : segments_) {
    if (segment.box.min_y <= box.max_y && segment.box.max_y >= box.min_y) {
      edges.push_back(&segment);
    }
  }
  std::vector<double> crossings;
  for (std::size_t j = target.whole.row_begin; j < target.whole.row_end; ++j) {
    const double y = target.grid.y[j];
    crossings.clear();
    for (const Segment* edge : edges) {
      if ((edge->y <= y) == (edge->end_y <= y)) continue;
      crossings.push_back(edge->x + (y - edge->y) / edge->dy * edge->dx);
    }
    if (crossings.empty()) continue;
    std::sort(crossings.begin(), crossings.end());
    double* row =
        target.out + (j - target.whole.row_begin) * target.whole.columns();
    for (std::size_t i = 0; i < target.whole.columns(); ++i) {
      const double x = target.grid.x[target.whole.column_begin + i];
      const auto beyond =
          crossings.end() -
          std::upper_bound(crossings.begin(), crossings.end(), x);
      if (beyond % 2 == 1) row[i] = 0;
    }
  }
}

}  // namespace terrane::core
