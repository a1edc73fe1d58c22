#include "core/tree/genetic_kernels.h"

#include "core/tree/chromosome.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/tree/genetic_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "core/noise/noise-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Members = hn::CappedTag<std::uint32_t, kMemberBatch>;
using Lanes = hn::Vec<Members>;

// Word `word` of the members from `first` on.
HWY_INLINE Lanes Words(Members d, const Breeding& breeding, std::size_t first,
                       std::uint32_t word) {
  return HashLanes(d, hn::LoadU(d, MemberWords(word) + first), breeding.key);
}

// Ones where the 16-bit coins of the genes 2 pair and 2 pair + 1 fall.
struct CoinPair {
  Lanes even;
  Lanes odd;
};
HWY_INLINE CoinPair Coins(Members d, Lanes words, std::uint32_t threshold) {
  const hn::RebindToSigned<Members> di;
  const auto limit = hn::Set(di, static_cast<std::int32_t>(threshold));
  const auto falls = [&](Lanes coin) HWY_ATTR {
    return hn::BitCast(
        d, hn::VecFromMask(di, hn::Lt(hn::BitCast(di, coin), limit)));
  };
  return {falls(hn::And(words, hn::Set(d, 0xFFFFu))),
          falls(hn::ShiftRight<16>(words))};
}

// The low bits of a gene, up to a cut that a byte chooses evenly: at least one
// bit, and at least one less than all unless the gene has but one.
template <int kGene>
HWY_INLINE Lanes LowBits(Members d, Lanes bytes) {
  constexpr GeneField kField = kGeneFields[kGene];
  if constexpr (kField.width == 1) return hn::Set(d, kField.Mask());
  const auto one = hn::Set(d, 1u);
  const auto cuts = hn::Set(d, static_cast<std::uint32_t>(kField.width - 1));
  const auto cut = hn::Add(one, hn::ShiftRight<8>(hn::Mul(bytes, cuts)));
  return hn::ShiftLeft<kField.shift>(hn::Sub(hn::Shl(one, cut), one));
}

// Adds to the bits that come from the father, and to the genes that mutate.
template <int kPair>
HWY_INLINE void CrossPair(Members d, const Breeding& breeding,
                          std::size_t first, Lanes* taken, Lanes* mutates) {
  const CoinPair crosses =
      Coins(d, Words(d, breeding, first, kWordOfCrossover + kPair),
            breeding.crossover);
  const CoinPair hits = Coins(
      d, Words(d, breeding, first, kWordOfMutation + kPair), breeding.mutation);
  const auto cuts = hn::ShiftRight<16 * (kPair % 2)>(
      Words(d, breeding, first, kWordOfCuts + kPair / 2));
  const auto byte = hn::Set(d, 0xFFu);
  const auto even = LowBits<2 * kPair>(d, hn::And(cuts, byte));
  const auto odd =
      LowBits<2 * kPair + 1>(d, hn::And(hn::ShiftRight<8>(cuts), byte));
  *taken = hn::Or(
      *taken, hn::Or(hn::And(crosses.even, even), hn::And(crosses.odd, odd)));
  *mutates =
      hn::Or(*mutates, hn::Or(hn::And(hits.even, hn::Set(d, 1u << 2 * kPair)),
                              hn::And(hits.odd, hn::Set(d, 2u << 2 * kPair))));
}

// 16 random bits as an even choice of [0, count).
HWY_INLINE Lanes Choice(Members d, Lanes sixteen_bits, std::uint32_t count) {
  return hn::ShiftRight<16>(hn::Mul(sixteen_bits, hn::Set(d, count)));
}

// Two different survivors.
struct Parents {
  Lanes mother;
  Lanes father;
};
HWY_INLINE Parents ChooseParents(Members d, Lanes words,
                                 const Breeding& breeding) {
  const hn::RebindToSigned<Members> di;
  const std::uint32_t count = breeding.survivor_count;
  const auto first = Choice(d, hn::ShiftRight<16>(words), count);
  const auto others = Choice(d, hn::And(words, hn::Set(d, 0xFFFFu)), count - 1);
  // Of the others those from the first on lie one further.
  const auto is_before =
      hn::Lt(hn::BitCast(di, others), hn::BitCast(di, first));
  const auto second = hn::Add(
      others, hn::BitCast(d, hn::IfThenZeroElse(is_before, hn::Set(di, 1))));
  return {hn::GatherIndex(d, breeding.survivors, hn::BitCast(di, first)),
          hn::GatherIndex(d, breeding.survivors, hn::BitCast(di, second))};
}

std::uint64_t CrowdedOut(const std::uint32_t* chromosomes,
                         const std::int32_t* fitness, std::size_t members) {
  const Members d;
  const hn::RebindToSigned<Members> di;
  std::uint64_t result = 0;
  for (std::size_t first = 0; first < members; first += hn::Lanes(d)) {
    const auto own = hn::LoadU(d, chromosomes + first);
    const auto own_fitness = hn::LoadU(di, fitness + first);
    const auto own_index = hn::Iota(di, static_cast<std::int32_t>(first));
    auto out = hn::MaskFromVec(hn::Zero(di));
    for (std::size_t j = 0; j < members; ++j) {
      const auto lead = hn::Sub(hn::Set(di, fitness[j]), own_fitness);
      const auto bits = hn::BitCast(
          di, hn::PopulationCount(hn::Xor(own, hn::Set(d, chromosomes[j]))));
      // A lead of 0 counts for the earlier of the two.
      const auto is_earlier =
          hn::Lt(hn::Set(di, static_cast<std::int32_t>(j)), own_index);
      const auto least =
          hn::IfThenElse(is_earlier, hn::Set(di, -1), hn::Zero(di));
      const auto crowds =
          hn::And(hn::Gt(lead, least),
                  hn::And(hn::Lt(lead, hn::Set(di, kNicheFitness + 1)),
                          hn::Lt(bits, hn::Set(di, kNicheDistance + 1))));
      out = hn::Or(out, crowds);
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(di, out, bits);
    result |= std::uint64_t{bits[0]} << first;
  }
  return result;
}

void BreedMembers(const Breeding& breeding, std::size_t members,
                  std::uint32_t* chromosomes, std::uint32_t* mutations) {
  const Members d;
  for (std::size_t first = 0; first < members; first += hn::Lanes(d)) {
    auto taken = hn::Zero(d);
    auto mutates = hn::Zero(d);
    CrossPair<0>(d, breeding, first, &taken, &mutates);
    CrossPair<1>(d, breeding, first, &taken, &mutates);
    if (breeding.all_genes) {
      CrossPair<2>(d, breeding, first, &taken, &mutates);
      CrossPair<3>(d, breeding, first, &taken, &mutates);
    }
    const Parents parents =
        ChooseParents(d, Words(d, breeding, first, kWordOfParents), breeding);
    hn::StoreU(hn::Or(hn::AndNot(taken, parents.mother),
                      hn::And(taken, parents.father)),
               d, chromosomes + first);
    hn::StoreU(mutates, d, mutations + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(CrowdedOut);
HWY_EXPORT(BreedMembers);

std::uint64_t CrowdedOut(const std::uint32_t* chromosomes,
                         const std::int32_t* fitness, std::size_t members) {
  const std::uint64_t out =
      HWY_DYNAMIC_DISPATCH(CrowdedOut)(chromosomes, fitness, members);
  return members < kMostMembers ? out & ((std::uint64_t{1} << members) - 1)
                                : out;
}

void BreedMembers(const Breeding& breeding, std::size_t members,
                  std::uint32_t* chromosomes, std::uint32_t* mutations) {
  HWY_DYNAMIC_DISPATCH(BreedMembers)(breeding, members, chromosomes, mutations);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
