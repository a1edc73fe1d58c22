// What is wrong with a TerrainSpec: every violation in one pass, before
// anything is allocated. Named free functions without state; safe from any
// thread.
#ifndef TERRANE_CORE_TERRAIN_VALIDATE_H_
#define TERRANE_CORE_TERRAIN_VALIDATE_H_

#include <string>

#include "core/base/violations.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// Largest counts of a spec. The server publishes them (ServerLimits).
struct SpecLimits {
  int max_discrete_constraints = 10'000;
  int max_continuous_constraints = 10'000;
  int max_vertices = 100'000;
  int max_macro_parts = 1'000;
  int max_spots = 100'000;
  int max_inline_spots = 10'000;
};

// Adds a violation for each field outside its range, by its path in the recipe
// ("roughness", "macro.parts[2].cone.radius", "discrete_constraints[3].x",
// "continuous_constraints[0].target") after `prefix`.
void ValidateSpec(const TerrainSpec& spec, const SpecLimits& limits,
                  const std::string& prefix, Violations* violations);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_VALIDATE_H_
