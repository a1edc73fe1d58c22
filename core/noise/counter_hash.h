// Counter-based randomness: 32 random bits for every point of every lattice.
//
// The bits are a pure function of (seed, stream, ix, iy), where the stream is
// the level and half step that draws. Nothing is stored and nothing is
// sequential, so any point of an endless lattice is drawn on its own (pbrt
// calls this hashing instead of sampling). The work is split so that a row of
// samples is cheap:
//   StreamKey(seed, stream)        once a half step,   64 -> 64 bits
//   MakeRowKey(stream_key, iy)     once a row,         64 + 64 -> 64 bits
//   ColumnWord(ix)                 once a column,      64 -> 32 bits
//   HashLane(column_word, row_key) once a sample,      2 multiplications
// Two columns share a word only when their indices differ by at least 2^32. The
// SIMD form of HashLane is in noise-inl.h and gives the same bits.
//
// Threads: pure functions. Determinism: integer arithmetic only.
#ifndef TERRANE_CORE_NOISE_COUNTER_HASH_H_
#define TERRANE_CORE_NOISE_COUNTER_HASH_H_

#include <cstdint>

namespace terrane::core {

// The two words that a row adds to its lanes.
struct RowKey {
  std::uint32_t first;
  std::uint32_t second;
};

inline constexpr std::uint32_t kLaneMultiplier1 = 0x9E485565u;
inline constexpr std::uint32_t kLaneMultiplier2 = 0xEF1D6B47u;

// A bijection of 64 bits with full avalanche (Murmur3's finaliser form).
constexpr std::uint64_t Mix64(std::uint64_t x) {
  x ^= x >> 33;
  x *= 0xFF51AFD7ED558CCDull;
  x ^= x >> 33;
  x *= 0xC4CEB9FE1A85EC53ull;
  x ^= x >> 33;
  return x;
}

// The same of 32 bits.
constexpr std::uint32_t Mix32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85EBCA6Bu;
  x ^= x >> 13;
  x *= 0xC2B2AE35u;
  x ^= x >> 16;
  return x;
}

constexpr std::uint64_t StreamKey(std::int64_t seed, std::uint32_t stream) {
  return Mix64(Mix64(static_cast<std::uint64_t>(seed) + 0x9E3779B97F4A7C15ull) +
               0xD1B54A32D192ED03ull * (std::uint64_t{stream} + 1));
}

constexpr RowKey MakeRowKey(std::uint64_t stream_key, std::int64_t iy) {
  const std::uint64_t key = Mix64(
      stream_key ^ (static_cast<std::uint64_t>(iy) * 0x9E3779B97F4A7C15ull));
  return {static_cast<std::uint32_t>(key),
          static_cast<std::uint32_t>(key >> 32)};
}

// For indices with the same upper half a bijection of the lower half.
constexpr std::uint32_t ColumnWord(std::int64_t ix) {
  const auto bits = static_cast<std::uint64_t>(ix);
  const auto low = static_cast<std::uint32_t>(bits);
  const auto high = static_cast<std::uint32_t>(bits >> 32);
  return Mix32(low + 0x632BE5ABu * Mix32(high));
}

constexpr std::uint32_t HashLane(std::uint32_t column_word, RowKey key) {
  std::uint32_t x = (column_word + key.first) * kLaneMultiplier1;
  x ^= x >> 15;
  x = (x ^ key.second) * kLaneMultiplier2;
  x ^= x >> 16;
  return x;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_NOISE_COUNTER_HASH_H_
