// The random displacement of a lattice point: which stream it draws from, and
// the draw.
//
// A displacement is deviation * draw; the deviation is core/terrain/
// deviation_model.h's. Streams: 2 level + half step in the plane, levels from
// 2^16 on along a line, so no two of them meet. Threads: pure functions.
// Determinism: a draw is a function of (seed, stream, index).
#ifndef TERRANE_CORE_TERRAIN_DISPLACEMENT_DRAW_H_
#define TERRANE_CORE_TERRAIN_DISPLACEMENT_DRAW_H_

#include <cstdint>

#include "core/noise/counter_hash.h"
#include "core/noise/normal.h"
#include "core/terrain/displacement.h"

namespace terrane::core {

// A half step of a level, as one number. Level 0 has only kEdge.
constexpr std::uint32_t HalfStepSlot(int level, HalfStep step) {
  return 2 * static_cast<std::uint32_t>(level) +
         (step == HalfStep::kEdge ? 1u : 0u);
}

constexpr std::uint32_t PlaneStream(int level, HalfStep step) {
  return HalfStepSlot(level, step);
}

constexpr std::uint32_t LineStream(int level) {
  constexpr std::uint32_t kFirst = 1u << 16;
  return kFirst + static_cast<std::uint32_t>(level);
}

// The standard normal draw of point (x, y); mirror indices before.
inline float DisplacementDraw(std::int64_t seed, std::uint32_t stream,
                              std::int64_t x, std::int64_t y) {
  return NormalFromBits(
      HashLane(ColumnWord(x), MakeRowKey(StreamKey(seed, stream), y)));
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_TERRAIN_DISPLACEMENT_DRAW_H_
