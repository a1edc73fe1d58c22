// The border of a bounded domain: indices outside it are mirrored.
//
// The stencils are symmetric and every kernel's sums are, too, so a lattice
// whose random numbers and deviations are mirrored at the border is mirrored as
// a whole, to the bit: the border needs no code in the hot loops.
#ifndef TERRANE_CORE_TERRAIN_MIRROR_H_
#define TERRANE_CORE_TERRAIN_MIRROR_H_

#include <cstdint>
#include <optional>

#include "core/terrain/terrain_spec.h"

namespace terrane::core {

// Index reflected into [0, last]; last >= 1.
constexpr std::int64_t Reflect(std::int64_t index, std::int64_t last) {
  if (index >= 0 && index <= last) return index;
  const std::int64_t period = 2 * last;
  std::int64_t r = index % period;
  if (r < 0) r += period;
  return r > last ? period - r : r;
}

struct Mirror {
  std::optional<Domain> domain;

  std::int64_t X(std::int64_t ix, int level) const {
    return domain ? Reflect(ix, domain->cells_x << level) : ix;
  }
  std::int64_t Y(std::int64_t iy, int level) const {
    return domain ? Reflect(iy, domain->cells_y << level) : iy;
  }
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_MIRROR_H_
