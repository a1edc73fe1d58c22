// What the rules of growth pass to the generator: a branch that waits in the
// queue, and the plan of its children. Plain data.
#ifndef TERRANE_CORE_TREE_BRANCH_H_
#define TERRANE_CORE_TREE_BRANCH_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/mesh/float3.h"
#include "core/tree/chromosome.h"
#include "core/tree/turn_table.h"

namespace terrane::core {

// A direction with a right-hand side: unit vectors at a right angle.
struct Pose {
  Float3 direction;
  Float3 right;
};

struct Branch {
  std::uint64_t key = 0;
  Float3 start;
  Pose pose;
  float length = 0;
  // radius^Delta at the base, as a share of the trunk's.
  float pipes = 0;
  float attach = 0;
  std::uint32_t parent_row = 0;
  std::uint32_t chromosome = 0;
  std::uint32_t extension = 0;
  std::uint8_t flags = 0;
  // The first child of its parent in the queue: the next population is theirs.
  bool opens_family = false;
};

struct PlannedChild {
  std::size_t index = 0;  // among its siblings, for its key
  std::uint32_t chromosome = 0;
  std::uint32_t extension = 0;
  std::uint8_t flags = 0;
  float position = 0;  // along the whole parent
  float length = 0;
  float pipes = 0;       // as a share of the parent's
  SineCosine deviation;  // from the parent's direction
  SineCosine azimuth;    // about it, from the parent's right
};

struct ChildPlan {
  std::array<PlannedChild, kPositions + 1> children;
  std::size_t count = 0;
  // What is left of the parent's pipes at its tip.
  float tip_pipes = 1;

  void Clear() {
    count = 0;
    tip_pipes = 1;
  }
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_BRANCH_H_
