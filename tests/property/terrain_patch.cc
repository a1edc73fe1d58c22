#include "tests/property/terrain_patch.h"

#include <stdexcept>
#include <string>

namespace terrane::core {
namespace {

Patch MakePatch(const Window& window) {
  return {window.width, window.height,
          std::vector<float>(
              static_cast<std::size_t>(window.width * window.height))};
}

void Require(const absl::Status& status) {
  if (!status.ok()) throw std::runtime_error(std::string(status.message()));
}

}  // namespace

std::shared_ptr<const Terrain> MakeTerrain(const TerrainSpec& spec) {
  absl::StatusOr<std::shared_ptr<const Terrain>> terrain =
      Terrain::Create(spec);
  Require(terrain.status());
  return *std::move(terrain);
}

Patch HeightPatch(const Terrain& terrain, int level, const Window& window) {
  Patch patch = MakePatch(window);
  TileScratch scratch;
  Require(terrain.Generate({level, Sampling::kPoint, window}, {}, &scratch,
                           patch.values));
  return patch;
}

Patch MacroPatch(const Terrain& terrain, int level, const Window& window) {
  Patch patch = MakePatch(window);
  TileScratch scratch;
  Require(terrain.GenerateMacro({level, Sampling::kPoint, window}, &scratch,
                                patch.values));
  return patch;
}

Patch FractalPatch(const Terrain& terrain, int level, const Window& window) {
  Patch patch = MakePatch(window);
  TileScratch scratch;
  Require(terrain.GenerateFractal({level, Sampling::kPoint, window}, {},
                                  &scratch, patch.values));
  return patch;
}

}  // namespace terrane::core
