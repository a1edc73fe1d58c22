#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/spline/basis.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

constexpr double kTolerance = 1e-12;

// The curve with these control values at t, through the basis.
double Curve(const Basis& basis, const std::vector<double>& control, double t) {
  std::array<double, Basis::kMaxCount> values;
  const int first = basis.Values(t, values);
  double sum = 0;
  for (int k = 0; k < basis.support(); ++k) {
    sum += values[static_cast<std::size_t>(k)] *
           control[static_cast<std::size_t>(first + k)];
  }
  return sum;
}

std::vector<double> Controls(int count) {
  std::vector<double> control;
  for (int i = 0; i < count; ++i) {
    control.push_back(std::sin(3.7 * i) * 5 + i % 3);
  }
  return control;
}

// Repeated linear interpolation of the control points.
double DeCasteljau(std::vector<double> control, double t) {
  for (std::size_t n = control.size() - 1; n > 0; --n) {
    for (std::size_t i = 0; i < n; ++i) {
      control[i] = (1 - t) * control[i] + t * control[i + 1];
    }
  }
  return control[0];
}

// De Boor's algorithm on an explicit knot vector.
double DeBoor(const std::vector<double>& control, int degree,
              const std::vector<double>& knots, double t) {
  int k = degree;
  const int count = static_cast<int>(control.size());
  while (k < count - 1 && t >= knots[static_cast<std::size_t>(k + 1)]) ++k;
  std::vector<double> d;
  for (int j = 0; j <= degree; ++j) {
    d.push_back(control[static_cast<std::size_t>(j + k - degree)]);
  }
  for (int r = 1; r <= degree; ++r) {
    for (int j = degree; j >= r; --j) {
      const double low = knots[static_cast<std::size_t>(j + k - degree)];
      const double high = knots[static_cast<std::size_t>(j + 1 + k - r)];
      const double alpha = (t - low) / (high - low);
      const std::size_t at = static_cast<std::size_t>(j);
      d[at] = (1 - alpha) * d[at - 1] + alpha * d[at];
    }
  }
  return d[static_cast<std::size_t>(degree)];
}

std::vector<double> Knots(int count, int degree, bool clamped) {
  std::vector<double> knots;
  const double spans = count - degree;
  for (int i = 0; i <= count + degree; ++i) {
    double knot = (i - degree) / spans;
    if (clamped) knot = std::min(1.0, std::max(0.0, knot));
    knots.push_back(knot);
  }
  return knots;
}

std::vector<Basis> AllBases() {
  std::vector<Basis> bases;
  for (const int count : {1, 2, 3, 7, 64}) {
    bases.push_back(Basis::Bernstein(count));
  }
  for (int degree = 1; degree <= 5; ++degree) {
    for (const int count : {degree + 1, degree + 2, 20, 64}) {
      bases.push_back(Basis::UniformBSpline(count, degree));
      bases.push_back(Basis::ClampedBSpline(count, degree));
    }
  }
  return bases;
}

TEST(SplineBasisTest, ValuesSumToOneAndAreNotNegative) {
  for (const Basis& basis : AllBases()) {
    for (int step = 0; step <= 100; ++step) {
      std::array<double, Basis::kMaxCount> values;
      const int first = basis.Values(step / 100.0, values);
      EXPECT_GE(first, 0);
      EXPECT_LE(first + basis.support(), basis.count());
      double sum = 0;
      for (int k = 0; k < basis.support(); ++k) {
        EXPECT_GE(values[static_cast<std::size_t>(k)], 0.0);
        sum += values[static_cast<std::size_t>(k)];
      }
      EXPECT_NEAR(sum, 1.0, kTolerance);
    }
  }
}

TEST(SplineBasisTest, BernsteinAgreesWithDeCasteljau) {
  for (const int count : {2, 3, 4, 9, 32, 64}) {
    const std::vector<double> control = Controls(count);
    for (int step = 0; step <= 200; ++step) {
      const double t = step / 200.0;
      EXPECT_NEAR(Curve(Basis::Bernstein(count), control, t),
                  DeCasteljau(control, t), kTolerance);
    }
  }
}

TEST(SplineBasisTest, BSplinesAgreeWithDeBoor) {
  for (int degree = 1; degree <= 5; ++degree) {
    for (const int count : {degree + 1, degree + 3, 64}) {
      const std::vector<double> control = Controls(count);
      for (int step = 0; step <= 200; ++step) {
        const double t = step / 200.0;
        EXPECT_NEAR(Curve(Basis::UniformBSpline(count, degree), control, t),
                    DeBoor(control, degree, Knots(count, degree, false), t),
                    kTolerance);
        EXPECT_NEAR(Curve(Basis::ClampedBSpline(count, degree), control, t),
                    DeBoor(control, degree, Knots(count, degree, true), t),
                    kTolerance);
      }
    }
  }
}

TEST(SplineBasisTest, ClampedAndBernsteinMeetTheEndPointsExactly) {
  const std::vector<double> control = Controls(9);
  for (int degree = 1; degree <= 5; ++degree) {
    const Basis basis = Basis::ClampedBSpline(9, degree);
    EXPECT_EQ(Curve(basis, control, 0), control.front());
    EXPECT_EQ(Curve(basis, control, 1), control.back());
  }
  EXPECT_EQ(Curve(Basis::Bernstein(9), control, 0), control.front());
  EXPECT_EQ(Curve(Basis::Bernstein(9), control, 1), control.back());
}

TEST(SplineBasisTest, DegreeOneIsAPolyline) {
  const Basis basis = Basis::ClampedBSpline(3, 1);
  EXPECT_DOUBLE_EQ(Curve(basis, {2, 6, 4}, 0.25), 4);
  EXPECT_DOUBLE_EQ(Curve(basis, {2, 6, 4}, 0.75), 5);
}

TEST(SplineBasisTest, HermiteMeetsEveryPointAndItsFunctionsSumToOne) {
  for (const int count : {2, 3, 4, 9, 64}) {
    const Basis basis = Basis::CubicHermite(count);
    const std::vector<double> control = Controls(count);
    const std::vector<double> ones(control.size(), 1.0);
    for (int i = 0; i < count; ++i) {
      EXPECT_NEAR(Curve(basis, control, i / (count - 1.0)),
                  control[static_cast<std::size_t>(i)], kTolerance);
    }
    for (int step = 0; step <= 200; ++step) {
      EXPECT_NEAR(Curve(basis, ones, step / 200.0), 1, kTolerance);
    }
  }
}

// Its tangents are half the steps between neighbours, so it follows a parabola
// but in the two end cells, and a line everywhere.
TEST(SplineBasisTest, HermiteFollowsLinesAndParabolas) {
  std::vector<double> line;
  std::vector<double> parabola;
  for (int i = 0; i < 8; ++i) {
    line.push_back(3.0 * i - 1);
    parabola.push_back(1.0 * i * i);
  }
  const Basis basis = Basis::CubicHermite(8);
  for (int step = 0; step <= 700; ++step) {
    const double x = step / 100.0;
    EXPECT_NEAR(Curve(basis, line, x / 7), 3 * x - 1, 1e-11);
    if (x >= 1 && x <= 6) {
      EXPECT_NEAR(Curve(basis, parabola, x / 7), x * x, 1e-11);
    }
  }
  EXPECT_NEAR(Curve(Basis::CubicHermite(2), {2, 5}, 0.25), 2.75, kTolerance);
}

TEST(SplineBasisTest, LargestSumsAreReachedAndNeverPassed) {
  std::vector<Basis> bases = AllBases();
  for (const int count : {2, 3, 4, 9}) {
    bases.push_back(Basis::CubicHermite(count));
  }
  for (const Basis& basis : bases) {
    double squared = 0;
    double absolute = 0;
    // Steps that meet the knots and the middles between them.
    const int steps = 64 * basis.count() * (basis.count() - 1);
    for (int step = 0; step <= steps; ++step) {
      std::array<double, Basis::kMaxCount> values;
      basis.Values(static_cast<double>(step) / steps, values);
      double squares = 0;
      double sizes = 0;
      for (int k = 0; k < basis.support(); ++k) {
        const double value = values[static_cast<std::size_t>(k)];
        squares += value * value;
        sizes += std::fabs(value);
      }
      squared = std::max(squared, squares);
      absolute = std::max(absolute, sizes);
    }
    EXPECT_LE(squared, basis.LargestSquaredSum() + kTolerance);
    EXPECT_GE(squared, 0.999 * basis.LargestSquaredSum());
    EXPECT_LE(absolute, basis.LargestAbsoluteSum() + kTolerance);
  }
}

TEST(SplineBasisTest, EveryKindOfNetHasItsBasis) {
  const std::vector<double> control = Controls(7);
  const auto at = [&](SplineBasis kind) {
    return Curve(Basis::Of(kind, 7, 2), control, 0.3);
  };
  EXPECT_EQ(at(SplineBasis::kBezier), Curve(Basis::Bernstein(7), control, 0.3));
  EXPECT_EQ(at(SplineBasis::kBSplineUniform),
            Curve(Basis::UniformBSpline(7, 2), control, 0.3));
  EXPECT_EQ(at(SplineBasis::kBSplineClamped),
            Curve(Basis::ClampedBSpline(7, 2), control, 0.3));
  EXPECT_EQ(at(SplineBasis::kBilinear),
            Curve(Basis::ClampedBSpline(7, 1), control, 0.3));
  EXPECT_EQ(at(SplineBasis::kBicubicHermite),
            Curve(Basis::CubicHermite(7), control, 0.3));
}

TEST(SplineBasisTest, ParametersOutsideAreCut) {
  const std::vector<double> control = Controls(6);
  const Basis basis = Basis::ClampedBSpline(6, 3);
  EXPECT_EQ(Curve(basis, control, -3), control.front());
  EXPECT_EQ(Curve(basis, control, 7), control.back());
}

}  // namespace
}  // namespace terrane::core
