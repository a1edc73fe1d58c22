// Discrete constraints on the lattice: which points are held at P_fbm = 0, by
// the level they appear at. Tan & Chen 2003, section 3.
//
// Immutable and thread-safe.
#ifndef TERRANE_CORE_TERRAIN_DISCRETE_CONSTRAINTS_H_
#define TERRANE_CORE_TERRAIN_DISCRETE_CONSTRAINTS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/grid/box_index.h"
#include "core/grid/lattice_window.h"
#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// A lattice point, in indices of its level.
struct LatticePoint {
  std::int64_t x = 0;
  std::int64_t y = 0;

  bool operator==(const LatticePoint&) const = default;
};

// The level whose lattice constraint `index` snaps to: its own, or the coarsest
// one whose spacing is at most its radius. Errors: INVALID_ARGUMENT when a
// radius asks for a level beyond kMaxLevel.
absl::StatusOr<int> DiscreteLevel(const DiscreteConstraint& constraint,
                                  std::size_t index, const Frame& frame,
                                  int dimensions);

class DiscreteConstraints {
 public:
  // Snaps each constraint to the nearest point of its level's lattice (default:
  // the coarsest level whose spacing is at most its radius) and files it under
  // the level where that point first appears. Several constraints may share a
  // point. Errors: INVALID_ARGUMENT when a radius asks for a level beyond
  // kMaxLevel or a point's index would pass kMaxIndex, naming
  // "discrete_constraints[i]".
  static absl::StatusOr<DiscreteConstraints> Create(const TerrainSpec& spec,
                                                    const Frame& frame);

  bool empty() const { return levels_.empty(); }

  // Appends the points of `level` (those that appear there) inside the window.
  void Find(int level, const Window& window,
            std::vector<LatticePoint>* points) const;

 private:
  struct Level {
    std::vector<LatticePoint> points;
    BoxIndex index;
  };
  std::vector<Level> levels_;  // by level; none behind the finest used
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_DISCRETE_CONSTRAINTS_H_
