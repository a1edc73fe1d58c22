// How errors of spots are measured and told apart.
#include "client/spot_verifier.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace terrane::client {
namespace {

// 3 x 2 samples, 10 apart, the first at (100, 50), rows going south.
PlacedRaster Heights() {
  PlacedRaster placed;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  placed.raster = {3, 2, {100, 50, 10, -10}, {0, 2, 4, 10, 0.1F, nan}};
  return placed;
}

SpotFile Spots(const std::vector<std::array<double, 3>>& rows,
               const std::vector<double>& standard_errors = {}) {
  SpotFile spots;
  for (const auto& [x, y, z] : rows) {
    spots.table.x.push_back(x);
    spots.table.y.push_back(y);
    spots.table.height.push_back(z);
    spots.table.source.push_back(static_cast<std::int64_t>(spots.table.rows()) +
                                 1);
  }
  spots.table.standard_error = standard_errors;
  return spots;
}

TEST(SpotVerifierTest, SpotsOnSamplesMustBeTheNearestFloat) {
  const SpotComparison met = CompareSpots(
      Heights(), Spots({{100, 50, 0}, {110, 40, 0.1}, {100, 40, 10}}));
  EXPECT_EQ(met.on_samples.count(), 3);
  EXPECT_EQ(met.not_nearest, 0);
  EXPECT_LT(met.worst(), 1e-8);
  EXPECT_GT(met.worst(), 0);  // 0.1 is no float
  const SpotComparison off =
      CompareSpots(Heights(), Spots({{100, 50, 0}, {110, 50, 2.0000002}}));
  EXPECT_EQ(off.not_nearest, 1);
  EXPECT_EQ(off.on_samples.worst_source(), 3);
}

TEST(SpotVerifierTest, ErrorsAreFileMinusSpot) {
  const SpotErrors errors =
      CompareSpots(Heights(), Spots({{100, 50, 3}, {110, 50, 1}, {120, 50, 2}}))
          .on_samples;
  EXPECT_EQ(errors.worst(), 3);
  EXPECT_EQ(errors.worst_source(), 2);
  EXPECT_EQ(errors.mean_absolute(), 2);
  EXPECT_EQ(errors.bias(), 0);
  EXPECT_DOUBLE_EQ(errors.root_mean_square(), std::sqrt(14.0 / 3));
}

TEST(SpotVerifierTest, BetweenSamplesIsBilinear) {
  // Row 0 half way; the middle of four; along a column.
  const SpotComparison result = CompareSpots(
      Heights(), Spots({{105, 50, 1}, {105, 45, 3.025}, {100, 42.5, 7.5}}));
  EXPECT_EQ(result.between_samples.count(), 3);
  EXPECT_LT(result.worst(), 1e-6);
  EXPECT_EQ(result.not_nearest, 0);
}

TEST(SpotVerifierTest, StandardErrorsAreAClassOfTheirOwn) {
  const SpotComparison result =
      CompareSpots(Heights(), Spots({{100, 50, 1}, {105, 50, 1}}, {0.5, 0}));
  EXPECT_EQ(result.with_standard_error.count(), 1);
  EXPECT_EQ(result.with_standard_error.worst(), 1);
  EXPECT_EQ(result.between_samples.count(), 1);
  EXPECT_EQ(result.on_samples.count(), 0);
  EXPECT_EQ(result.not_nearest, 0);
}

TEST(SpotVerifierTest, OutsideAndNodataAreCounted) {
  const SpotComparison result =
      CompareSpots(Heights(), Spots({{99, 50, 1},
                                     {100, 51, 1},
                                     {121, 50, 1},
                                     {120, 40, 1},
                                     {115, 45, 1},
                                     {120.000001, 50, 4}}));
  EXPECT_EQ(result.outside, 3);
  EXPECT_EQ(result.nodata, 2);
  EXPECT_EQ(result.on_samples.count(), 1);
  EXPECT_EQ(result.compared(), 1);
}

TEST(SpotVerifierTest, VerticesOfLinesAreSpots) {
  SpotFile spots;
  spots.lines.push_back({{100, 110}, {50, 50}, {0, 5}, 0, 7});
  const SpotComparison result = CompareSpots(Heights(), spots);
  EXPECT_EQ(result.on_samples.count(), 2);
  EXPECT_EQ(result.on_samples.worst(), 3);
  EXPECT_EQ(result.on_samples.worst_source(), 7);
}

}  // namespace
}  // namespace terrane::client
