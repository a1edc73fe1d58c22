#include "core/base/det_math.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace terrane::core {
namespace {

constexpr double kLn2 = 0x1.62e42fefa39efp-1;
constexpr double kLog2E = 0x1.71547652b82fep+0;

}  // namespace

double DetExp2(double x) {
  if (std::isnan(x)) return x;
  if (x >= 1024.0) return std::numeric_limits<double>::infinity();
  if (x < -1080.0) return 0.0;
  const double whole = std::nearbyint(x);
  // e^r with r = (x - whole) ln 2 in [-0.35, 0.35]: Taylor to r^13 leaves less
  // than 2^-60.
  const double r = (x - whole) * kLn2;
  double sum = 1.0;
  for (int k = 14; k >= 1; --k) sum = 1.0 + sum * r / k;
  return std::ldexp(sum, static_cast<int>(whole));
}

double DetLog2(double x) {
  if (std::isnan(x) || x < 0) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
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
  return exponent + 2.0 * t * sum * kLog2E;
}

double DetPow(double x, double y) {
  if (y == 0) return 1.0;
  if (x == 0) return y > 0 ? 0.0 : std::numeric_limits<double>::infinity();
  return DetExp2(y * DetLog2(x));
}

double DetExp(double x) { return DetExp2(x * kLog2E); }

double DetLog(double x) { return DetLog2(x) * kLn2; }

}  // namespace terrane::core
