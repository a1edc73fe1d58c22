// Random numbers of a load test, by position: the n-th of a stream is a
// function of (seed, stream, n) alone. Steele, Lea and Flood's SplitMix64
// finaliser.
#ifndef TERRANE_CLIENT_BENCH_RANDOM_NUMBER_H_
#define TERRANE_CLIENT_BENCH_RANDOM_NUMBER_H_

#include <cstdint>

namespace terrane::client {

// What a number is for; two streams have nothing in common.
enum class RandomStream : std::uint64_t {
  kKind = 1,
  kClient,
  kCold,
  kHotChoice,
  kRecipe,
  kPlace,
  kArrival,
  kRetry
};

constexpr std::uint64_t Scramble(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return bits ^ (bits >> 31);
}

constexpr std::uint64_t RandomBits(std::uint64_t seed, RandomStream stream,
                                   std::int64_t number) {
  return Scramble(
      Scramble(seed ^ Scramble(static_cast<std::uint64_t>(stream))) +
      static_cast<std::uint64_t>(number));
}

// In [0, 1).
constexpr double RandomShare(std::uint64_t seed, RandomStream stream,
                             std::int64_t number) {
  return static_cast<double>(RandomBits(seed, stream, number) >> 11) * 0x1p-53;
}

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_RANDOM_NUMBER_H_
