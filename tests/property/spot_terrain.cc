#include "tests/property/spot_terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace terrane::core {
TerrainSpec SpotSpec(FractalSource source, HeightMapping mapping,
                     int dimensions) {
  TerrainSpec spec;
  spec.dimensions = dimensions;
  spec.seed = 11;
  spec.source = source;
  spec.mapping = mapping;
  spec.fidelity = 400;
  spec.roughness = 0.75;
  spec.domain = Domain{4, 3};
  spec.frame = Frame{1000, 5000, 64, -64};
  spec.macro.base = 312.5;
  ContinuousConstraint rough;
  rough.quantity = ConstraintQuantity::kRoughness;
  rough.target = 0.95;
  rough.reach = 90;
  rough.vertices = {{1100, 4950}};
  spec.continuous_constraints.push_back(rough);
  return spec;
}

void AddSpots(int count, int level, TerrainSpec* spec) {
  std::mt19937_64 engine(7);
  std::set<std::pair<std::int64_t, std::int64_t>> taken;
  auto table = std::make_shared<std::vector<SpotHeight>>();
  const auto draw = [&](std::int64_t most) {
    return static_cast<std::int64_t>(engine() %
                                     static_cast<std::uint64_t>(most + 1));
  };
  while (table->size() < static_cast<std::size_t>(count)) {
    const std::int64_t x = draw(spec->domain->cells_x << level);
    const std::int64_t y =
        spec->dimensions == 1 ? 0 : draw(spec->domain->cells_y << level);
    if (!taken.insert({x, y}).second) continue;
    SpotHeight spot;
    spot.point = {
        spec->frame->origin_x +
            std::ldexp(static_cast<double>(x), -level) * spec->frame->spacing_x,
        spec->frame->origin_y + std::ldexp(static_cast<double>(y), -level) *
                                    spec->frame->spacing_y};
    spot.height = spec->macro.base + static_cast<double>(draw(4000)) / 100 - 20;
    table->push_back(spot);
  }
  spec->spots.table = std::move(table);
  spec->spots.level = level;
}

std::shared_ptr<const Terrain> MakeSpotTerrain(const TerrainSpec& spec) {
  auto terrain = Terrain::Create(spec);
  EXPECT_TRUE(terrain.ok()) << terrain.status();
  return *terrain;
}

std::vector<float> Samples(const Terrain& terrain, int level,
                           const Window& window, Sampling sampling) {
  std::vector<float> heights(
      static_cast<std::size_t>(window.width * window.height));
  TileScratch scratch;
  const absl::Status status =
      terrain.Generate({level, sampling, window}, {}, &scratch, heights);
  EXPECT_TRUE(status.ok()) << status;
  return heights;
}

std::optional<std::pair<std::int64_t, std::int64_t>> IndexAt(
    const TerrainSpec& spec, const SpotHeight& spot, int level) {
  const double x = std::ldexp(
      (spot.point.x - spec.frame->origin_x) / spec.frame->spacing_x, level);
  const double y = spec.dimensions == 1
                       ? 0
                       : std::ldexp((spot.point.y - spec.frame->origin_y) /
                                        spec.frame->spacing_y,
                                    level);
  if (x != std::floor(x) || y != std::floor(y)) return std::nullopt;
  return std::pair(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
}

}  // namespace terrane::core
