// What the user sets and what it does: section 2 of Mo, Tan & Zhang 2001, with
// numbers, on a 4 x 4 Bezier net like the paper's figure 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/core/surface_reference.h"

namespace terrane::core {
namespace {

constexpr SurfaceGrid kGrid = {65, 65};

double Mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

double Correlation(const std::vector<float>& a, const std::vector<float>& b) {
  const double mean_a = Mean(a);
  const double mean_b = Mean(b);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double da = static_cast<double>(a[k]) - mean_a;
    const double db = static_cast<double>(b[k]) - mean_b;
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  return ab / std::sqrt(aa * bb);
}

// Root mean square of the second difference along t: what is rough about a
// surface, and small on a smooth one.
double Roughness(const std::vector<float>& heights, const SurfaceGrid& grid) {
  double sum = 0;
  double count = 0;
  for (std::int64_t j = 0; j < grid.rows; ++j) {
    for (std::int64_t i = 1; i + 1 < grid.columns; ++i) {
      const auto k = static_cast<std::size_t>(j * grid.columns + i);
      const double second = static_cast<double>(heights[k - 1]) -
                            2.0 * static_cast<double>(heights[k]) +
                            static_cast<double>(heights[k + 1]);
      sum += second * second;
      count += 1;
    }
  }
  return std::sqrt(sum / count);
}

SurfaceSpec Hill(SurfaceMethod method = SurfaceMethod::kProducts) {
  SurfaceSpec spec;
  spec.seed = 11;
  spec.net = HillNet();
  spec.method = method;
  return spec;
}

// Section 2 (1): w = U and Y = 1 keep the surface's overall shape.
TEST(SurfaceEffects, RandomWeightsAndAResponseOf1KeepTheOverallShape) {
  const SurfaceSpec spec = Hill();
  const std::vector<float> regular = RegularHeightsOf(spec, kGrid);
  const std::vector<float> fractal = HeightsOf(spec, kGrid);
  EXPECT_GT(Correlation(fractal, regular), 0.95);
  EXPECT_NEAR(Mean(fractal), Mean(regular), 0.05 * Mean(regular));
  EXPECT_GT(Roughness(fractal, kGrid), 20 * Roughness(regular, kGrid));
}

// Section 2 (2): a raised weight lifts the surface near its control point.
TEST(SurfaceEffects, OneRaisedWeightLiftsItsOwnNeighbourhood) {
  SurfaceSpec spec = Hill();
  spec.network.weights = {{.offset = 1}};
  const std::vector<float> before = HeightsOf(spec, kGrid);
  spec.network.weights.push_back({.i = 2, .j = 1, .offset = 8});
  const std::vector<float> after = HeightsOf(spec, kGrid);
  double largest = 0;
  std::size_t place = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const double lift =
        static_cast<double>(after[k]) - static_cast<double>(before[k]);
    if (lift > largest) {
      largest = lift;
      place = k;
    }
  }
  // Its blending function is largest at t = 2/3, u = 1/3.
  EXPECT_GT(largest, 0.5);
  EXPECT_NEAR(static_cast<double>(place % 65) / 64, 2.0 / 3, 0.15);
  EXPECT_NEAR(static_cast<double>(place / 65) / 64, 1.0 / 3, 0.15);
  for (const std::size_t corner : {0u, 64u, 64u * 65u, 65u * 65u - 1u}) {
    EXPECT_NEAR(after[corner], before[corner], 1e-3);
  }
}

// Section 2 (2): Y scales the displacement, not exactly proportionally.
TEST(SurfaceEffects, TheResponseScalesTheHeightNotExactlyProportionally) {
  SurfaceSpec spec = Hill();
  const std::vector<float> once = HeightsOf(spec, kGrid);
  spec.network.desired = 2;
  const std::vector<float> twice = HeightsOf(spec, kGrid);
  EXPECT_GT(Correlation(once, twice), 0.98);
  const double ratio = Mean(twice) / Mean(once);
  EXPECT_GT(ratio, 1.9);
  EXPECT_LT(ratio, 2.1);
  double largest = 0;
  for (std::size_t k = 0; k < once.size(); ++k) {
    largest = std::max(largest,
                       static_cast<double>(std::fabs(twice[k] - 2 * once[k])));
  }
  EXPECT_GT(largest, 0.05);
}

// Section 2 (3) I and II: gamma is the roughness.
TEST(SurfaceEffects, GammaGovernsTheRoughness) {
  SurfaceSpec spec = Hill();
  spec.network.weights = {{.offset = 1}, {.i = 1, .j = 0, .offset = 10}};
  spec.network.desired = 0;
  // gamma = 0: smooth (figure 6), so that second differences fall with the
  // square of the spacing; those of a fractal do not.
  double last = Roughness(HeightsOf(spec, kGrid), kGrid);
  const SurfaceGrid dense = {129, 129};
  EXPECT_NEAR(last / Roughness(HeightsOf(spec, dense), dense), 4, 0.1);
  for (const double gamma : {0.1, 0.3, 0.55, 1.0}) {
    spec.network.desired_random = gamma;
    const double roughness = Roughness(HeightsOf(spec, kGrid), kGrid);
    EXPECT_GT(roughness, 1.5 * last) << gamma;
    spec.network.desired_random = -gamma;
    EXPECT_NEAR(Roughness(HeightsOf(spec, kGrid), kGrid), roughness,
                0.1 * roughness);
    last = roughness;
  }
}

// Section 2 (3) III: with carry-over and a weight re-drawn, gamma governs the
// roughness and the overall shape stays.
TEST(SurfaceEffects, CarryOverKeepsTheShapeAndGammaItsRoughness) {
  SurfaceSpec spec = Hill();
  spec.carry_over = true;
  double last = 0;
  for (const double gamma : {1.0, 5.0, 10.0}) {
    spec.network.weights = {{.random = 1},
                            {.i = 1, .j = 0, .random = gamma, .redraw = true}};
    const std::vector<float> heights = HeightsOf(spec, kGrid);
    EXPECT_GT(Correlation(heights, RegularHeightsOf(spec, kGrid)), 0.7)
        << gamma;
    const double roughness = Roughness(heights, kGrid);
    EXPECT_GT(roughness, 1.2 * last) << gamma;
    last = roughness;
  }
}

// Nothing re-drawn: the weights of a row settle, and rows are smooth.
TEST(SurfaceEffects, CarryOverWithoutRedrawingIsSmoothAlongT) {
  SurfaceSpec spec = Hill();
  const double independent = Roughness(HeightsOf(spec, kGrid), kGrid);
  spec.carry_over = true;
  EXPECT_LT(Roughness(HeightsOf(spec, kGrid), kGrid), 0.05 * independent);
}

// Figure 10: method 3 is fractal in places, and smooth in others.
TEST(SurfaceEffects, MethodThreeIsLocallyFractal) {
  SurfaceSpec spec = Hill(SurfaceMethod::kTwoFactors);
  spec.network.weights = {{.random = 1}, {.i = 0, .random = -12}};
  spec.network.desired = -0.02;
  spec.network_u.weights = {{.offset = 1}, {.j = 0, .offset = 25}};
  spec.network_u.desired = 0;
  spec.network_u.desired_random = 0.2;
  const std::vector<float> heights = HeightsOf(spec, kGrid);
  // Roughness of the eight by eight blocks.
  std::vector<double> blocks;
  for (std::int64_t y = 0; y < 64; y += 8) {
    for (std::int64_t x = 0; x < 64; x += 8) {
      std::vector<float> block;
      for (std::int64_t k = 0; k < 64; ++k) {
        block.push_back(
            heights[static_cast<std::size_t>((y + k / 8) * 65 + x + k % 8)]);
      }
      blocks.push_back(Roughness(block, {8, 8}));
    }
  }
  std::sort(blocks.begin(), blocks.end());
  // The roughest tenth is many times rougher than the smoothest tenth.
  EXPECT_GT(blocks[57], 20 * blocks[6]);
}

// Method 2's weights serve a whole column of control points, so it moves the
// surface in waves along t; method 1's move single points.
TEST(SurfaceEffects, MethodTwoRaisesAWholeColumn) {
  SurfaceSpec spec = Hill(SurfaceMethod::kAlongT);
  spec.network.weights = {{.offset = 1}};
  const std::vector<float> before = HeightsOf(spec, kGrid);
  spec.network.weights.push_back({.i = 2, .offset = 4});
  const std::vector<float> after = HeightsOf(spec, kGrid);
  const auto lift_at = [&](std::size_t i, std::size_t j) {
    return after[j * 65 + i] - before[j * 65 + i];
  };
  for (const std::size_t j : {16u, 32u, 48u}) {
    EXPECT_GT(lift_at(42, j), 0.1f) << j;
  }
}

}  // namespace
}  // namespace terrane::core
