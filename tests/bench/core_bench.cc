// Nanoseconds a sample of generated tiles, next to two yardsticks of the same
// run: one normal draw a sample (the hash bound) and memset.
//
// Every bench sets items_per_second to samples a second and ns_per_sample;
// run.sh prints ratios. Tiles move on with every iteration, so nothing is
// cached but code. README.md says how to run.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/simd_target.h"
#include "core/noise/counter_hash.h"
#include "core/terrain/terrain.h"
#include "tests/bench/bounds.h"

namespace terrane::core {
namespace {

void ReportSamples(benchmark::State& state, std::int64_t samples) {
  state.SetItemsProcessed(state.iterations() * samples);
  state.counters["ns_per_sample"] =
      benchmark::Counter(static_cast<double>(samples) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate |
                             benchmark::Counter::kInvert);
}

// --- Yardsticks ---

void Memset(benchmark::State& state, std::int64_t side) {
  std::vector<float> out(static_cast<std::size_t>(side * side));
  for (auto _ : state) {
    std::memset(out.data(), 0, out.size() * sizeof(float));
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  ReportSamples(state, side * side);
}

void HashBound(benchmark::State& state, std::int64_t side) {
  std::vector<float> out(static_cast<std::size_t>(side * side));
  std::vector<std::uint32_t> words;
  for (std::int64_t i = 0; i < side; ++i) words.push_back(ColumnWord(i));
  std::int64_t seed = 0;
  for (auto _ : state) {
    DrawNormals(++seed, words, side, &out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  ReportSamples(state, side * side);
}

// --- Tiles ---

// A square tile about the origin of the world, and the spec to take it from.
void Tile(benchmark::State& state, const TerrainSpec& spec, int level,
          std::int64_t side) {
  const auto terrain = Terrain::Create(spec);
  if (!terrain.ok()) {
    state.SkipWithError(terrain.status().ToString().c_str());
    return;
  }
  TileScratch scratch;
  std::vector<float> out(static_cast<std::size_t>(side * side));
  const std::optional<Window> extent =
      (*terrain)->Extent(level, Sampling::kPoint);
  std::int64_t tile = 0;
  for (auto _ : state) {
    // Eight tiles in a row, again and again.
    const std::int64_t x = tile++ % 8 * side;
    const Window window =
        extent ? Window{x % (extent->width - side), 0, side, side}
               : Window{x - 4 * side, -side / 2, side, side};
    const absl::Status status = (*terrain)->Generate(
        {level, Sampling::kPoint, window}, {}, &scratch, out);
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  ReportSamples(state, side * side);
}

TerrainSpec SpecOf(FractalSource source, HeightMapping mapping) {
  TerrainSpec spec;
  spec.source = source;
  spec.mapping = mapping;
  spec.macro.base = 100;
  return spec;
}

// `count` places scattered evenly about the origin, over `tiles` tiles a side.
std::vector<Point2> Scatter(int count, double tile_side, double tiles) {
  std::vector<Point2> points;
  for (int k = 0; k < count; ++k) {
    const auto share = [&](double ratio) {
      const double at = k * ratio;
      return at - std::floor(at) - 0.5;
    };
    points.push_back({share(0.754877666) * tiles * tile_side,
                      share(0.569840291) * tiles * tile_side});
  }
  return points;
}

constexpr double kTilesAround = 10;

// Sources of H and T, half each, whose reaches hold about four sources of each
// at every sample when there are many.
TerrainSpec WithContinuous(TerrainSpec spec, int count, int level,
                           std::int64_t side) {
  const double tile_side = std::ldexp(static_cast<double>(side), -level);
  const double reach =
      kTilesAround * tile_side * std::sqrt(4.0 / std::max(count, 10));
  for (const Point2& point : Scatter(count, tile_side, kTilesAround)) {
    const bool roughness = spec.continuous_constraints.size() % 2 == 0;
    spec.continuous_constraints.push_back({roughness
                                               ? ConstraintQuantity::kRoughness
                                               : ConstraintQuantity::kFidelity,
                                           roughness ? 0.9 : 0.2,
                                           0,
                                           reach,
                                           DistanceNorm::kL1,
                                           ReachEdge::kStep,
                                           SourceKind::kPoint,
                                           {point}});
  }
  return spec;
}

TerrainSpec WithDiscrete(TerrainSpec spec, int count, int level,
                         std::int64_t side) {
  const double tile_side = std::ldexp(static_cast<double>(side), -level);
  for (const Point2& point : Scatter(count, tile_side, kTilesAround)) {
    spec.discrete_constraints.push_back({point, level - 1, {}});
  }
  return spec;
}

// Spot heights on the lattice of `level`: `count` over the eight tiles of Tile,
// or, moved down by `tiles_below`, as many beside them.
TerrainSpec WithSpots(TerrainSpec spec, int count, int level, std::int64_t side,
                      double tiles_below) {
  const double tile_side = std::ldexp(static_cast<double>(side), -level);
  spec.spots.level = level;
  std::set<std::pair<double, double>> taken;
  for (const Point2& share : Scatter(count, 1, 1)) {
    const auto snap = [&](double place) {
      return std::ldexp(std::nearbyint(std::ldexp(place * tile_side, level)),
                        -level);
    };
    const Point2 point = {snap(share.x * 8), snap(share.y + tiles_below)};
    if (!taken.insert({point.x, point.y}).second) continue;
    // As far from the macro shape as ground of that size goes.
    const double height = spec.macro.base + tile_side * std::sin(share.x * 900);
    spec.spots.points.push_back({point, height});
  }
  return spec;
}

// `count` spots over 16 x 16 cells, snapped to `level`: preparation alone.
void PrepareSpots(benchmark::State& state, int count, int level) {
  TerrainSpec spec;
  spec.domain = Domain{16, 16};
  auto table = std::make_shared<std::vector<SpotHeight>>();
  for (const Point2& share : Scatter(count, 1, 1)) {
    table->push_back(
        {{(share.x + 0.5) * 16, (share.y + 0.5) * 16}, std::sin(share.x * 40)});
  }
  spec.spots.table = std::move(table);
  spec.spots.level = level;
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const auto terrain = Terrain::Create(spec);
    if (!terrain.ok()) {
      state.SkipWithError(terrain.status().ToString().c_str());
      return;
    }
    bytes = (*terrain)->MemoryBytes();
  }
  state.SetItemsProcessed(state.iterations() * count);
  state.counters["table_bytes_per_spot"] =
      static_cast<double>(bytes) / static_cast<double>(count);
}

TerrainSpec Refined() {
  auto raster = std::make_shared<Raster>();
  raster->width = 400;
  raster->height = 300;
  raster->frame = {0, 0, 90, -90};
  for (int k = 0; k < 400 * 300; ++k) {
    raster->values.push_back(static_cast<float>(
        300 + 100 * std::sin(k % 400 * 0.1) * std::cos(k / 400 * 0.07) +
        Mix32(static_cast<std::uint32_t>(k)) % 16));
  }
  TerrainSpec spec;
  spec.refinement = Refinement{};
  spec.macro.parts.emplace_back().shape.emplace<RasterShape>().raster = raster;
  return spec;
}

// --- The list ---------------------------------------------------------------

constexpr std::int64_t kSides[] = {64, 256, 1024};
constexpr int kLevels[] = {8, 20, 30};

struct Chain {
  const char* name;
  FractalSource source;
  HeightMapping mapping;
};
constexpr Chain kChains[] = {
    {"midpoint_linear", FractalSource::kMidpoint, HeightMapping::kLinear},
    {"midpoint_boltzmann", FractalSource::kMidpoint, HeightMapping::kBoltzmann},
    {"successive_linear", FractalSource::kSuccessive, HeightMapping::kLinear},
    {"subdivision_linear", FractalSource::kSubdivision, HeightMapping::kLinear},
    {"subdivision_boltzmann", FractalSource::kSubdivision,
     HeightMapping::kBoltzmann},
};

std::string TileName(const std::string& what, std::int64_t side, int level) {
  return "tile/" + what + "/side:" + std::to_string(side) +
         "/level:" + std::to_string(level);
}

void RegisterTile(const std::string& what, TerrainSpec spec, int level,
                  std::int64_t side) {
  benchmark::RegisterBenchmark(
      TileName(what, side, level).c_str(),
      [spec = std::move(spec), level, side](benchmark::State& state) {
        Tile(state, spec, level, side);
      });
}

void RegisterChains() {
  for (const Chain& chain : kChains) {
    for (const std::int64_t side : kSides) {
      for (const int level : kLevels) {
        RegisterTile(chain.name, SpecOf(chain.source, chain.mapping), level,
                     side);
      }
    }
  }
}

void RegisterConstraints() {
  const TerrainSpec subdivision =
      SpecOf(FractalSource::kSubdivision, HeightMapping::kLinear);
  const TerrainSpec midpoint =
      SpecOf(FractalSource::kMidpoint, HeightMapping::kBoltzmann);
  for (const int count : {10, 10'000}) {
    for (const std::int64_t side : kSides) {
      for (const int level : kLevels) {
        RegisterTile("subdivision_linear_continuous_" + std::to_string(count),
                     WithContinuous(subdivision, count, level, side), level,
                     side);
        RegisterTile("midpoint_boltzmann_discrete_" + std::to_string(count),
                     WithDiscrete(midpoint, count, level, side), level, side);
      }
    }
  }
}

void RegisterSpots() {
  const TerrainSpec bare =
      SpecOf(FractalSource::kSubdivision, HeightMapping::kLinear);
  constexpr std::int64_t kSide = 256;
  constexpr int kLevel = 20;
  RegisterTile("spots_none", bare, kLevel, kSide);
  RegisterTile("spots_100_beside", WithSpots(bare, 800, kLevel, kSide, 100),
               kLevel, kSide);
  RegisterTile("spots_1_inside", WithSpots(bare, 8, kLevel, kSide, 0), kLevel,
               kSide);
  RegisterTile("spots_100_inside", WithSpots(bare, 800, kLevel, kSide, 0),
               kLevel, kSide);
  for (const int count : {100, 10'000, 100'000}) {
    benchmark::RegisterBenchmark(
        ("prepare/spots:" + std::to_string(count) + "/level:12").c_str(),
        [count](benchmark::State& state) { PrepareSpots(state, count, 12); })
        ->Unit(benchmark::kMillisecond);
  }
}

void RegisterRefinement() {
  for (const std::int64_t side : kSides) {
    for (const int level : {3, 8, 20}) {
      RegisterTile("refinement", Refined(), level, side);
    }
  }
}

void RegisterAll() {
  for (const std::int64_t side : kSides) {
    const std::string suffix = "/side:" + std::to_string(side);
    benchmark::RegisterBenchmark(("bound/memset" + suffix).c_str(), Memset,
                                 side);
    benchmark::RegisterBenchmark(("bound/hash" + suffix).c_str(), HashBound,
                                 side);
  }
  RegisterChains();
  RegisterConstraints();
  RegisterSpots();
  RegisterRefinement();
}

}  // namespace
}  // namespace terrane::core

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::AddCustomContext("simd_target", terrane::core::SimdTargetName());
  terrane::core::RegisterAll();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
