#include "core/spline/basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace terrane::core {

Basis Basis::Bernstein(int count) {
  return Basis(Kind::kBernstein, count, count - 1);
}

Basis Basis::UniformBSpline(int count, int degree) {
  return Basis(Kind::kUniform, count, degree);
}

Basis Basis::ClampedBSpline(int count, int degree) {
  return Basis(Kind::kClamped, count, degree);
}

Basis Basis::CubicHermite(int count) { return Basis(Kind::kHermite, count, 3); }

Basis Basis::Of(SplineBasis basis, int count, int degree) {
  switch (basis) {
    case SplineBasis::kBezier:
      return Bernstein(count);
    case SplineBasis::kBSplineUniform:
      return UniformBSpline(count, degree);
    case SplineBasis::kBSplineClamped:
      return ClampedBSpline(count, degree);
    case SplineBasis::kBilinear:
      return ClampedBSpline(count, 1);
    case SplineBasis::kBicubicHermite:
      break;
  }
  return CubicHermite(count);
}

int Basis::support() const { return std::min(degree_ + 1, count_); }

double Basis::LargestSquaredSum() const {
  if (kind_ != Kind::kUniform) return 1.0;
  // All spans are alike and symmetric, and the sum is largest at a knot (odd
  // degrees) or midway between two (even degrees).
  const double middle = 0.5 / (count_ - degree_);
  double largest = 0;
  for (const double t : {0.0, middle}) {
    std::array<double, kMaxBSplineDegree + 1> values;
    Values(t, values);
    double sum = 0;
    for (int k = 0; k < support(); ++k) {
      const double value = values[static_cast<std::size_t>(k)];
      sum += value * value;
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

double Basis::LargestAbsoluteSum() const {
  // (-1, 9, 9, -1) / 16 in the middle of an inner cell.
  return kind_ == Kind::kHermite && count_ > 2 ? 1.25 : 1.0;
}

int Basis::Values(double t, std::span<double> values) const {
  const double cut = std::clamp(t, 0.0, 1.0);
  if (kind_ == Kind::kBernstein) {
    BernsteinValues(cut, values);
    return 0;
  }
  if (kind_ == Kind::kHermite) {
    const double position = cut * (count_ - 1);
    const int cell =
        std::min(static_cast<int>(std::floor(position)), count_ - 2);
    const int first = std::clamp(cell - 1, 0, count_ - support());
    HermiteValues(position - cell, cell, first, values);
    return first;
  }
  const int spans = count_ - degree_;
  const double position = cut * spans;
  // t = 1 belongs to the last span.
  const int span = std::min(static_cast<int>(std::floor(position)), spans - 1);
  BSplineValues(position, span, values);
  return span;
}

void Basis::BernsteinValues(double t, std::span<double> values) const {
  values[0] = 1.0;
  for (std::size_t j = 1; j <= static_cast<std::size_t>(degree_); ++j) {
    double saved = 0.0;
    for (std::size_t k = 0; k < j; ++k) {
      const double lower = values[k];
      values[k] = saved + (1.0 - t) * lower;
      saved = t * lower;
    }
    values[j] = saved;
  }
}

void Basis::HermiteValues(double t, int cell, int first,
                          std::span<double> values) const {
  const double s = 1.0 - t;
  std::fill_n(values.begin(), support(), 0.0);
  const auto at = [&](int point) -> double& {
    return values[static_cast<std::size_t>(point - first)];
  };
  at(cell) += s * s * (1.0 + 2.0 * t);
  at(cell + 1) += t * t * (1.0 + 2.0 * s);
  // The tangent at `point` is a step between neighbours, shared out to them.
  const auto add_tangent = [&](int point, double value) {
    const int before = std::max(point - 1, 0);
    const int after = std::min(point + 1, count_ - 1);
    const double share = value / (after - before);
    at(after) += share;
    at(before) -= share;
  };
  add_tangent(cell, t * s * s);
  add_tangent(cell + 1, -t * t * s);
}

void Basis::BSplineValues(double position, int span,
                          std::span<double> values) const {
  std::array<double, kMaxBSplineDegree + 1> left;
  std::array<double, kMaxBSplineDegree + 1> right;
  values[0] = 1.0;
  for (int j = 1; j <= degree_; ++j) {
    const std::size_t top = static_cast<std::size_t>(j);
    left[top] = position - Knot(span + 1 - j);
    right[top] = Knot(span + j) - position;
    double saved = 0.0;
    for (std::size_t r = 0; r < top; ++r) {
      const double share = values[r] / (right[r + 1] + left[top - r]);
      values[r] = saved + right[r + 1] * share;
      saved = left[top - r] * share;
    }
    values[top] = saved;
  }
}

double Basis::Knot(int index) const {
  return kind_ == Kind::kUniform ? index
                                 : std::clamp(index, 0, count_ - degree_);
}

}  // namespace terrane::core
