// What a tree costs, before any work: bounds from the spec alone, in checked
// arithmetic (a product beyond 2^63 - 1 stays there).
//
// Pure functions of a spec whose fields are in their ranges; safe from any
// thread.
#ifndef TERRANE_CORE_TREE_ESTIMATE_H_
#define TERRANE_CORE_TREE_ESTIMATE_H_

#include <cstdint>

#include "core/tree/tree_spec.h"

namespace terrane::core {

struct TreeEstimate {
  // Rows at most; exact for plain trees and Cantor sets.
  std::int64_t segments_most = 0;
  // Of their columns.
  std::int64_t bytes_most = 0;
  // Of the generator's queue, populations included.
  std::int64_t queue_bytes_most = 0;
  // The last generation that can have rows: `depth`, or less where lengths end
  // by themselves.
  int last_generation = 0;
};

TreeEstimate EstimateTree(const TreeSpec& spec);

// Children that a branch has at most.
int MostChildren(const TreeSpec& spec);

// Bytes of the generator's queue for each branch that waits in it.
std::int64_t QueueBytesOfBranch(const TreeSpec& spec);

// The chromosome that the trunk has.
std::uint32_t TrunkChromosome(const TreeSpec& spec);

// The largest length code of a child: floor(0.7 * code).
constexpr std::uint32_t LargestChildLength(std::uint32_t code) {
  return code * 7 / 10;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_ESTIMATE_H_
