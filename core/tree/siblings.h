// The limits that keep siblings apart.
//
//   - Monopodial: the children sit at the parent's positions, in their order
//     from base to tip. On one side, two are at least 0.2 of the parent's
//     length apart: the later one changes sides, or else moves up, or else is
//     dropped.
//   - Sympodial: all sit at the tip and alternate sides, from the side that the
//     first one's gene says.
// Pure integer function, safe from any thread.
//
// Source: Wu & Zhou 2008, section 2.3 (3).
#ifndef TERRANE_CORE_TREE_SIBLINGS_H_
#define TERRANE_CORE_TREE_SIBLINGS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/tree/chromosome.h"

namespace terrane::core {

// Least distance of two siblings on one side in position codes: 0.2 * 63,
// rounded up.
inline constexpr int kLeastGap = 13;

struct SiblingPlace {
  std::size_t member = 0;  // whose chromosome the child has
  std::uint32_t position = 0;
  bool left = false;
};

struct SiblingPlaces {
  std::array<SiblingPlace, kPositions> places;
  std::size_t count = 0;
};

// The places of at most members.size() children of a branch; `members` are
// their chromosomes as bred.
SiblingPlaces PlaceSiblings(std::uint32_t parent,
                            std::span<const std::uint32_t> members);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_SIBLINGS_H_
