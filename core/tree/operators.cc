#include "core/tree/operators.h"

#include <bit>

namespace terrane::core {
namespace {

constexpr std::uint32_t kEvenCoin = Threshold(0.5);

// The two genes as bits.
constexpr std::uint32_t kLengthAndSide =
    1u << static_cast<int>(Gene::kLength) | 1u << static_cast<int>(Gene::kSide);

}  // namespace

Operators::Operators(const GeneticSpec& spec)
    : fitness_(spec),
      population_(static_cast<std::size_t>(spec.population)),
      crossover_(Threshold(spec.crossover_rate)),
      mutation_(Threshold(spec.mutation_rate)),
      monopodial_(Threshold(spec.monopodial_share)),
      left_(Threshold(spec.left_share)) {}

std::uint32_t Operators::DrawnAnew(std::uint32_t chromosome, int gene,
                                   std::size_t member,
                                   const BranchDraws& draws) const {
  const auto which = static_cast<Gene>(gene);
  const std::uint32_t at = kWordOfCodes + 2 * static_cast<std::uint32_t>(gene);
  const std::uint32_t first = draws.Word(member, at);
  if (which == Gene::kAxis || which == Gene::kSide) {
    const std::uint32_t share = which == Gene::kAxis ? monopodial_ : left_;
    return WithCode(chromosome, which, Coin(first >> 16, share) ? 1 : 0);
  }
  const std::uint32_t sum = DrawSum(first, draws.Word(member, at + 1));
  return WithCode(chromosome, which, NormalCode(FieldOf(which).Largest(), sum));
}

void Operators::FirstPopulation(std::uint32_t trunk, const BranchDraws& draws,
                                std::span<std::uint32_t> population) const {
  for (std::size_t member = 0; member < population.size(); ++member) {
    std::uint32_t chromosome = trunk;
    for (int gene = 0; gene < kGenes; ++gene) {
      const auto which = static_cast<Gene>(gene);
      const std::uint32_t word = draws.Word(
          member, kWordOfMutation + static_cast<std::uint32_t>(gene / 2));
      const std::uint32_t coin = gene % 2 == 0 ? word & 0xFFFF : word >> 16;
      if (which == Gene::kAxis || which == Gene::kSide ||
          Coin(coin, kEvenCoin)) {
        chromosome = DrawnAnew(chromosome, gene, member, draws);
      }
    }
    population[member] = chromosome;
  }
}

void Operators::Select(std::span<const std::uint32_t> population,
                       Survivors* survivors) const {
  std::array<std::int32_t, kMostMembers> fitness = {};
  for (std::size_t i = 0; i < population.size(); ++i) {
    fitness[i] = fitness_.Of(population[i]);
  }
  const std::uint64_t crowded_out =
      CrowdedOut(population.data(), fitness.data(), population.size());
  survivors->count = 0;
  for (std::size_t i = 0; i < population.size(); ++i) {
    // Without a branch, for it would go either way.
    survivors->chromosomes[survivors->count] = population[i];
    survivors->count += 1 - (crowded_out >> i & 1);
  }
  if (survivors->count >= kLeastSurvivors) return;
  // Only the fittest is left (nobody crowds it out); the fittest of the others
  // joins it.
  std::size_t second = population.size();
  for (std::size_t i = 0; i < population.size(); ++i) {
    const bool is_out = (crowded_out >> i & 1) != 0;
    if (is_out &&
        (second == population.size() || fitness[i] > fitness[second])) {
      second = i;
    }
  }
  survivors->chromosomes[survivors->count++] = population[second];
}

void Operators::Breed(const Survivors& survivors, std::uint32_t own,
                      const BranchDraws& draws, GenesBred genes,
                      std::size_t members, std::uint32_t* population) const {
  const bool all = genes == GenesBred::kAll;
  const std::uint32_t bred = all ? (1u << kGenes) - 1 : kLengthAndSide;
  std::array<std::uint32_t, kMostMembers> mutations;
  BreedMembers({.survivors = survivors.chromosomes.data(),
                .survivor_count = static_cast<std::uint32_t>(survivors.count),
                .key = draws.key(),
                .all_genes = all,
                .crossover = crossover_,
                .mutation = mutation_},
               members, population, mutations.data());
  for (std::size_t member = 0; member < members; ++member) {
    for (std::uint32_t left = mutations[member] & bred; left != 0;
         left &= left - 1) {
      population[member] =
          DrawnAnew(population[member], std::countr_zero(left), member, draws);
    }
    if (population[member] == own) {
      population[member] =
          DrawnAnew(own, static_cast<int>(Gene::kAngle), member, draws);
    }
  }
}

}  // namespace terrane::core
