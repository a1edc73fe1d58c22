// Filling in what a spec leaves open.
#ifndef TERRANE_CORE_TERRAIN_RESOLVE_H_
#define TERRANE_CORE_TERRAIN_RESOLVE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

struct ResolvedSpec {
  // Every optional is set, but for soft_limit and an endless domain.
  TerrainSpec spec;
  // A refinement's relative amplitude at the model's posts; empty without one,
  // or when it is uniform.
  std::vector<float> amplitude;
};

// `spec` must be valid. Defaults as in proto/terrane/v1/terrain_recipe.proto; a
// refinement takes domain and frame from its raster, H and T from its
// calibration. Errors: as CalibrateRefinement.
absl::StatusOr<ResolvedSpec> Resolve(TerrainSpec spec);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_RESOLVE_H_
