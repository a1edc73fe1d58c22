// The genetic operators: selection, crossover and mutation.
//
// A family is the children of one branch; it has one population, whose first
// members are the children themselves. For each of them the operators make the
// population of its own children:
//   selection   crowding niches: of two chromosomes whose fitness differs by at
//               most 5 and that differ in at most 4 bits, the less fit is
//               crowded out (of two equals the later); at least two survive
//   crossover   of two parents, drawn evenly from the survivors: for each gene,
//               by a coin of crossover_rate, the low bits up to a random cut
//               come from the second, and genes of one bit whole
//   mutation    each gene, by a coin of mutation_rate, is drawn anew
// A gene is drawn as a code that is normal about the middle of its range; axis
// and side by the requested shares. Similar, but not identical: the parents of
// a crossover are two different survivors, and a chromosome that comes out as
// its branch's own has its angle drawn anew.
//
// Immutable, safe from any thread. Integers only; draws are functions of
// (branch key, member), see core/tree/draws.h.
//
// Source: Wu & Zhou 2008, sections 2.3 (2)-(4) and 2.4.
#ifndef TERRANE_CORE_TREE_OPERATORS_H_
#define TERRANE_CORE_TREE_OPERATORS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/tree/draws.h"
#include "core/tree/fitness.h"
#include "core/tree/genetic_kernels.h"
#include "core/tree/tree_spec.h"

namespace terrane::core {

inline constexpr std::size_t kLeastSurvivors = 2;

// What selection leaves of a population, in its order.
struct Survivors {
  std::array<std::uint32_t, kMostMembers> chromosomes;
  std::size_t count = 0;
};

// All genes of a chromosome, or only those of a child that its parent's own row
// depends on: the others are left as the first parent's.
enum class GenesBred { kAll, kLengthAndSide };

class Operators {
 public:
  explicit Operators(const GeneticSpec& spec);

  std::size_t population() const { return population_; }
  // The same in whole batches: what an array of a population must hold.
  std::size_t padded_population() const { return WholeBatches(population_); }

  // Copies of the trunk with each gene drawn anew by an even coin; axis and
  // side always.
  void FirstPopulation(std::uint32_t trunk, const BranchDraws& draws,
                       std::span<std::uint32_t> population) const;

  // The array behind `population` holds whole batches.
  void Select(std::span<const std::uint32_t> population,
              Survivors* survivors) const;

  // The first `members` of the population of the children of a branch whose
  // chromosome is `own`. `population` holds whole batches.
  void Breed(const Survivors& survivors, std::uint32_t own,
             const BranchDraws& draws, GenesBred genes, std::size_t members,
             std::uint32_t* population) const;

 private:
  std::uint32_t DrawnAnew(std::uint32_t chromosome, int gene,
                          std::size_t member, const BranchDraws& draws) const;

  Fitness fitness_;
  std::size_t population_;
  std::uint32_t crossover_;
  std::uint32_t mutation_;
  std::uint32_t monopodial_;
  std::uint32_t left_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_OPERATORS_H_
