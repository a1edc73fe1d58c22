// Crowding and crossover of a whole population at once, in SIMD: a lane is a
// member.
//
// Integers only, so every SIMD target gives the same bits. Safe from any
// thread.
#ifndef TERRANE_CORE_TREE_GENETIC_KERNELS_H_
#define TERRANE_CORE_TREE_GENETIC_KERNELS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/noise/counter_hash.h"
#include "core/tree/chromosome.h"
#include "core/tree/draws.h"

namespace terrane::core {

// Members are made in batches: arrays of members hold whole batches.
inline constexpr std::size_t kMemberBatch = 8;
constexpr std::size_t WholeBatches(std::size_t members) {
  return (members + kMemberBatch - 1) / kMemberBatch * kMemberBatch;
}

inline constexpr int kNicheFitness = 5;
inline constexpr int kNicheDistance = 4;

// The members that are crowded out, as bits: by a fitter one, or by an earlier
// one of the same fitness, whose fitness differs by at most 5 and whose
// chromosome in at most 4 bits. Both arrays hold whole batches.
std::uint64_t CrowdedOut(const std::uint32_t* chromosomes,
                         const std::int32_t* fitness, std::size_t members);

struct Breeding {
  const std::uint32_t* survivors = nullptr;
  std::uint32_t survivor_count = 0;
  RowKey key;
  // Or only the first half: length, angle, axis and side.
  bool all_genes = true;
  // Thresholds of 16-bit coins.
  std::uint32_t crossover = 0;
  std::uint32_t mutation = 0;
};

// Writes `members` chromosomes, crossed over, and for each the genes that
// mutate as bits by Gene: drawing them anew, which is rare, is left to the
// caller. Both arrays hold whole batches.
void BreedMembers(const Breeding& breeding, std::size_t members,
                  std::uint32_t* chromosomes, std::uint32_t* mutations);

// The order of a member's words (BranchDraws::Word).
inline constexpr std::uint32_t kWordOfParents = 0;
inline constexpr std::uint32_t kWordOfCrossover = 1;  // 4 words, 2 genes each
inline constexpr std::uint32_t kWordOfCuts = 5;       // 2 words, 4 genes each
inline constexpr std::uint32_t kWordOfMutation = 7;   // 4 words, 2 genes each
inline constexpr std::uint32_t kWordOfCodes = 11;     // 16 words, 2 a gene
inline constexpr std::uint32_t kWordOfAzimuth = 27;   // 2 words

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_GENETIC_KERNELS_H_
