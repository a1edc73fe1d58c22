// What is wrong with a FlowerSpec: every violation in one pass, before anything
// is allocated. Named free functions without state; safe from any thread.
#ifndef TERRANE_CORE_FLOWER_VALIDATE_FLOWER_H_
#define TERRANE_CORE_FLOWER_VALIDATE_FLOWER_H_

#include <cstdint>
#include <string>

#include "core/base/violations.h"
#include "core/flower/flower_spec.h"

namespace terrane::core {

// Largest sizes of a flower. A server publishes them.
struct FlowerLimits {
  // Bytes of the prototypes' columns, which are in memory together.
  std::int64_t max_prototype_bytes = std::int64_t{256} << 20;
  // Rows of the bed, which are not.
  std::int64_t max_instances = 100'000'000;
};

// Adds a violation for each field outside its range, by its path in the recipe
// ("petals[0].count", "petals[0].blade.sketches[1].points") after `prefix`;
// for sketches that fold back or cross their axis; and, when all fields are
// well, for a flower that is larger than the limits.
void ValidateFlowerSpec(const FlowerSpec& spec, const FlowerLimits& limits,
                        const std::string& prefix, Violations* violations);

}  // namespace terrane::core

#endif  // TERRANE_CORE_FLOWER_VALIDATE_FLOWER_H_
