// Perlin's gradient noise in the plane, with its derivatives.
//
// Lattice point (i, j) has the gradient G[(Q[i mod 256] + j) mod 256]: Q a
// permutation of 0..255, G 256 unit vectors, both hashed from the seed (Wang,
// Zhang & Yang 2019, eq. 4). The noise is the sum of the four corners' products
// of distance and gradient, weighted by the fade 6 t^5 - 15 t^4 + 10 t^3 (eqs.
// 5-8); it is 0 on lattice points, within +-0.7071, and its rms is 0.217. It
// repeats after 256 cells.
//
// On a line of constant y the weighted gradients of a lattice column are linear
// functions of the distance from it. They are made once a column
// (LatticeColumn), which leaves a dozen operations for a sample.
//
// Immutable and thread-safe. Float32; IEEE operations in the order written, so
// the same bits everywhere.
#ifndef TERRANE_CORE_NOISE_PERLIN_NOISE_H_
#define TERRANE_CORE_NOISE_PERLIN_NOISE_H_

#include <array>
#include <cmath>
#include <cstdint>

#include "core/mesh/mesh.h"

namespace terrane::core {

struct NoiseSample {
  float value = 0;
  float dx = 0;
  float dy = 0;
};

// What the two ends of a lattice edge add at distance d from their column, on
// a line of constant y: slope * d + level to the value, slope_dy * d + level_dy
// to its derivative along y.
struct LatticeColumn {
  float slope = 0;
  float level = 0;
  float slope_dy = 0;
  float level_dy = 0;
};

// psi and its derivative at t in [0, 1].
constexpr float NoiseFade(float t) {
  return ((6.0f * t - 15.0f) * t + 10.0f) * (t * t * t);
}
constexpr float NoiseFadeSlope(float t) {
  const float rest = 1.0f - t;
  return 30.0f * (t * t) * (rest * rest);
}

// The noise between two columns, at x in [0, 1] from the left one.
constexpr NoiseSample NoiseBetween(const LatticeColumn& left,
                                   const LatticeColumn& right, float x) {
  const float back = x - 1.0f;
  const float fade = NoiseFade(x);
  const float from = left.slope * x + left.level;
  const float change = (right.slope * back + right.level) - from;
  const float from_dy = left.slope_dy * x + left.level_dy;
  const float change_dy = (right.slope_dy * back + right.level_dy) - from_dy;
  return {from + fade * change,
          (left.slope + fade * (right.slope - left.slope)) +
              NoiseFadeSlope(x) * change,
          from_dy + fade * change_dy};
}

class PerlinNoise {
 public:
  explicit PerlinNoise(std::int64_t seed);

  // g[i, j].
  Float2 GradientAt(int i, int j) const {
    const auto column = static_cast<unsigned>(i) & 255u;
    const auto row = static_cast<unsigned>(j);
    return gradients_[(permutation_[column] + row) & 255u];
  }

  // Column i on the line y = j + y_rest, y_rest in [0, 1].
  LatticeColumn ColumnAt(int i, int j, float y_rest) const;

  // |x| and |y| below 2^22.
  NoiseSample At(float x, float y) const;

 private:
  std::array<std::uint8_t, 256> permutation_;
  std::array<Float2, 256> gradients_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_NOISE_PERLIN_NOISE_H_
