// Blending functions of tensor-product splines, on the parameter interval [0,
// 1].
//
// Shared by control nets of macro shapes and by fractal surfaces. At any t only
// support() neighbouring functions are not 0, and they sum to 1; none is
// negative but the cubic Hermite's. A Basis is a small value without
// allocations; safe from any thread. Determinism: IEEE operations only.
//
// Sources: Bernstein polynomials by de Casteljau's triangle, B-splines by the
// Cox-de Boor recurrence over integer knots (Piegl & Tiller, The NURBS Book,
// algorithms A1.3 and A2.2).
#ifndef TERRANE_CORE_SPLINE_BASIS_H_
#define TERRANE_CORE_SPLINE_BASIS_H_

#include <span>

namespace terrane::core {

// The kinds of control nets.
enum class SplineBasis {
  kBezier,
  kBSplineUniform,
  kBSplineClamped,
  kBilinear,
  kBicubicHermite
};

// Whether a net of that kind has a degree to choose.
constexpr bool HasDegree(SplineBasis basis) {
  return basis == SplineBasis::kBSplineUniform ||
         basis == SplineBasis::kBSplineClamped;
}

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

  // Piecewise cubic Hermite curve through every control point. Its tangents are
  // taken from the points: half the step between the neighbours, at the two
  // ends the step to the one neighbour. 2 <= count <= kMaxCount.
  static Basis CubicHermite(int count);
  // One axis of a net of kind `basis`; `degree` is read where HasDegree(basis).
  static Basis Of(SplineBasis basis, int count, int degree);

  // Control points.
  int count() const { return count_; }
  // Functions that may differ from 0 at any one t: degree + 1, or all of a
  // Hermite curve with fewer points than that.
  int support() const;
  // The largest sum over t of the functions' squares, which is 1 where some
  // control point is met.
  double LargestSquaredSum() const;
  // The largest sum over t of the functions' sizes: how far a curve may leave
  // the range of its control values, 1 when it never does.
  double LargestAbsoluteSum() const;

  // Writes the values of functions first .. first + support() - 1 at t, cut to
  // [0, 1], into `values` (at least support() of them); returns first.
  int Values(double t, std::span<double> values) const;

 private:
  enum class Kind { kBernstein, kUniform, kClamped, kHermite };

  Basis(Kind kind, int count, int degree)
      : kind_(kind), count_(count), degree_(degree) {}

  void BernsteinValues(double t, std::span<double> values) const;
  // Functions of the cell between control points `cell` and cell + 1, at t in
  // [0, 1] of it, first of the support being control point `first`.
  void HermiteValues(double t, int cell, int first,
                     std::span<double> values) const;
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
