// P_fbm has the statistics that the method promises: "How a result is judged"
// of docs/terrain.md, for the generators themselves.
//
// Estimates are over 48 windows of 256 x 256 samples, each of its own seed and
// place on the endless lattice, at a coarse and at a deep level: the windows of
// a deep one lie inside a hundred-thousandth of a level-0 cell. The draws are
// fixed, so a run never differs; what was found is recorded as a property of
// the test, with --gtest_output.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "tests/property/terrain_patch.h"

namespace terrane::core {
namespace {

constexpr int kWindows = 48;
constexpr int kSide = 256;

// 1 to 32 samples, about evenly spaced in scale and not only powers of two.
const std::vector<int> kLags = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32};

Window WindowAt(int k) {
  return {std::int64_t{k} * 12'345'677, -std::int64_t{k} * 7'654'321, kSide,
          kSide};
}

TerrainSpec SpecOf(FractalSource source, double roughness, int k) {
  TerrainSpec spec;
  spec.source = source;
  spec.roughness = roughness;
  spec.seed = 7919 * std::int64_t{k} + 1;
  return spec;
}

// H along x, y and the diagonal.
struct Hurst {
  double x = 0, y = 0, diagonal = 0;
};

Hurst HurstOf(FractalSource source, double roughness, int level) {
  Variogram x(kLags, 1, 0);
  Variogram y(kLags, 0, 1);
  Variogram diagonal(kLags, 1, 1);
  for (int k = 0; k < kWindows; ++k) {
    const auto terrain = MakeTerrain(SpecOf(source, roughness, k));
    const Patch patch = FractalPatch(*terrain, level, WindowAt(k));
    x.Add(patch);
    y.Add(patch);
    diagonal.Add(patch);
  }
  return {x.Hurst(), y.Hurst(), diagonal.Hurst()};
}

std::string Text(double value) {
  return std::to_string(std::round(value * 1000) / 1000).substr(0, 5);
}

void Record(const std::string& what, const Hurst& h) {
  testing::Test::RecordProperty(
      what, Text(h.x) + " " + Text(h.y) + " " + Text(h.diagonal));
}

// --- The Hurst exponent -----------------------------------------------------

class Roughness : public testing::TestWithParam<double> {};

TEST_P(Roughness, OfSubdivisionIsRecoveredFromTheVariogram) {
  for (const int level : {10, 20}) {
    const Hurst h = HurstOf(FractalSource::kSubdivision, GetParam(), level);
    Record("hurst_level_" + std::to_string(level), h);
    for (const double found : {h.x, h.y, h.diagonal}) {
      EXPECT_NEAR(found, GetParam(), 0.03) << "level " << level;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Roughness, testing::Values(0.5, 0.65, 0.8, 0.95));

// What the other sources recover, at level 10: they fall short by up to 0.08,
// that is the method. Held to what was found.
struct Found {
  FractalSource source;
  double roughness;
  double recovered;
};

TEST(RoughnessOfThePaper, FallsShortByWhatWasFound) {
  constexpr Found kFound[] = {
      {FractalSource::kMidpoint, 0.5, 0.455},
      {FractalSource::kMidpoint, 0.65, 0.595},
      {FractalSource::kMidpoint, 0.8, 0.745},
      {FractalSource::kMidpoint, 0.95, 0.925},
      {FractalSource::kSuccessive, 0.5, 0.46},
      {FractalSource::kSuccessive, 0.65, 0.60},
      {FractalSource::kSuccessive, 0.8, 0.745},
      {FractalSource::kSuccessive, 0.95, 0.905},
  };
  for (const Found& f : kFound) {
    const Hurst h = HurstOf(f.source, f.roughness, 10);
    const std::string name =
        (f.source == FractalSource::kMidpoint ? "midpoint_" : "successive_") +
        Text(f.roughness);
    Record(name, h);
    for (const double found : {h.x, h.y, h.diagonal}) {
      EXPECT_NEAR(found, f.recovered, 0.03) << name;
    }
  }
}

TEST(RoughnessOfALine, IsRecoveredFromTheVariogram) {
  constexpr Found kFound[] = {
      {FractalSource::kMidpoint, 0.5, 0.5},
      {FractalSource::kMidpoint, 0.65, 0.65},
      {FractalSource::kMidpoint, 0.8, 0.8},
      {FractalSource::kMidpoint, 0.95, 0.95},
      {FractalSource::kSuccessive, 0.8, 0.8},
      {FractalSource::kSubdivision, 0.5, 0.5},
      {FractalSource::kSubdivision, 0.65, 0.65},
      {FractalSource::kSubdivision, 0.8, 0.8},
      {FractalSource::kSubdivision, 0.95, 0.95},
  };
  for (const Found& f : kFound) {
    Variogram variogram(kLags, 1, 0);
    for (int k = 0; k < 400; ++k) {
      TerrainSpec spec = SpecOf(f.source, f.roughness, k);
      spec.dimensions = 1;
      variogram.Add(FractalPatch(*MakeTerrain(spec), 10,
                                 {std::int64_t{k} * 54'321, 0, 2048, 1}));
    }
    const std::string name = "source_" +
                             std::to_string(static_cast<int>(f.source)) + "_" +
                             Text(f.roughness);
    RecordProperty(name, Text(variogram.Hurst()));
    EXPECT_NEAR(variogram.Hurst(), f.recovered, 0.03) << name;
  }
}

// --- Creases ----------------------------------------------------------------

double CreasesOf(FractalSource source, double roughness) {
  SecondDifferences differences(8);
  for (int k = 0; k < kWindows; ++k) {
    const auto terrain = MakeTerrain(SpecOf(source, roughness, k));
    const Window window = WindowAt(k);
    differences.Add(FractalPatch(*terrain, 16, window), window.x, window.y);
  }
  return differences.LargestOverSmallest();
}

TEST_P(Roughness, OfSubdivisionLeavesNoCreases) {
  const double creases = CreasesOf(FractalSource::kSubdivision, GetParam());
  RecordProperty("creases", Text(creases));
  EXPECT_LE(creases, 1.5);
}

// The estimator sees the creases of plain midpoint displacement.
TEST_P(Roughness, OfMidpointLeavesTheCreasesItIsKnownFor) {
  const double creases = CreasesOf(FractalSource::kMidpoint, GetParam());
  RecordProperty("creases", Text(creases));
  // The page's figures: 1.31, 3.07 and 5.70 at 0.5, 0.8 and 0.95.
  const double known = GetParam() == 0.5    ? 1.31
                       : GetParam() == 0.65 ? 1.9
                       : GetParam() == 0.8  ? 3.07
                                            : 5.70;
  EXPECT_NEAR(creases, known, 0.06 * known);
}

// --- Variance ---------------------------------------------------------------

struct Spread {
  double variance = 0;
  double share_cut = 0;  // beyond sqrt(6) sigma
};

// Over single samples of many seeds, and so over independent worlds.
Spread SpreadOf(const TerrainSpec& like, int level) {
  Spread spread;
  constexpr int kWorlds = 4000;
  constexpr int kSamples = 25;
  for (int k = 0; k < kWorlds; ++k) {
    TerrainSpec spec = like;
    spec.seed = k;
    Window window = WindowAt(k);
    window.width = window.height = 5;
    const Patch patch = FractalPatch(*MakeTerrain(spec), level, window);
    for (const float value : patch.values) {
      const double p = static_cast<double>(value) / like.sigma.value_or(1);
      spread.variance += p * p / (kWorlds * kSamples);
      spread.share_cut += std::fabs(p) > std::sqrt(6) ? 1.0 / kWorlds / 25 : 0;
    }
  }
  return spread;
}

TEST_P(Roughness, OfMidpointKeepsTheVarianceBelowThreeHalves) {
  for (const int level : {0, 1, 4, 12, 24}) {
    const Spread spread =
        SpreadOf(SpecOf(FractalSource::kMidpoint, GetParam(), 0), level);
    EXPECT_LE(spread.variance, 1.5) << "level " << level;
    EXPECT_GT(spread.variance, 0.2) << "level " << level;
    // A cut at 2.45 deviations of the level-0 points loses one in seventy.
    EXPECT_LT(spread.share_cut, 0.02) << "level " << level;
    RecordProperty("variance_level_" + std::to_string(level),
                   Text(spread.variance));
    RecordProperty("share_cut_level_" + std::to_string(level),
                   std::to_string(spread.share_cut));
  }
}

TEST(Sigma, ScalesTheFractalAndNotTheHeights) {
  TerrainSpec spec = SpecOf(FractalSource::kSubdivision, 0.8, 3);
  const auto one = MakeTerrain(spec);
  spec.sigma = 4;
  const auto four = MakeTerrain(spec);
  const Window window = {5, 6, 32, 32};
  Patch fractal = FractalPatch(*one, 9, window);
  for (float& value : fractal.values) value *= 4;
  EXPECT_EQ(fractal.values, FractalPatch(*four, 9, window).values);
  EXPECT_EQ(HeightPatch(*one, 9, window).values,
            HeightPatch(*four, 9, window).values);
}

}  // namespace
}  // namespace terrane::core
