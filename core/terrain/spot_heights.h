// Spot heights on the lattice: every height that is to be met, from points,
// tables, lines and conditioned discrete constraints, snapped, merged and
// turned into values of P_fbm.
//
// Where several rows fall on one lattice point: equal exact heights are one; an
// exact height stands against noisy ones; noisy ones are averaged, weighted by
// their precision; a line yields to a point, and to a line before it.
//
// Threads: pure functions. Determinism: no libm; a spot depends on the spec
// alone.
#ifndef TERRANE_CORE_TERRAIN_SPOT_HEIGHTS_H_
#define TERRANE_CORE_TERRAIN_SPOT_HEIGHTS_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/terrain/constraint_field.h"
#include "core/terrain/discrete_constraints.h"
#include "core/terrain/height_inverse.h"
#include "core/terrain/macro_shape.h"
#include "core/terrain/preparation.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// Finest level that spots can snap to.
inline constexpr int kMaxSpotLevel = 30;

// Where a spot comes from.
struct SpotRow {
  enum class Kind { kPoint, kTable, kDiscrete, kLine };
  Kind kind = Kind::kPoint;
  std::size_t index = 0;

  // Its path in the recipe, such as "spots.table[17]".
  std::string Path() const;
};

// A lattice point, by the level where it first appears, and its height.
struct Spot {
  int level = 0;
  LatticePoint point;
  double u = 0, v = 0;  // place in level-0 units, exact
  SpotRow row;
  double height = 0;
  double standard_error = 0;  // 0: met exactly
  // P_fbm there for sigma = 1, and the variance of the observation.
  double fractal = 0;
  double nugget = 0;
};

struct SnappedSpots {
  std::vector<Spot> spots;
  SpotReport report;
  double largest_deviation = 0;  // |height - macro shape|
};

// Whether the discrete constraints of a spec are conditioned, as spots are:
// asked for, or the default for every source but MIDPOINT and beside spots.
bool ConditionsDiscrete(const TerrainSpec& spec);

// The raster that a spec's refinement refines; null without one.
const Raster* RefinedRaster(const TerrainSpec& spec);

// The spec's frame, or that of the raster it refines.
Frame FrameOf(const TerrainSpec& spec);

// The level that spots snap to when the spec does not say: the coarsest one
// that holds every point, table row and vertex, 12 when none up to it does.
int DefaultSpotLevel(const SpotHeights& spots, const Frame& frame,
                     int dimensions);

// Samples that the lines make at a level, before merging; stops counting beyond
// `most`.
std::size_t CountLineSamples(const SpotHeights& spots, const Frame& frame,
                             int level, int dimensions, std::size_t most);

// All spots of a resolved spec (every row's coordinates are valid), those of
// its discrete constraints included when they are conditioned. Errors:
// violations that name the rows (proto/terrane/v1/terrain_recipe.proto,
// SpotHeights).
absl::StatusOr<SnappedSpots> SnapSpots(const TerrainSpec& spec,
                                       const MacroShape& macro,
                                       const ConstraintField& fidelity,
                                       const HeightMap& map);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_SPOT_HEIGHTS_H_
