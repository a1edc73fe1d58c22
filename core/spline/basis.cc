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

int Basis::Values(double t, std::span<double> values) const {
  const double cut = std::clamp(t, 0.0, 1.0);
  if (kind_ == Kind::kBernstein) {
    BernsteinValues(cut, values);
    return 0;
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
