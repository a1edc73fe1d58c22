// The random numbers of a tree: functions of (seed, parent key, child index),
// so that a branch is the same whatever was grown before it.
//
// A branch has a key of 64 bits, made from its parent's key and its index among
// the children; the words that its operators draw are hashes of that key and of
// (member of the population, what is drawn). Pure functions; integers only.
#ifndef TERRANE_CORE_TREE_DRAWS_H_
#define TERRANE_CORE_TREE_DRAWS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/noise/counter_hash.h"

namespace terrane::core {

// Streams of StreamKey (core/noise/counter_hash.h) that trees draw from.
inline constexpr std::uint32_t kBranchStream = 0x54524545;
inline constexpr std::uint32_t kLeafStream = 0x4C454146;

constexpr std::uint64_t TrunkKey(std::int64_t seed) {
  return StreamKey(seed, kBranchStream);
}

constexpr std::uint64_t ChildKey(std::uint64_t parent_key, std::size_t child) {
  return Mix64(parent_key + 0x9E3779B97F4A7C15ull * (child + 1));
}

// The golden angle, 137.5 degrees, 2^32 to a turn.
inline constexpr std::uint32_t kGoldenTurn = 1640531527u;

// Words that one member of a population may draw, and members of the largest.
inline constexpr std::uint32_t kWordsOfMember = 32;
inline constexpr std::size_t kMostMembers = 64;

// What tells words of one branch apart, hashed once for all branches.
inline constexpr auto kMemberWords = [] {
  std::array<std::array<std::uint32_t, kMostMembers>, kWordsOfMember> words{};
  std::uint32_t count = 0;
  for (auto& of_word : words) {
    for (std::uint32_t& member : of_word) member = Mix32(count++);
  }
  return words;
}();
// Of the members 0, 1, 2, ...
constexpr const std::uint32_t* MemberWords(std::uint32_t word) {
  return kMemberWords[word].data();
}

// The words of one branch.
class BranchDraws {
 public:
  explicit BranchDraws(std::uint64_t key)
      : key_{static_cast<std::uint32_t>(key),
             static_cast<std::uint32_t>(key >> 32)} {}

  // 32 random bits; `word` < kWordsOfMember.
  std::uint32_t Word(std::size_t member, std::uint32_t word) const {
    return HashLane(MemberWords(word)[member], key_);
  }

  RowKey key() const { return key_; }

 private:
  RowKey key_;
};

// Largest value of a draw with 15 bits: the paper's Z.
inline constexpr std::uint32_t kDrawMax = (1u << 15) - 1;
// Largest sum of three.
inline constexpr std::uint32_t kDrawSumMax = 3 * kDrawMax;

// Sum of three uniform draws of 15 bits, from two words: close to normal with
// mean 3Z/2 and deviation Z/2. Y(p) of the paper is p (2 sum / 3Z - 1).
constexpr std::uint32_t DrawSum(std::uint32_t first, std::uint32_t second) {
  return (first & kDrawMax) + (first >> 17) + (second >> 17);
}

// round(mid + Y(mid)) with mid = largest / 2: a code in [0, largest], normal
// about its middle.
constexpr std::uint32_t NormalCode(std::uint32_t largest, std::uint32_t sum) {
  return (2 * largest * sum + kDrawSumMax) / (2 * kDrawSumMax);
}

// A probability as a threshold of 16 random bits, and a coin that falls on it.
// std::lround is no constant expression, and rounds alike from 0 to 1.
constexpr std::uint32_t Threshold(double probability) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings)
  return static_cast<std::uint32_t>(probability * 65536.0 + 0.5);
}
constexpr bool Coin(std::uint32_t sixteen_bits, std::uint32_t threshold) {
  return sixteen_bits < threshold;
}

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_DRAWS_H_
