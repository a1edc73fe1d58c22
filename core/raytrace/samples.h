// Where the samples of a pixel lie: pairs of numbers in [0, 1) that are pure
// functions of (seed, pixel, pass, pair).
//
// The passes of a pixel walk through Sobol's (0,2)-sequence: any 2^k of them
// that begin at a multiple of 2^k fill the square evenly, so noise falls faster
// than with independent numbers. Every pair of every pixel has a scrambling and
// an order of passes of its own, which keeps them independent of each other
// (Owen's scrambling by hashing: Laine & Karras 2011, Burley 2020).
//
// Threads: pure functions. Determinism: integer arithmetic only.
#ifndef TERRANE_CORE_RAYTRACE_SAMPLES_H_
#define TERRANE_CORE_RAYTRACE_SAMPLES_H_

#include <cstdint>

#include "core/mesh/mesh.h"
#include "core/noise/counter_hash.h"

namespace terrane::core {

constexpr std::uint32_t ReversedBits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00FF00FFu) | ((x & 0x00FF00FFu) << 8);
  x = ((x >> 4) & 0x0F0F0F0Fu) | ((x & 0x0F0F0F0Fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Owen's scrambling of a number whose bits are reversed: a bijection that flips
// each bit as a function of the key and of the bits below it. By Laine &
// Karras, whose products carry bits upwards only.
constexpr std::uint32_t ScrambledReversed(std::uint32_t x, std::uint32_t key) {
  x += key;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return x;
}

// The bits of the second coordinate of Sobol's sequence, reversed; those of the
// first are the index itself. Bit i is the sum of the index's bits j with C(j,
// i) odd: Pascal's triangle modulo 2, which is a Kronecker power of a 2 x 2
// matrix, hence five steps.
constexpr std::uint32_t SobolSecondReversed(std::uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0F0F0F0Fu;
  index ^= (index >> 8) & 0x00FF00FFu;
  return index ^ (index >> 16);
}

// [0, 1).
constexpr float UnitFloat(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

// The samples of one pixel in one pass, pair after pair.
class PixelSamples {
 public:
  PixelSamples(std::int64_t seed, int x, int y, int pass)
      : pixel_key_(HashLane(ColumnWord(x), MakeRowKey(StreamKey(seed, 0), y))),
        reversed_pass_(ReversedBits(static_cast<std::uint32_t>(pass))) {}

  Float2 Next() {
    const std::uint32_t key = Mix32(pixel_key_ + 0x9E3779B9u * ++pair_);
    const std::uint32_t index =
        ReversedBits(ScrambledReversed(reversed_pass_, key));
    return {UnitFloat(ReversedBits(
                ScrambledReversed(index, Mix32(key ^ 0xA511E9B3u)))),
            UnitFloat(ReversedBits(ScrambledReversed(
                SobolSecondReversed(index), Mix32(key ^ 0x63D83595u))))};
  }

 private:
  const std::uint32_t pixel_key_;
  const std::uint32_t reversed_pass_;
  std::uint32_t pair_ = 0;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_RAYTRACE_SAMPLES_H_
