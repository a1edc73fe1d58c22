// Spot heights: met to the bit, everywhere they can be seen from; lines,
// discrete constraints, what is refused, and how a preparation is watched.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/violations.h"
#include "core/terrain/terrain.h"
#include "tests/property/spot_terrain.h"

namespace terrane::core {
namespace {

struct MetCase {
  FractalSource source;
  HeightMapping mapping;
  int dimensions;
  int count;
  bool bounded;
};

class SpotsAreMetTest : public ::testing::TestWithParam<MetCase> {};

TEST_P(SpotsAreMetTest, ToTheBitAtEveryLevelThatHoldsThem) {
  const MetCase& c = GetParam();
  TerrainSpec spec = SpotSpec(c.source, c.mapping, c.dimensions);
  const int spot_level = c.dimensions == 1 ? 10 : 7;
  AddSpots(c.count, spot_level, &spec);
  if (!c.bounded) spec.domain.reset();
  const auto terrain = MakeSpotTerrain(spec);
  EXPECT_EQ(terrain->spots()->spots, c.count);
  EXPECT_LT(terrain->spots()->largest_move, 1e-9);
  std::int64_t seen = 0;
  std::mt19937_64 engine(3);
  for (int level = 0; level <= spot_level + 6; ++level) {
    for (const SpotHeight& spot : *spec.spots.table) {
      const auto index = IndexAt(spec, spot, level);
      if (!index || (level > spot_level + 1 && engine() % 8 != 0)) continue;
      // A random small window around it, cut to the domain.
      const std::optional<Window> extent =
          terrain->Extent(level, Sampling::kPoint);
      Window window = {
          index->first - static_cast<std::int64_t>(engine() % 5),
          c.dimensions == 1
              ? 0
              : index->second - static_cast<std::int64_t>(engine() % 5),
          6, c.dimensions == 1 ? 1 : 6};
      if (extent) {
        window.x = std::max<std::int64_t>(window.x, 0);
        window.y = std::max<std::int64_t>(window.y, 0);
        window.width = std::min(window.width, extent->width - window.x);
        window.height = std::min(window.height, extent->height - window.y);
      }
      const std::vector<float> heights = Samples(*terrain, level, window);
      const float met = heights[static_cast<std::size_t>(
          (index->second - window.y) * window.width + index->first - window.x)];
      ASSERT_EQ(std::bit_cast<std::uint32_t>(met),
                std::bit_cast<std::uint32_t>(static_cast<float>(spot.height)))
          << "level " << level;
      ++seen;
    }
  }
  EXPECT_GE(seen, 2 * c.count);
}

// The pins do not hide a lattice that misses: P_fbm itself, which is not
// pinned, gives the height up to float arithmetic.
TEST(SpotHeightsTest, TheProcessItselfPassesThroughThem) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    for (const int dimensions : {1, 2}) {
      TerrainSpec spec = SpotSpec(source, HeightMapping::kLinear, dimensions);
      const int level = dimensions == 1 ? 10 : 7;
      AddSpots(60, level, &spec);
      const auto terrain = MakeSpotTerrain(spec);
      TileScratch scratch;
      for (const SpotHeight& spot : *spec.spots.table) {
        const auto index = IndexAt(spec, spot, level);
        float fractal = 0;
        ASSERT_TRUE(terrain
                        ->GenerateFractal({level,
                                           Sampling::kPoint,
                                           {index->first, index->second, 1, 1}},
                                          {}, &scratch, {&fractal, 1})
                        .ok());
        EXPECT_NEAR(spec.macro.base + 20 * static_cast<double>(fractal),
                    spot.height, 2e-4);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Spots, SpotsAreMetTest,
    ::testing::Values(
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 1,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 100,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 2, 100,
                false},
        MetCase{FractalSource::kSubdivision, HeightMapping::kBoltzmann, 2, 100,
                true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kLinear, 2, 100, true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kBoltzmann, 2, 100,
                false},
        MetCase{FractalSource::kSuccessive, HeightMapping::kLinear, 2, 100,
                true},
        MetCase{FractalSource::kSubdivision, HeightMapping::kLinear, 1, 60,
                true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kLinear, 1, 60, true},
        MetCase{FractalSource::kMidpoint, HeightMapping::kBoltzmann, 1, 60,
                false},
        MetCase{FractalSource::kSuccessive, HeightMapping::kLinear, 1, 60,
                true}));

TEST(SpotHeightsTest, AnAreaSampleThatIsASpotHasItsHeight) {
  TerrainSpec spec =
      SpotSpec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  spec.spots.points = {{{1000 + 64 * 1.25, 5000 - 64 * 0.75}, 300.25}};
  const auto terrain = MakeSpotTerrain(spec);
  EXPECT_EQ(terrain->spots()->level, 2);
  // (5, 3) of level 2 is the centre of cell (2, 1) of level 1.
  EXPECT_EQ(Samples(*terrain, 1, {2, 1, 1, 1}, Sampling::kArea)[0], 300.25f);
}

// Seams, nesting, a tile against the whole: bit for bit, however many spots.
class TilesWithSpotsTest : public ::testing::TestWithParam<int> {};

TEST_P(TilesWithSpotsTest, AgreeWithTheWholeAndWithTheFinerLevel) {
  TerrainSpec spec =
      SpotSpec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  spec.continuous_constraints.clear();
  constexpr int kLevel = 7;
  AddSpots(GetParam(), kLevel, &spec);
  const auto terrain = MakeSpotTerrain(spec);
  const Window all = *terrain->Extent(kLevel, Sampling::kPoint);
  const Window finer_all = *terrain->Extent(kLevel + 1, Sampling::kPoint);
  const std::vector<float> whole = Samples(*terrain, kLevel, all);
  const std::vector<float> finer = Samples(*terrain, kLevel + 1, finer_all);
  std::mt19937_64 engine(5);
  for (int k = 0; k < 60; ++k) {
    Window tile;
    tile.width = 2 + static_cast<std::int64_t>(engine() % 70);
    tile.height = 2 + static_cast<std::int64_t>(engine() % 70);
    tile.x = static_cast<std::int64_t>(
        engine() % static_cast<std::uint64_t>(all.width - tile.width + 1));
    tile.y = static_cast<std::int64_t>(
        engine() % static_cast<std::uint64_t>(all.height - tile.height + 1));
    const std::vector<float> heights = Samples(*terrain, kLevel, tile);
    int different = 0;
    for (std::int64_t j = 0; j < tile.height; ++j) {
      for (std::int64_t i = 0; i < tile.width; ++i) {
        const auto bits = std::bit_cast<std::uint32_t>(
            heights[static_cast<std::size_t>(j * tile.width + i)]);
        const auto at = [&](const std::vector<float>& of, const Window& window,
                            std::int64_t x, std::int64_t y) {
          return std::bit_cast<std::uint32_t>(
              of[static_cast<std::size_t>(y * window.width + x)]);
        };
        different += bits != at(whole, all, tile.x + i, tile.y + j);
        different +=
            bits != at(finer, finer_all, 2 * (tile.x + i), 2 * (tile.y + j));
      }
    }
    EXPECT_EQ(different, 0) << "tile " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Counts, TilesWithSpotsTest,
    ::testing::Values(1, 100, 10'000 / TERRANE_REPETITION_DIVISOR));

// A noisy height on the macro shape has no nugget under BOLTZMANN (the mapping
// is flat there), but it is noisy all the same: SUCCESSIVE goes on displacing
// it.
TEST(SpotHeightsTest, ANoisySpotOnTheMacroShapeMovesWithItsSource) {
  TerrainSpec spec;
  spec.source = FractalSource::kSuccessive;
  spec.mapping = HeightMapping::kBoltzmann;
  spec.fidelity = 1;
  spec.spots.level = 6;
  spec.spots.points = {{{0.5, 0.5}, 0, 0.1}, {{0.515625, 0.5}, 1, 0}};
  const auto terrain = MakeSpotTerrain(spec);
  TileScratch scratch;
  float fractal = 0;
  ASSERT_TRUE(terrain
                  ->GenerateFractal({6, Sampling::kPoint, {33, 32, 1, 1}}, {},
                                    &scratch, {&fractal, 1})
                  .ok());
  // Eq. 10 solved for P, at D - d = 1 and T = 1.
  EXPECT_NEAR(fractal, (std::sqrt(6.0) + 1e-3) * (1 - std::exp(-0.5)), 1e-5);
}

// --- Discrete constraints, lines, refinements -------------------------------

TEST(SpotHeightsTest, DiscreteConstraintsAreMetWithEverySource) {
  for (const FractalSource source :
       {FractalSource::kMidpoint, FractalSource::kSubdivision,
        FractalSource::kSuccessive}) {
    TerrainSpec spec = SpotSpec(source, HeightMapping::kLinear, 2);
    spec.macro.parts.push_back(
        {MacroCombine::kAdd, Plane{{1000, 5000}, 0, 0.37, -0.21}});
    spec.discrete_method = DiscreteMethod::kCondition;
    spec.discrete_constraints = {{.point = {1100, 4900}, .level = 5},
                                 {.point = {1200, 4850}, .level = 3}};
    const auto terrain = MakeSpotTerrain(spec);
    EXPECT_EQ(terrain->spots()->spots, 2);
    TileScratch scratch;
    for (const auto& [index, level] :
         {std::pair(std::pair(50, 50), 5), std::pair(std::pair(25, 19), 3)}) {
      const TileRequest request = {
          level, Sampling::kPoint, {index.first, index.second, 1, 1}};
      float macro = 0;
      ASSERT_TRUE(terrain->GenerateMacro(request, &scratch, {&macro, 1}).ok());
      EXPECT_EQ(Samples(*terrain, level, request.window)[0], macro);
      EXPECT_EQ(Samples(*terrain, level + 4,
                        {16 * index.first, 16 * index.second, 1, 1})[0],
                macro);
    }
  }
}

TEST(SpotHeightsTest, ARiverOnlyFalls) {
  TerrainSpec spec =
      SpotSpec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  SpotLine river;
  river.vertices = {{1010, 4990}, {1100, 4930}, {1180, 4840}};
  river.only_falls = true;
  // Over a macro shape that rises on the way.
  spec.macro.parts.push_back(
      {MacroCombine::kAdd, GaussianHill{{1100, 4930}, 30, 30, 80}});
  spec.spots.lines = {river};
  spec.spots.level = 6;
  const auto terrain = MakeSpotTerrain(spec);
  EXPECT_GT(terrain->spots()->spots, 150);
  float last = std::numeric_limits<float>::infinity();
  int falls = 0;
  for (int leg = 0; leg < 2; ++leg) {
    const Point2& a = river.vertices[static_cast<std::size_t>(leg)];
    const Point2& b = river.vertices[static_cast<std::size_t>(leg) + 1];
    const int steps =
        static_cast<int>(std::ceil(std::hypot(b.x - a.x, b.y - a.y)));
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      const auto x = static_cast<std::int64_t>(
          std::nearbyint(a.x + t * (b.x - a.x) - 1000));
      const auto y = static_cast<std::int64_t>(
          std::nearbyint(5000 - (a.y + t * (b.y - a.y))));
      const float height = Samples(*terrain, 6, {x, y, 1, 1})[0];
      EXPECT_LE(height, last);
      falls += height < last ? 1 : 0;
      last = height;
    }
  }
  EXPECT_GT(falls, 10);
}

// --- What is refused --------------------------------------------------------

std::string Refusal(const TerrainSpec& spec) {
  const auto terrain = Terrain::Create(spec);
  return terrain.ok() ? "" : std::string(terrain.status().message());
}

TEST(SpotHeightsTest, ErrorsNameTheRows) {
  const TerrainSpec good =
      SpotSpec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  const auto with = [&](std::vector<SpotHeight> points) {
    TerrainSpec spec = good;
    spec.spots.points = std::move(points);
    return spec;
  };
  TerrainSpec spec = with({{{1001, 4999}, 300}, {{1001, 4999}, 301}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[1]"));
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0]"));
  spec = with({{{1001, 4999}, 300}, {{1001, 4999}, 300}});
  EXPECT_EQ(MakeSpotTerrain(spec)->spots()->merged, 1);

  spec = with({{{999, 4999}, 300}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0].x"));
  spec = with({{{1001, 4999}, std::nan("")}});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.points[0].height"));
  spec = with({{{1001, 4999}, 300}});
  spec.fidelity = 0;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("fidelity T is 0"));
  spec.spots.points[0].height = 312.5;
  EXPECT_EQ(Refusal(spec), "");
  spec = with({{{1001, 4999}, 312.5 + 100}});
  spec.mapping = HeightMapping::kBoltzmann;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("what the mapping reaches"));
  spec = with({{{1001, 4999}, 300}});
  spec.soft_limit = 5;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("what the mapping reaches"));
  spec = good;
  spec.spots.points.resize(10'001, {{1001, 4999}, 300});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("at most 10000"));
  spec = good;
  spec.spots.table = std::make_shared<std::vector<SpotHeight>>(
      100'001, SpotHeight{{1001, 4999}, 300, 0});
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.table"));
  spec = good;
  spec.spots.lines = {{{{1001, 4999}, {1200, 4900}}, {300, 310}, 0, 0, true}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("spots.lines[0].heights[1]"));
  spec.spots.lines = {
      {{{1001, 4999}, {1200, 4900}}, {300, 290}, 1e-9, 0, true}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("at most 100000"));
  spec = with({{{1001, 4999}, 300}});
  spec.source = FractalSource::kMidpoint;
  spec.discrete_method = DiscreteMethod::kBuffer;
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("discrete_method"));
}

TEST(SpotHeightsTest, PointsTooCloseForTheirHeightsAreRefused) {
  // One sample apart at level 30, 100 m of difference, on nearly smooth ground.
  TerrainSpec spec;
  spec.roughness = 0.99;
  spec.spots.level = 30;
  spec.spots.points = {{{0.5, 0.5}, 0}, {{0.5 + 0x1p-30, 0.5}, 100}};
  EXPECT_THAT(Refusal(spec), ::testing::HasSubstr("too close together"));
}

TEST(SpotHeightsTest, PreparationTellsHowFarItIsAndCanBeStopped) {
  TerrainSpec spec =
      SpotSpec(FractalSource::kSubdivision, HeightMapping::kLinear, 2);
  AddSpots(500, 7, &spec);
  double last = 0;
  int calls = 0;
  Preparation watched;
  watched.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    ++calls;
  };
  ASSERT_TRUE(Terrain::Create(spec, watched).ok());
  EXPECT_GT(calls, 20);
  EXPECT_GT(last, 0.9);

  // Stopped at each stage, it ends there.
  for (const double at : {0.05, 0.5, 0.95}) {
    std::stop_source stop;
    Preparation ended;
    ended.stop = stop.get_token();
    ended.progress = [&](double fraction) {
      if (fraction >= at) stop.request_stop();
    };
    EXPECT_EQ(Terrain::Create(spec, ended).status().code(),
              absl::StatusCode::kCancelled);
  }
}

}  // namespace
}  // namespace terrane::core
