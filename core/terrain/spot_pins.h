// The lattice points whose height is known exactly: found again in any window
// of any level that holds them.
//
// Conditioning brings P_fbm at a spot to its value up to the rounding of float
// arithmetic; a pin removes that rest, so that a spot's height is met to the
// last bit. Immutable and thread-safe.
#ifndef TERRANE_CORE_TERRAIN_SPOT_PINS_H_
#define TERRANE_CORE_TERRAIN_SPOT_PINS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/box_index.h"
#include "core/terrain/spot_heights.h"

namespace terrane::core {

class SpotPins {
 public:
  // Takes the spots that are met exactly, without standard error.
  explicit SpotPins(std::span<const Spot> spots);

  bool empty() const { return pins_.empty(); }
  std::int64_t MemoryBytes() const;

  // A pin at (x + spacing i, y + spacing j) of the level asked for.
  struct Found {
    std::int64_t i = 0, j = 0;
    float height = 0;
  };
  // Replaces `found` by the pins among those points, i < columns, j < rows;
  // spacing 1 or 2.
  void Find(int level, std::int64_t x, std::int64_t y, std::int64_t spacing,
            std::int64_t columns, std::int64_t rows,
            std::vector<Found>* found) const;

 private:
  struct Pin {
    double u, v;  // in level-0 units, exact
    float height;
  };
  std::vector<Pin> pins_;
  BoxIndex index_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_SPOT_PINS_H_
