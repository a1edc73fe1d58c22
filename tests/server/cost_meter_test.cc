// What a point costs, out of what messages took.
#include "server/actor/cost_meter.h"

#include <gtest/gtest.h>

#include <chrono>

namespace terrane::server {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(CostMeterTest, StartsWithThePriceThatItIsGiven) {
  EXPECT_DOUBLE_EQ(CostMeter(7).Seconds(1'000'000), 7e-3);
}

TEST(CostMeterTest, FollowsWhatMessagesTake) {
  CostMeter meter;
  for (int k = 0; k < 200; ++k) meter.Add(milliseconds(4), 4000);
  EXPECT_NEAR(meter.Seconds(4000), 4e-3, 1e-5);
  for (int k = 0; k < 200; ++k) meter.Add(milliseconds(1), 4000);
  EXPECT_NEAR(meter.Seconds(4000), 1e-3, 1e-5);
  meter.Add(milliseconds(1), 0);  // says nothing
  EXPECT_NEAR(meter.Seconds(4000), 1e-3, 1e-5);
}

// Windows of 129 x 129 samples in tiles of 64: the corner's tile has one.
TEST(CostMeterTest, TheTileOfOneSampleHardlyCounts) {
  CostMeter meter;
  const auto window = [&meter] {
    for (int k = 0; k < 4; ++k) meter.Add(microseconds(20), 64 * 64);
    for (int k = 0; k < 4; ++k) meter.Add(microseconds(6), 64);
    meter.Add(microseconds(5), 1);
  };
  for (int k = 0; k < 50; ++k) window();
  EXPECT_NEAR(meter.Seconds(129 * 129), 110e-6, 60e-6);
  // Nor does its worker being held up over it make it seconds.
  meter.Add(milliseconds(80), 1);
  EXPECT_LT(meter.Seconds(129 * 129), 300e-6);
}

TEST(CostMeterTest, AMachineThatStoodStillAtMostDoublesThePrice) {
  CostMeter meter;
  for (int k = 0; k < 200; ++k) meter.Add(microseconds(20), 4000);
  meter.Add(std::chrono::minutes(1), 4000);
  EXPECT_LT(meter.Seconds(4000), 40e-6);
}

}  // namespace
}  // namespace terrane::server
