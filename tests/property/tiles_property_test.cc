// A height is a function of its own place alone, to the bit: whatever the tile,
// the neighbour, the level it is seen from, the thread, the SIMD target, or
// what was generated before.
//
// Over random windows, levels 0 to 30, seeds, sources, mappings, macro shapes,
// refinements, discrete and continuous constraints, endless and bounded
// domains, lines and planes, and indices up to 2^50 (random_terrain.h).
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/terrain/terrain.h"
#include "hwy/targets.h"
#include "tests/property/random_terrain.h"

namespace terrane::core {
namespace {

// Cases a property runs over; fewer where a sanitizer makes each slower.
constexpr std::uint64_t kCases = 400 / TERRANE_REPETITION_DIVISOR;
constexpr std::int64_t kLargest = 48;

// Large enough for a window to be cut into several blocks inside.
constexpr std::uint64_t kLargeCases = 24 / TERRANE_REPETITION_DIVISOR;
constexpr std::int64_t kLargestOfLarge = 700;

using Heights = std::vector<float>;

Heights Generate(const Terrain& terrain, const TileRequest& request,
                 TileScratch* scratch) {
  Heights heights(
      static_cast<std::size_t>(request.window.width * request.window.height));
  const absl::Status status = terrain.Generate(request, {}, scratch, heights);
  EXPECT_TRUE(status.ok()) << status;
  return heights;
}

Heights Generate(const Terrain& terrain, const TileRequest& request) {
  TileScratch scratch;
  return Generate(terrain, request, &scratch);
}

bool IsNested(const TerrainSpec& spec) {
  return spec.source != FractalSource::kSuccessive;
}

// Sample (first_x + step i, first_y + step j) of `whole` must be (i, j) of
// `part`.
void ExpectPart(const Heights& whole, const Window& whole_window,
                const Heights& part, const Window& part_window,
                std::int64_t first_x, std::int64_t first_y, std::int64_t step) {
  std::int64_t different = 0;
  for (std::int64_t j = 0; j < part_window.height; ++j) {
    for (std::int64_t i = 0; i < part_window.width; ++i) {
      const float a = whole[static_cast<std::size_t>(
          (first_y + step * j) * whole_window.width + first_x + step * i)];
      const float b = part[static_cast<std::size_t>(j * part_window.width + i)];
      if (std::bit_cast<std::uint32_t>(a) != std::bit_cast<std::uint32_t>(b)) {
        ++different;
      }
    }
  }
  EXPECT_EQ(different, 0) << "of " << part.size() << " samples differ";
}

bool SameBits(const Heights& a, const Heights& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Runs `property` over the cases, each with its terrain, heights and own Draw.
struct Subject {
  const RandomCase& random;
  const Terrain& terrain;
  const Heights& heights;
  Draw* draw;
};
void ForEachCase(std::uint64_t first_seed, std::uint64_t count,
                 std::int64_t largest,
                 const std::function<void(const Subject&)>& property) {
  for (std::uint64_t k = 0; k < count; ++k) {
    const RandomCase random = MakeRandomCase(first_seed + k, largest);
    SCOPED_TRACE("case " + std::to_string(first_seed + k) + ": " +
                 random.Text());
    const auto terrain = Terrain::Create(random.spec);
    ASSERT_TRUE(terrain.ok()) << terrain.status();
    const Heights heights = Generate(**terrain, random.request);
    Draw draw(first_seed + k);
    property({random, **terrain, heights, &draw});
    if (testing::Test::HasFailure()) return;
  }
}

void ForEachCase(std::uint64_t first_seed,
                 const std::function<void(const Subject&)>& property) {
  ForEachCase(first_seed, kCases, kLargest, property);
  ForEachCase(first_seed + 1'000'000, kLargeCases, kLargestOfLarge, property);
}

// A random part of a window, in its own samples.
Window PickPart(const Window& whole, Draw* draw) {
  Window part;
  part.x = draw->Integer(0, whole.width - 1);
  part.y = draw->Integer(0, whole.height - 1);
  part.width = draw->Integer(1, whole.width - part.x);
  part.height = draw->Integer(1, whole.height - part.y);
  return part;
}

TileRequest Moved(TileRequest request, const Window& part) {
  request.window = {request.window.x + part.x, request.window.y + part.y,
                    part.width, part.height};
  return request;
}

// Strips that share their last and first column, or row.
std::vector<Window> OverlappingStrips(const Window& whole, Draw* draw) {
  const std::int64_t x = draw->Integer(0, whole.width - 1);
  const std::int64_t y = draw->Integer(0, whole.height - 1);
  return {{0, 0, x + 1, y + 1},
          {x, 0, whole.width - x, y + 1},
          {0, y, x + 1, whole.height - y},
          {x, y, whole.width - x, whole.height - y}};
}

// Tiles that cover the window, at most `size` samples a side.
std::vector<Window> Tiles(const Window& whole, std::int64_t size) {
  std::vector<Window> tiles;
  for (std::int64_t y = 0; y < whole.height; y += size) {
    for (std::int64_t x = 0; x < whole.width; x += size) {
      tiles.push_back({x, y, std::min(size, whole.width - x),
                       std::min(size, whole.height - y)});
    }
  }
  return tiles;
}

// --- What the cases are -----------------------------------------------------

TEST(RandomTerrain, ReachesEveryIngredient) {
  std::set<std::string> seen;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const RandomCase random = MakeRandomCase(seed, kLargest);
    const TerrainSpec& spec = random.spec;
    seen.insert("dimensions " + std::to_string(spec.dimensions));
    seen.insert("source " + std::to_string(static_cast<int>(spec.source)));
    seen.insert("mapping " + std::to_string(static_cast<int>(spec.mapping)));
    seen.insert(spec.domain ? "bounded" : "endless");
    if (spec.refinement) seen.insert("refinement");
    if (!spec.discrete_constraints.empty()) seen.insert("discrete");
    for (const ContinuousConstraint& c : spec.continuous_constraints) {
      seen.insert("constraint of kind " +
                  std::to_string(static_cast<int>(c.kind)) + " on " +
                  std::to_string(static_cast<int>(c.quantity)));
    }
    for (const MacroPart& part : spec.macro.parts) {
      seen.insert("shape " + std::to_string(part.shape.index()));
    }
    if (random.request.level == 30) seen.insert("level 30");
    if (random.request.window.x > std::int64_t{1} << 49) seen.insert("far");
    seen.insert(random.request.sampling == Sampling::kArea ? "area" : "point");
  }
  EXPECT_EQ(seen.size(), 2u + 3 + 2 + 2 + 1 + 1 + 3 * 2 + 8 + 1 + 1 + 2)
      << testing::PrintToString(seen);
}

// Constraints and shapes that changed nothing would prove nothing.
TEST(RandomTerrain, FeelsItsConstraintsAndItsMacroShape) {
  int constrained = 0;
  int felt = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCase random = MakeRandomCase(seed, kLargest);
    if (random.spec.continuous_constraints.empty() &&
        random.spec.discrete_constraints.empty()) {
      continue;
    }
    const auto with = Terrain::Create(random.spec);
    random.spec.continuous_constraints.clear();
    random.spec.discrete_constraints.clear();
    const auto without = Terrain::Create(random.spec);
    ASSERT_TRUE(with.ok() && without.ok());
    ++constrained;
    felt += SameBits(Generate(**with, random.request),
                     Generate(**without, random.request))
                ? 0
                : 1;
  }
  EXPECT_GT(constrained, 60);
  EXPECT_GT(felt, constrained * 3 / 5);
}

// --- Where a sample is seen from --------------------------------------------

TEST(Tiles, EqualTheSameCutOfALargerTile) {
  ForEachCase(1000, [](const Subject& s) {
    const Window part = PickPart(s.random.request.window, s.draw);
    const TileRequest request = Moved(s.random.request, part);
    ExpectPart(s.heights, s.random.request.window, Generate(s.terrain, request),
               request.window, part.x, part.y, 1);
  });
}

TEST(Tiles, AgreeWithTheirNeighboursOnSharedEdges) {
  ForEachCase(2000, [](const Subject& s) {
    const Window& whole = s.random.request.window;
    std::vector<Heights> tiles;
    const std::vector<Window> strips = OverlappingStrips(whole, s.draw);
    for (const Window& strip : strips) {
      tiles.push_back(Generate(s.terrain, Moved(s.random.request, strip)));
    }
    // Last column of the left ones and first of the right ones.
    for (const std::size_t left : {0u, 2u}) {
      const Window edge = {0, 0, 1, strips[left].height};
      Heights column;
      for (std::int64_t j = 0; j < edge.height; ++j) {
        column.push_back(tiles[left + 1][static_cast<std::size_t>(
            j * strips[left + 1].width)]);
      }
      ExpectPart(tiles[left], strips[left], column, edge,
                 strips[left].width - 1, 0, 1);
    }
    for (const std::size_t upper : {0u, 1u}) {
      const Window edge = {0, 0, strips[upper].width, 1};
      const Heights row(tiles[upper + 2].begin(),
                        tiles[upper + 2].begin() + edge.width);
      ExpectPart(tiles[upper], strips[upper], row, edge, 0,
                 strips[upper].height - 1, 1);
    }
  });
}

TEST(Tiles, OfACoarserLevelAreEverySecondSampleOfTheFiner) {
  ForEachCase(3000, [](const Subject& s) {
    if (!IsNested(s.random.spec)) return;
    TileRequest coarse = s.random.request;
    if (coarse.sampling == Sampling::kArea) return;
    const Window& w = coarse.window;
    const TileRequest fine = {
        coarse.level + 1,
        Sampling::kPoint,
        {2 * w.x, 2 * w.y, 2 * w.width - 1, 2 * w.height - 1}};
    ExpectPart(Generate(s.terrain, fine), fine.window, s.heights, w, 0, 0, 2);
  });
}

TEST(Tiles, OfAreaSamplesAreTheCentresOfTheFinerLevel) {
  ForEachCase(4000, [](const Subject& s) {
    if (!IsNested(s.random.spec)) return;
    if (s.random.request.sampling == Sampling::kPoint) return;
    const Window& w = s.random.request.window;
    const bool line = s.random.spec.dimensions == 1;
    const TileRequest fine = {s.random.request.level + 1,
                              Sampling::kPoint,
                              {2 * w.x + 1, line ? 0 : 2 * w.y + 1,
                               2 * w.width - 1, 2 * w.height - 1}};
    ExpectPart(Generate(s.terrain, fine), fine.window, s.heights, w, 0, 0, 2);
  });
}

// A level of a source that is not nested is another draw: the property above
// does not hold for want of looking.
TEST(Tiles, OfSuccessiveAdditionsAreNotNested) {
  TerrainSpec spec;
  spec.source = FractalSource::kSuccessive;
  const auto terrain = Terrain::Create(spec);
  ASSERT_TRUE(terrain.ok());
  const Heights coarse =
      Generate(**terrain, {4, Sampling::kPoint, {5, 6, 1, 1}});
  const Heights fine =
      Generate(**terrain, {5, Sampling::kPoint, {10, 12, 1, 1}});
  EXPECT_NE(coarse, fine);
}

// --- Who computes it --------------------------------------------------------

Heights GenerateByThreads(const Terrain& terrain, const TileRequest& request,
                          int threads) {
  const std::vector<Window> tiles = Tiles(request.window, 37);
  Heights whole(
      static_cast<std::size_t>(request.window.width * request.window.height));
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    TileScratch scratch;
    for (std::size_t k = next++; k < tiles.size(); k = next++) {
      const Window& tile = tiles[k];
      const Heights part = Generate(terrain, Moved(request, tile), &scratch);
      for (std::int64_t j = 0; j < tile.height; ++j) {
        std::copy_n(
            part.begin() + j * tile.width, tile.width,
            whole.begin() + (tile.y + j) * request.window.width + tile.x);
      }
    }
  };
  std::vector<std::jthread> workers;
  for (int t = 0; t < threads; ++t) workers.emplace_back(work);
  workers.clear();  // joins
  return whole;
}

TEST(Tiles, DoNotDependOnTheNumberOfThreads) {
  ForEachCase(5000, kLargeCases, 300, [](const Subject& s) {
    for (const int threads : {1, 2, 8}) {
      EXPECT_TRUE(SameBits(
          s.heights, GenerateByThreads(s.terrain, s.random.request, threads)))
          << threads << " threads";
    }
  });
}

TEST(Tiles, DoNotDependOnTheSimdTarget) {
  int targets = 0;
  ForEachCase(6000, kCases / 2, kLargest, [&](const Subject& s) {
    targets = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      EXPECT_TRUE(SameBits(s.heights, Generate(s.terrain, s.random.request)))
          << hwy::TargetName(target);
      ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  });
  EXPECT_GE(targets, 2);
  RecordProperty("simd_targets", targets);
}

TEST(Tiles, DoNotDependOnWhatTheScratchServedBefore) {
  TileScratch scratch;
  ForEachCase(7000, [&](const Subject& s) {
    EXPECT_TRUE(
        SameBits(s.heights, Generate(s.terrain, s.random.request, &scratch)));
  });
}

TEST(Tiles, AreTheScatteredHeightsOfTheirOwnPoints) {
  ForEachCase(8000, kCases / 2, kLargest, [](const Subject& s) {
    const TileRequest& request = s.random.request;
    if (s.random.spec.dimensions == 1 || request.sampling == Sampling::kArea ||
        std::abs(request.window.x) > std::int64_t{1} << 40 ||
        std::abs(request.window.y) > std::int64_t{1} << 40) {
      return;
    }
    SampleGrid grid;
    FillSampleGrid(*s.terrain.spec().frame, request.level, request.window.x,
                   request.window.y, 1, request.window.width,
                   request.window.height, &grid);
    std::vector<Point2> points;
    for (const double y : grid.y) {
      for (const double x : grid.x) points.push_back({x, y});
    }
    Heights at(points.size());
    TileScratch scratch;
    const absl::Status status =
        s.terrain.GenerateAt(request.level, points, {}, &scratch, at);
    ASSERT_TRUE(status.ok()) << status;
    EXPECT_TRUE(SameBits(s.heights, at));
  });
}

}  // namespace
}  // namespace terrane::core
