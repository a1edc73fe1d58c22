// Blending functions of tensor-product splines, on the parameter interval [0,
// 1].
//
// Shared by control nets of macro shapes and by fractal surfaces. At any t only
// degree + 1 neighbouring functions are not 0, none is negative and they sum to
// 1. A Basis is a small value without allocations; safe from any thread.
// Determinism: IEEE operations only.
//
// Sources: Bernstein polynomials by de Casteljau's triangle, B-splines by the
// Cox-de Boor recurrence over integer knots (Piegl & Tiller, The NURBS Book,
// algorithms A1.3 and A2.2).
#ifndef TERRANE_CORE_SPLINE_BASIS_H_
#define TERRANE_CORE_SPLINE_BASIS_H_

#include <span>

namespace terrane::core {

class Basis {
 public:
  // Most control points along an axis, and with it the most values at one t.
  static constexpr int kMaxCount = 64;
  static constexpr int kMaxBSplineDegree = 5;

  // Bernstein polynomials of degree count - 1; 1 <= count <= kMaxCount.
  static Basis Bernstein(int count);
  // B-spline over equally spaced knots; does not reach the outer control
  // points. 0 <= degree <= kMaxBSplineDegree, degree < count <= kMaxCount.
  static Basis UniformBSpline(int count, int degree);
  // B-spline whose end knots are repeated: meets the outer control points.
  static Basis ClampedBSpline(int count, int degree);

  // Control points.
  int count() const { return count_; }
  // Non-zero functions at any t: degree + 1.
  int support() const { return degree_ + 1; }

  // Writes the values of functions first .. first + support() - 1 at t, cut to
  // [0, 1], into `values` (at least support() of them); returns first.
  int Values(double t, std::span<double> values) const;

 private:
  enum class Kind { kBernstein, kUniform, kClamped };

  Basis(Kind kind, int count, int degree)
      : kind_(kind), count_(count), degree_(degree) {}

  void BernsteinValues(double t, std::span<double> values) const;
  // Functions of the knot span [span, span + 1), at `position` inside it.
  void BSplineValues(double position, int span, std::span<double> values) const;
  // Knot `index` - degree of the knot vector, in spans.
  double Knot(int index) const;

  Kind kind_;
  int count_;
  int degree_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_SPLINE_BASIS_H_
