#include "core/grid/hillshade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace terrane::core {
namespace {

using testing::Each;
using testing::FloatNear;

constexpr std::int64_t kWidth = 7;
constexpr std::int64_t kHeight = 5;

// A plane that rises by `east` a metre eastwards and `north` northwards.
std::vector<float> PlaneHeights(double east, double north,
                                const GroundSpacing& spacing) {
  std::vector<float> heights;
  for (std::int64_t j = 0; j < kHeight; ++j) {
    for (std::int64_t i = 0; i < kWidth; ++i) {
      heights.push_back(
          static_cast<float>(east * spacing.x * static_cast<double>(i) -
                             north * spacing.y * static_cast<double>(j)));
    }
  }
  return heights;
}

std::vector<float> Shade(const std::vector<float>& heights,
                         const GroundScale& scale, const Light& light,
                         double exaggeration = 1) {
  std::vector<float> shade(heights.size());
  Hillshade({kWidth, kHeight, heights}, scale, light, exaggeration, shade);
  return shade;
}

// Cosine between the plane's normal and the light.
float Analytic(double east, double north, const Light& light) {
  const double cosine = (light.up - east * light.east - north * light.north) /
                        std::sqrt(1 + east * east + north * north);
  return static_cast<float>(std::max(cosine, 0.0));
}

TEST(Hillshade, PlaneHasItsAnalyticValueEverywhereAlsoAtTheBorder) {
  const GroundSpacing spacing{4, 2};
  const Light light;
  for (const auto& [east, north] :
       {std::pair(0.0, 0.0), std::pair(0.5, 0.0), std::pair(0.0, 0.5),
        std::pair(-0.5, 0.25), std::pair(1.0, -1.0)}) {
    const std::vector<float> shade =
        Shade(PlaneHeights(east, north, spacing), GroundScale(spacing), light);
    EXPECT_THAT(shade, Each(FloatNear(Analytic(east, north, light), 1e-6F)))
        << east << ", " << north;
  }
}

TEST(Hillshade, SlopeTowardsTheNorthWestIsBrighterThanThePlain) {
  const GroundSpacing spacing{1, 1};
  // Falls towards the north-west: faces the default light.
  const float facing = Shade(PlaneHeights(0.5, -0.5, spacing),
                             GroundScale(spacing), Light())[17];
  const float plain =
      Shade(PlaneHeights(0, 0, spacing), GroundScale(spacing), Light())[17];
  const float averted = Shade(PlaneHeights(-0.5, 0.5, spacing),
                              GroundScale(spacing), Light())[17];
  EXPECT_GT(facing, plain);
  EXPECT_GT(plain, averted);
}

TEST(Hillshade, FarSideIsBlackNotNegative) {
  const GroundSpacing spacing{1, 1};
  const Light west{-1, 0, 0};
  EXPECT_THAT(Shade(PlaneHeights(-2, 0, spacing), GroundScale(spacing), west),
              Each(FloatNear(0, 0)));
}

TEST(Hillshade, EveryRowHasItsOwnSpacing) {
  // The same heights on rows that are twice as wide are half as steep.
  std::vector<GroundSpacing> rows(kHeight, GroundSpacing{1, 1});
  rows[2] = {2, 1};
  const std::vector<float> shade =
      Shade(PlaneHeights(0.5, 0, {1, 1}), GroundScale(rows), Light());
  EXPECT_NEAR(shade[1 * kWidth + 3], Analytic(0.5, 0, Light()), 1e-6);
  EXPECT_NEAR(shade[2 * kWidth + 3], Analytic(0.25, 0, Light()), 1e-6);
}

TEST(Hillshade, ExaggerationMultipliesTheSlope) {
  const GroundSpacing spacing{1, 1};
  EXPECT_THAT(Shade(PlaneHeights(0.25, 0.125, spacing), GroundScale(spacing),
                    Light(), 4),
              Each(FloatNear(Analytic(1, 0.5, Light()), 1e-6F)));
}

TEST(Hillshade, HolesStayHolesAndDoNotSpread) {
  std::vector<float> heights = PlaneHeights(0, 0, {1, 1});
  heights[17] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> shade =
      Shade(heights, GroundScale(GroundSpacing{1, 1}), Light());
  for (std::size_t at = 0; at < shade.size(); ++at) {
    EXPECT_EQ(std::isnan(shade[at]), at == 17) << at;
  }
}

TEST(Hillshade, SingleSampleIsLevel) {
  const std::vector<float> heights = {42};
  std::vector<float> shade(1);
  Hillshade({1, 1, heights}, GroundScale(GroundSpacing{1, 1}), Light(), 1,
            shade);
  EXPECT_NEAR(shade[0], Light().up, 1e-6);
}

}  // namespace
}  // namespace terrane::core
