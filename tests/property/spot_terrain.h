// Terrains with spot heights for the property tests.
#ifndef TERRANE_TESTS_PROPERTY_SPOT_TERRAIN_H_
#define TERRANE_TESTS_PROPERTY_SPOT_TERRAIN_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/terrain/terrain.h"

namespace terrane::core {

// A bounded world with a rough corner, far from the origin.
TerrainSpec SpotSpec(FractalSource source, HeightMapping mapping,
                     int dimensions);

// `count` distinct lattice points of `level` with heights around the macro
// shape.
void AddSpots(int count, int level, TerrainSpec* spec);

// A failure to create or to generate fails the test.
std::shared_ptr<const Terrain> MakeSpotTerrain(const TerrainSpec& spec);
std::vector<float> Samples(const Terrain& terrain, int level,
                           const Window& window,
                           Sampling sampling = Sampling::kPoint);

// The spot's index at a level, if that level's lattice holds it.
std::optional<std::pair<std::int64_t, std::int64_t>> IndexAt(
    const TerrainSpec& spec, const SpotHeight& spot, int level);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_PROPERTY_SPOT_TERRAIN_H_
