// Powers to the digits of a float, for shading: several times quicker than
// core/base/det_math.h, and as deterministic: IEEE operations only, the same
// bits everywhere. Pure functions, safe from any thread.
#ifndef TERRANE_CORE_RAYTRACE_QUICK_MATH_H_
#define TERRANE_CORE_RAYTRACE_QUICK_MATH_H_

#include <bit>
#include <cmath>
#include <cstdint>

namespace terrane::core {

// 2^x to 8e-9 of it for x in [-1000, 1000].
inline double QuickExp2(double x) {
  const double whole = std::nearbyint(x);
  const double r = (x - whole) * 0x1.62e42fefa39efp-1;  // ln 2
  // Taylor of e^r, |r| <= 0.35.
  double sum = 1.0 / 5040;
  for (const double factor :
       {1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0}) {
    sum = sum * r + factor;
  }
  // 2^whole by its exponent bits.
  return sum *
         std::bit_cast<double>((
             static_cast<std::uint64_t>(static_cast<std::int64_t>(whole) + 1023)
             << 52));
}

// x^y to 1e-6 of it for x in (0, 1], y in [0, 10^4]; 0 for what is below
// 2^-1000, and for x = 0.
inline double QuickPower(double x, double y) {
  if (x <= 0) return 0;
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // [0.5, 1)
  if (m < 0x1.6a09e667f3bcdp-1) {       // sqrt(1/2)
    m *= 2;
    --exponent;
  }
  // ln m = 2 atanh(t), |t| <= 0.1716: exact to 2^-40 of it, so that a large y
  // loses nothing.
  const double t = (m - 1) / (m + 1);
  const double t2 = t * t;
  double sum = 1.0 / 15;
  for (const double factor :
       {1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0}) {
    sum = sum * t2 + factor;
  }
  const double log2 = exponent + 2 * t * sum * 0x1.71547652b82fep+0;
  return y * log2 < -1000 ? 0 : QuickExp2(y * log2);
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_QUICK_MATH_H_
