// Weights of four equally spaced values around t, between the second (t = 0)
// and the third (t = 1). Deterministic; safe from any thread.
#ifndef TERRANE_CORE_GRID_CUBIC_WEIGHTS_H_
#define TERRANE_CORE_GRID_CUBIC_WEIGHTS_H_

namespace terrane::core {

struct CubicWeights {
  double at[4];
};

// Exactly (0, 1, 0, 0) at 0 and (0, 0, 1, 0) at 1. The sum of the absolute
// weights is at most kCatmullRomGain: how far values may overshoot.
inline constexpr double kCatmullRomGain = 1.25;
inline CubicWeights CatmullRomWeights(double t) {
  return {{t * (t * (1.0 - 0.5 * t) - 0.5), t * t * (1.5 * t - 2.5) + 1.0,
           t * (t * (2.0 - 1.5 * t) + 0.5), t * t * (0.5 * t - 0.5)}};
}

// The cubic B-spline; applies to coefficients, not to samples.
inline CubicWeights BSplineWeights(double t) {
  const double s = 1.0 - t;
  const double first = s * s * s / 6.0;
  const double last = t * t * t / 6.0;
  const double second = 2.0 / 3.0 - t * t * (1.0 - 0.5 * t);
  return {{first, second, 1.0 - first - second - last, last}};
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_CUBIC_WEIGHTS_H_
