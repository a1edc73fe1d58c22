// Deterministic elementary functions.
//
// libm's results differ between versions and CPUs; Terrane's must not. These
// are built from IEEE operations and polynomials only, so they give the same
// bits on every machine, and are within 4 ulp of the true value. Double
// precision; safe from any thread. Compile with -ffp-contract=off (all of core
// is).
#ifndef TERRANE_CORE_BASE_DET_MATH_H_
#define TERRANE_CORE_BASE_DET_MATH_H_

namespace terrane::core {

// 2^x. 0 below -1074, infinity above 1024, NaN for NaN.
double DetExp2(double x);
// log2(x) for x > 0; -infinity for 0, NaN below.
double DetLog2(double x);
// x^y for x >= 0; 0^0 = 1, 0^y = 0 for y > 0. Within 4 ulp for |y| <= 4; the
// error grows with |y| beyond.
double DetPow(double x, double y);
// e^x.
double DetExp(double x);
// Natural logarithm of x > 0.
double DetLog(double x);
// Sine and cosine of x radians, |x| <= 10^5; NaN beyond. Within 4 ulp, or
// within 2^-60 where that is more (next to a zero of theirs).
double DetSin(double x);
double DetCos(double x);

// Both at once, of the same accuracy, not always the same bits: a quarter of
// the time.
struct SineCosine64 {
  double sine = 0;
  double cosine = 1;
};
SineCosine64 DetSinCos(double x);

}  // namespace terrane::core

#endif  // TERRANE_CORE_BASE_DET_MATH_H_
