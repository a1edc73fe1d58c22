// How far a terrain can go from its macro shape, and which heights it is likely
// to have. Pure functions of a resolved spec; no tile is generated.
#ifndef TERRANE_CORE_TERRAIN_TERRAIN_BOUNDS_H_
#define TERRANE_CORE_TERRAIN_TERRAIN_BOUNDS_H_

#include <optional>

#include "core/terrain/constraint_field.h"
#include "core/terrain/height_range.h"
#include "core/terrain/macro_shape.h"
#include "core/terrain/resolve.h"

namespace terrane::core {

// Largest possible |D - d|; nothing when the mapping has no bound.
std::optional<double> LargestDeviationOf(const TerrainSpec& spec,
                                         const ConstraintField& fidelity);

// A range that holds every height where there is a bound, all but about one in
// 10^8 otherwise. `largest_spot_deviation`: of the spot heights from the macro
// shape, 0 without any.
HeightRange LikelyHeights(const ResolvedSpec& resolved, const MacroShape& macro,
                          const ConstraintField& fidelity,
                          double largest_spot_deviation);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_TERRAIN_BOUNDS_H_
