// What is wrong with a TreeSpec: every violation in one pass, before anything
// is allocated. Named free functions without state; safe from any thread.
#ifndef TERRANE_CORE_TREE_VALIDATE_H_
#define TERRANE_CORE_TREE_VALIDATE_H_

#include <cstdint>
#include <string>

#include "core/base/violations.h"
#include "core/tree/tree_spec.h"

namespace terrane::core {

inline constexpr int kMaxTreeDepth = 32;
inline constexpr int kMaxPopulation = 64;
inline constexpr int kMaxPieces = 16;

// Largest sizes of a tree. A server publishes them.
struct TreeLimits {
  // Rows, and the bytes of their columns.
  std::int64_t max_segments = 10'000'000;
  std::int64_t max_bytes = std::int64_t{1} << 30;
};

// Adds a violation for each field outside its range, by its path in the recipe
// ("depth", "genetic.left_share") after `prefix`; and, when all fields are
// well, for a tree that could be larger than the limits.
void ValidateTreeSpec(const TreeSpec& spec, const TreeLimits& limits,
                      const std::string& prefix, Violations* violations);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_VALIDATE_H_
