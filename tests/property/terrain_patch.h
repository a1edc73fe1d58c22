// Windows of a terrain for the estimators. A failure to create or to generate
// fails the test and ends it.
#ifndef TERRANE_TESTS_PROPERTY_TERRAIN_PATCH_H_
#define TERRANE_TESTS_PROPERTY_TERRAIN_PATCH_H_

#include <memory>

#include "core/terrain/terrain.h"
#include "tests/property/estimators.h"

namespace terrane::core {

std::shared_ptr<const Terrain> MakeTerrain(const TerrainSpec& spec);

// POINT samples of D, of d and of P_fbm.
Patch HeightPatch(const Terrain& terrain, int level, const Window& window);
Patch MacroPatch(const Terrain& terrain, int level, const Window& window);
Patch FractalPatch(const Terrain& terrain, int level, const Window& window);

}  // namespace terrane::core

#endif  // TERRANE_TESTS_PROPERTY_TERRAIN_PATCH_H_
