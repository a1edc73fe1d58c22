// The Z curve (Morton order): places in a plane, put into a line so that near
// ones mostly stay near.
//
// Threads: pure functions. Determinism: integer arithmetic.
#ifndef TERRANE_CORE_GRID_Z_CURVE_H_
#define TERRANE_CORE_GRID_Z_CURVE_H_

#include <cstdint>

namespace terrane::core {

// The bits of `x` with a 0 before each.
constexpr std::uint64_t SpreadBits(std::uint32_t x) {
  std::uint64_t bits = x;
  bits = (bits | bits << 16) & 0x0000FFFF0000FFFFull;
  bits = (bits | bits << 8) & 0x00FF00FF00FF00FFull;
  bits = (bits | bits << 4) & 0x0F0F0F0F0F0F0F0Full;
  bits = (bits | bits << 2) & 0x3333333333333333ull;
  return (bits | bits << 1) & 0x5555555555555555ull;
}

// Place of (x, y) along the curve.
constexpr std::uint64_t ZCurveCode(std::uint32_t x, std::uint32_t y) {
  return SpreadBits(x) | SpreadBits(y) << 1;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_GRID_Z_CURVE_H_
