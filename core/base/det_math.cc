#include "core/base/det_math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace terrane::core {
namespace {

constexpr double kLn2 = 0x1.62e42fefa39efp-1;
constexpr double kLog2E = 0x1.71547652b82fep+0;
// ln 2 in two parts; the first has 32 bits, so its product with an exponent is
// exact.
constexpr double kLn2High = 0x1.62e42feep-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;

constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
// pi / 2 in three parts; the first two have 33 bits, so their products with a
// number of quarter turns are exact.
constexpr double kHalfPiHigh = 0x1.921fb544p+0;
constexpr double kHalfPiMiddle = 0x1.0b4611a6p-34;
constexpr double kHalfPiLow = 0x1.3198a2e037073p-69;
constexpr double kLargestAngle = 1e5;

// 2^whole e^r for r in [-0.35, 0.35]: Taylor to r^14 leaves less than 2^-60.
double ScaledExp(double r, double whole) {
  double sum = 1.0;
  for (int k = 14; k >= 1; --k) sum = 1.0 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(whole));
}

// log2 x = exponent + fraction, fraction in [-0.5, 0.5], for finite x > 0.
struct SplitLog2 {
  int exponent;
  double fraction;
};

SplitLog2 SplitLog2Of(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // [0.5, 1)
  if (m < 0x1.6a09e667f3bcdp-1) {       // sqrt(1/2)
    m *= 2;
    --exponent;
  }
  // ln m = 2 atanh(t), t = (m - 1) / (m + 1), |t| <= 0.1716: t^23 leaves less
  // than 2^-60.
  const double t = (m - 1.0) / (m + 1.0);
  const double t2 = t * t;
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * t2 + 1.0 / k;
  return {exponent, 2.0 * t * sum * kLog2E};
}

// The upper half of a double's digits.
double UpperHalf(double value) {
  constexpr std::uint64_t kMask = ~((std::uint64_t{1} << 27) - 1);
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) & kMask);
}

// Sine of r + quarters * pi / 2 for r in [-pi/4, pi/4]: Taylor to r^21 leaves
// less than 2^-70.
double SinOfQuarters(double r, std::int64_t quarters) {
  const double r2 = r * r;
  const bool is_cosine = (quarters & 1) != 0;
  double sum = 1.0;
  for (int k = is_cosine ? 20 : 21; k > 1; k -= 2) {
    sum = 1.0 - sum * r2 / (k * (k - 1));
  }
  if (!is_cosine) sum *= r;
  return (quarters & 2) != 0 ? -sum : sum;
}

// (-1)^k / n! for n = first, first + 2, ...: Taylor's coefficients.
constexpr std::array<double, 11> TaylorCoefficients(int first) {
  std::array<double, 11> coefficients{};
  double factor = 1;
  int n = first;
  for (double& coefficient : coefficients) {
    coefficient = factor;
    factor /= -(n + 1.0) * (n + 2.0);
    n += 2;
  }
  return coefficients;
}
constexpr std::array<double, 11> kSineTerms = TaylorCoefficients(1);
constexpr std::array<double, 11> kCosineTerms = TaylorCoefficients(0);

double Polynomial(const std::array<double, 11>& terms, double x) {
  double sum = terms.back();
  for (std::size_t k = terms.size() - 1; k > 0; --k) {
    sum = sum * x + terms[k - 1];
  }
  return sum;
}

// x less whole quarter turns, and how many.
struct Reduced {
  double rest;
  std::int64_t quarters;
};
Reduced Reduce(double x) {
  const double quarters = std::nearbyint(x * kTwoOverPi);
  return {((x - quarters * kHalfPiHigh) - quarters * kHalfPiMiddle) -
              quarters * kHalfPiLow,
          static_cast<std::int64_t>(quarters)};
}

// Sine of x plus `more` quarter turns.
double SinPlusQuarters(double x, std::int64_t more) {
  if (!(std::fabs(x) <= kLargestAngle)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Reduced reduced = Reduce(x);
  return SinOfQuarters(reduced.rest, reduced.quarters + more);
}

}  // namespace

double DetExp2(double x) {
  if (std::isnan(x)) return x;
  if (x >= 1024.0) return std::numeric_limits<double>::infinity();
  if (x < -1080.0) return 0.0;
  const double whole = std::nearbyint(x);
  return ScaledExp((x - whole) * kLn2, whole);
}

double DetLog2(double x) {
  if (std::isnan(x) || x < 0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
  const SplitLog2 log = SplitLog2Of(x);
  return log.exponent + log.fraction;
}

double DetPow(double x, double y) {
  if (y == 0) return 1.0;
  if (x == 0) return y > 0 ? 0.0 : std::numeric_limits<double>::infinity();
  if (!std::isfinite(x) || !std::isfinite(y) || x < 0) {
    return DetExp2(y * DetLog2(x));
  }
  // The exponent y log2 x, in parts so that its digits after the point are not
  // lost when it is large.
  const SplitLog2 log = SplitLog2Of(x);
  const double whole = std::nearbyint(y * (log.exponent + log.fraction));
  if (whole > 1024.0) return std::numeric_limits<double>::infinity();
  if (whole < -1080.0) return 0.0;
  const double high = UpperHalf(y);
  const double rest = (high * log.exponent - whole) +
                      (y - high) * log.exponent + y * log.fraction;
  return ScaledExp(rest * kLn2, whole);
}

double DetExp(double x) {
  if (std::isnan(x)) return x;
  if (x >= 710.0) return std::numeric_limits<double>::infinity();
  if (x < -746.0) return 0.0;
  const double whole = std::nearbyint(x * kLog2E);
  return ScaledExp((x - whole * kLn2High) - whole * kLn2Low, whole);
}

double DetLog(double x) { return DetLog2(x) * kLn2; }

double DetSin(double x) { return SinPlusQuarters(x, 0); }

double DetCos(double x) { return SinPlusQuarters(x, 1); }

SineCosine64 DetSinCos(double x) {
  if (!(std::fabs(x) <= kLargestAngle)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {kNan, kNan};
  }
  const Reduced reduced = Reduce(x);
  const double square = reduced.rest * reduced.rest;
  const double sine = reduced.rest * Polynomial(kSineTerms, square);
  const double cosine = Polynomial(kCosineTerms, square);
  switch (reduced.quarters & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace terrane::core
