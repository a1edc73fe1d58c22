#include "core/flower/bezier_rows.h"

#include <algorithm>
#include <cstddef>

#include "core/spline/basis.h"

namespace terrane::core {
namespace {

// Where the normals of base and tip are taken: at the ends themselves the
// patch has no width.
constexpr double kInside = 1e-3;

Vector ToVector(Float3 a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y),
          static_cast<double>(a.z)};
}

// The control points of the cubic that meets four points at 0, 1/3, 2/3, 1.
std::array<Vector, 4> Interpolating(const std::array<Vector, 4>& q) {
  constexpr double kSixth = 1.0 / 6;
  return {q[0], kSixth * (-5 * q[0] + 18 * q[1] + -9 * q[2] + 2 * q[3]),
          kSixth * (2 * q[0] + -9 * q[1] + 18 * q[2] + -5 * q[3]), q[3]};
}

// The Bernstein polynomials of degree 3 and their derivatives.
struct Weights {
  explicit Weights(double t) {
    std::array<double, 3> lower;
    Basis::Bernstein(4).Values(t, value);
    Basis::Bernstein(3).Values(t, lower);
    slope = {-3 * lower[0], 3 * (lower[0] - lower[1]),
             3 * (lower[1] - lower[2]), 3 * lower[2]};
  }
  std::array<double, 4> value;
  std::array<double, 4> slope;
};

Vector Blend(const std::array<Vector, 4>& points,
             const std::array<double, 4>& weights) {
  Vector sum;
  for (std::size_t i = 0; i < 4; ++i) sum = sum + weights[i] * points[i];
  return sum;
}

Vector CrossOf(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

BezierNet FitBezierNet(const BladeOutline& outline, BladeRows* petal) {
  BezierNet net;
  BladeRow row;
  for (std::size_t i = 0; i < 4; ++i) {
    petal->Make(outline.spans() * (static_cast<double>(i) / 3), 6, &row);
    std::array<Vector, 4> met;
    for (std::size_t j = 0; j < 4; ++j) {
      met[j] =
          ToVector(row.positions[std::min(2 * j, row.positions.size() - 1)]);
    }
    net[i] = Interpolating(met);
  }
  for (std::size_t j = 0; j < 4; ++j) {
    const auto column =
        Interpolating({net[0][j], net[1][j], net[2][j], net[3][j]});
    for (std::size_t i = 0; i < 4; ++i) net[i][j] = column[i];
  }
  return net;
}

BezierRows::BezierRows(const BladeOutline& outline, const BezierNet& net)
    : outline_(outline), net_(net) {}

void BezierRows::Make(double t, int columns, BladeRow* row) {
  const bool is_point = t <= 0 || t >= outline_.spans();
  const double along = t / outline_.spans();
  const SketchPoint edge = outline_.At(t);
  row->y = static_cast<float>(edge.y);
  row->half_width = is_point ? 0.0f : static_cast<float>(edge.x);
  const Weights here(along);
  const Weights inside(std::clamp(along, kInside, 1 - kInside));
  std::array<Vector, 4> points, points_inside, slopes;
  for (std::size_t j = 0; j < 4; ++j) {
    const std::array<Vector, 4> column = {net_[0][j], net_[1][j], net_[2][j],
                                          net_[3][j]};
    points[j] = Blend(column, here.value);
    points_inside[j] = Blend(column, inside.value);
    slopes[j] = Blend(column, inside.slope);
  }
  const int count = is_point ? 1 : columns + 1;
  row->positions.resize(static_cast<std::size_t>(count));
  row->normals.resize(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const Weights across(is_point ? 0.5 : static_cast<double>(k) / columns);
    const auto at = static_cast<std::size_t>(k);
    row->positions[at] = ToFloat3(Blend(points, across.value));
    row->normals[at] = ToFloat3(UnitOf(CrossOf(
        Blend(points_inside, across.slope), Blend(slopes, across.value))));
  }
}

}  // namespace terrane::core
