// Where petals sit and how far they are open: rotations, arrangements, stages.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/flower/growth.h"
#include "core/flower/rotation.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/flower_presets.h"
#include "tests/core/whole_flower.h"

namespace terrane::core {
namespace {

using ::testing::SizeIs;

constexpr double kPi = 3.14159265358979323846;

// --- Rotations --------------------------------------------------------------

TEST(Turn, TurnsAboutItsAxisAndComposes) {
  const auto expect = [](Vector a, double x, double y, double z) {
    EXPECT_NEAR(a.x, x, 1e-12);
    EXPECT_NEAR(a.y, y, 1e-12);
    EXPECT_NEAR(a.z, z, 1e-12);
  };
  expect(AboutX(90).Of({0, 1, 0}), 0, 0, 1);
  expect(AboutY(90).Of({0, 0, 1}), 1, 0, 0);
  expect(AboutZ(90).Of({1, 0, 0}), 0, 1, 0);
  expect((AboutZ(90) * AboutX(90)).Of({0, 1, 0}), 0, 0, 1);
  expect((AboutX(90) * AboutZ(90)).Of({1, 0, 0}), 0, 0, 1);
  const Vector unit = UnitOf({0.3, -0.5, 0.2});
  expect(FromZTo(unit).Of({0, 0, 1}), unit.x, unit.y, unit.z);
  EXPECT_NEAR(SineCosineOf(-330).sine, 0.5, 1e-15);
  EXPECT_NEAR(SineCosineOf(360e4 + 60).cosine, 0.5, 1e-9);
}

// --- Arrangement ------------------------------------------------------------

TEST(Arrangement, VogelIsTheLawOfThePaper) {
  Arrangement arrangement;
  arrangement.spacing = 0.03;
  for (int n = 1; n <= 1000; ++n) {
    const Seat seat = SeatOf(arrangement, n, 1000, 1);
    EXPECT_DOUBLE_EQ(seat.radius, 0.03 * std::sqrt(n));
    EXPECT_DOUBLE_EQ(seat.azimuth_deg, n * 137.50776405);
    EXPECT_EQ(seat.rank, n);
  }
}

TEST(Arrangement, AWhorlHasLayersTurnedByHalfAStep) {
  Arrangement arrangement;
  arrangement.kind = ArrangementKind::kWhorl;
  arrangement.layers = 2;
  arrangement.radius = 1;
  arrangement.phase_deg = 10;
  const Seat third = SeatOf(arrangement, 3, 6, 1);
  EXPECT_DOUBLE_EQ(third.azimuth_deg, 10 + 240);
  EXPECT_DOUBLE_EQ(third.radius, 1.1);
  EXPECT_EQ(third.share, 0);
  EXPECT_EQ(third.rank, 3);
  const Seat fourth = SeatOf(arrangement, 4, 6, 0.5);
  EXPECT_DOUBLE_EQ(fourth.azimuth_deg, 10 + 60);
  EXPECT_DOUBLE_EQ(fourth.radius, 0.5 * 1.2);
  EXPECT_EQ(fourth.share, 1);
  EXPECT_EQ(fourth.rank, 6);
  // One layer, over part of the circle: 360 (n - 1) / Np for all of it.
  arrangement = {};
  arrangement.kind = ArrangementKind::kWhorl;
  EXPECT_DOUBLE_EQ(SeatOf(arrangement, 5, 5, 1).azimuth_deg, 360 * 4 / 5.0);
  arrangement.arc_deg = 100;
  EXPECT_DOUBLE_EQ(SeatOf(arrangement, 2, 2, 1).azimuth_deg, 50);
}

TEST(Arrangement, ADomeIsHighestAtItsCentre) {
  Arrangement arrangement;
  arrangement.height = 0.2;
  arrangement.dome = 0.5;
  EXPECT_NEAR(SeatOf(arrangement, 100, 100, 1).height, 0.2, 1e-12);
  EXPECT_NEAR(SeatOf(arrangement, 25, 100, 1).height, 0.2 + 0.5 * 0.75, 1e-12);
}

std::vector<Float3> Florets() {
  FlowerSpec spec = FlowerPreset("sunflower");
  spec.petals.clear();
  spec.leaves.clear();
  spec.stem.reset();
  spec.solids.resize(1);
  spec.unit_m = 1;
  spec.variation = 0;
  EXPECT_EQ(spec.solids[0].count, 1000);
  return GrowRows(spec).translation;
}

TEST(SunflowerHead, DivergesByTheGoldenAngle) {
  const std::vector<Float3> florets = Florets();
  for (std::size_t i = 1; i < florets.size(); ++i) {
    const double before = std::atan2(florets[i - 1].y, florets[i - 1].x);
    const double here = std::atan2(florets[i].y, florets[i].x);
    const double step = std::fmod((here - before) * 180 / kPi + 720, 360);
    ASSERT_NEAR(step, 137.50776405, 1e-3) << i;
  }
}

TEST(SunflowerHead, FloretsKeepTheirDistance) {
  const std::vector<Float3> florets = Florets();
  const double spacing =
      FlowerPreset("sunflower").solids[0].arrangement.spacing;
  double least = 1e9;
  for (std::size_t i = 0; i < florets.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(
          least, std::hypot(static_cast<double>(florets[i].x - florets[j].x),
                            static_cast<double>(florets[i].y - florets[j].y)));
    }
  }
  EXPECT_GE(least, 1.60 * spacing);
}

// --- Growth -----------------------------------------------------------------

TEST(Growth, OpensPetalsAsThePaperSays) {
  constexpr auto kVogel = ArrangementKind::kVogel;
  const GrowthStage stage = {8, 0.7, 1, 1};
  for (int n = 1; n <= 8; ++n) EXPECT_EQ(Openness(stage, kVogel, n, 34), 0);
  EXPECT_DOUBLE_EQ(Openness(stage, kVogel, 21, 34), 0.7 * 13 / 26);
  EXPECT_DOUBLE_EQ(Openness(stage, kVogel, 34, 34), 0.7);
  // All buds: nothing opens, and nothing is divided by 0.
  EXPECT_EQ(Openness({34, 1, 1, 1}, kVogel, 34, 34), 0);
  EXPECT_DOUBLE_EQ(Openness(stage, ArrangementKind::kWhorl, 3, 6), 0.35);
  const GrowthStage half = StageAt({30, 0.1, 0.6, 0.4}, {8, 0.7, 1, 1}, 0.5);
  EXPECT_DOUBLE_EQ(half.buds, 19);
  EXPECT_DOUBLE_EQ(half.angle_ratio, 0.4);
  EXPECT_DOUBLE_EQ(half.size, 0.8);
  EXPECT_DOUBLE_EQ(half.spread, 0.7);
}

// Elevation of a petal: of its y, in degrees.
std::vector<double> Elevations(const FlowerSpec& spec) {
  const InstanceBlock rows = GrowRows(spec);
  std::vector<double> elevations;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const Quaternion q = rows.rotation[i];
    const double up =
        2 * (static_cast<double>(q.y * q.z) + static_cast<double>(q.x * q.w));
    elevations.push_back(std::asin(std::clamp(up, -1.0, 1.0)) * 180 / kPi);
  }
  return elevations;
}

FlowerSpec BareRose(double stage) {
  FlowerSpec rose = FlowerPreset("rose");
  rose.petals.resize(1);
  rose.leaves.clear();
  rose.solids.clear();
  rose.stem.reset();
  rose.variation = 0;
  rose.stage = stage;
  return rose;
}

TEST(Growth, APetalStandsAtItsAngle) {
  const FlowerSpec rose = BareRose(1);
  const PetalGroup& petals = rose.petals[0];
  const std::vector<double> elevations = Elevations(rose);
  ASSERT_THAT(elevations, SizeIs(34));
  for (int n = 1; n <= 34; ++n) {
    const double open = n <= 8 ? 0 : 0.7 * (n - 8) / 26.0;
    const double expected =
        petals.angle_deg - open * (petals.angle_deg - petals.open_angle_deg);
    EXPECT_NEAR(elevations[static_cast<std::size_t>(n) - 1], expected, 0.05);
  }
}

TEST(Growth, AStageOpensTheFlower) {
  double before = 91;
  for (const double stage : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const std::vector<double> elevations = Elevations(BareRose(stage));
    const double mean =
        std::accumulate(elevations.begin(), elevations.end(), 0.0) / 34;
    EXPECT_LT(mean, before);
    before = mean;
  }
}

}  // namespace
}  // namespace terrane::core
