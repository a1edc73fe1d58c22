// The chromosome's layout, draws, fitness, the three operators and the limits
// on siblings, each against its definition.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

#include "core/tree/chromosome.h"
#include "core/tree/estimate.h"
#include "core/tree/operators.h"
#include "core/tree/siblings.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::ElementsAre;

TEST(Chromosome, HasTheBitsOfTheApi) {
  EXPECT_EQ(DecodeChromosome(14u | 5u << 5 | 1u << 11 | 3u << 12),
            (Genes{14, 5, false, true, 3}));
  const Genes genes = {21, 9, true, false, 2, {33, 1, 62}};
  const std::uint32_t chromosome = EncodeChromosome(genes);
  EXPECT_EQ(chromosome, 21u | 9u << 5 | 1u << 10 | 2u << 12 | 33u << 14 |
                            1u << 20 | 62u << 26);
  EXPECT_EQ(DecodeChromosome(chromosome), genes);
}

TEST(Chromosome, EveryWordDecodesAndEncodesToItself) {
  std::uint32_t word = 1;
  for (int n = 0; n < 100'000; ++n) {
    word = Mix32(word + 1);
    ASSERT_EQ(EncodeChromosome(DecodeChromosome(word)), word);
  }
}

TEST(Chromosome, CodesStandForThePapersValues) {
  EXPECT_EQ(LengthOfCode(31), 310);
  EXPECT_EQ(AngleDegOfCode(0), 30);
  EXPECT_EQ(AngleDegOfCode(31), 45);
  EXPECT_EQ(PositionOfCode(63), 1);
  EXPECT_EQ(DefaultTrunk(true), 0xE2A7B41Fu);
}

TEST(Chromosome, RoundingOfChildLengthsEnds) {
  std::vector<std::uint32_t> codes = {31};
  while (codes.back() > 0) codes.push_back(LargestChildLength(codes.back()));
  EXPECT_THAT(codes, ElementsAre(31, 21, 14, 9, 6, 4, 2, 1, 0));
}

TEST(Draws, CodesSpanTheirRangeAndAreNormalAboutTheMiddle) {
  EXPECT_EQ(NormalCode(31, 0), 0u);
  EXPECT_EQ(NormalCode(31, kDrawSumMax), 31u);
  double sum = 0, squares = 0;
  constexpr int kCount = 64 * 4000;
  for (int n = 0; n < kCount; ++n) {
    const BranchDraws branch(ChildKey(TrunkKey(5), static_cast<unsigned>(n)));
    const auto member = static_cast<std::size_t>(n % 64);
    const double x = DrawSum(branch.Word(member, 11), branch.Word(member, 12)) /
                         (kDrawSumMax / 2.0) -
                     1;
    sum += x;
    squares += x * x;
  }
  // Q has mean 0 and deviation 1, and Y(1) is Q / 3.
  EXPECT_NEAR(sum / kCount, 0, 0.003);
  EXPECT_NEAR(std::sqrt(squares / kCount), 1.0 / 3, 0.003);
}

TEST(Draws, DifferForEveryMemberAndWord) {
  const BranchDraws draws(TrunkKey(77));
  std::set<std::uint32_t> words;
  for (std::size_t member = 0; member < kMostMembers; ++member) {
    for (std::uint32_t word = 0; word < kWordsOfMember; ++word) {
      words.insert(draws.Word(member, word));
    }
  }
  EXPECT_EQ(words.size(), kMostMembers * kWordsOfMember);
}

TEST(Fitness, SharesCountTenTimesTheRequestedShare) {
  GeneticSpec spec;
  spec.monopodial_share = 0.1;  // the paper's example: 90 % sympodial,
  spec.left_share = 0.9;        // 90 % left
  const Fitness fitness(spec);
  EXPECT_EQ(fitness.Of(EncodeChromosome({.left = false})), 9 + 1);
  EXPECT_EQ(fitness.Of(EncodeChromosome({.left = true})), 9 + 9);
  EXPECT_EQ(fitness.Of(EncodeChromosome({.monopodial = true})), 1 + 1);
}

TEST(Fitness, DenseWantsShortNarrowManyAndClose) {
  GeneticSpec spec;
  spec.monopodial_share = 1;
  spec.left_share = 0;
  spec.density = Wanted::kHigh;
  const Fitness dense(spec);
  // Axis and side 20; length, angle 10 each; count 9; gap 10 when all together.
  EXPECT_EQ(dense.Of(EncodeChromosome({0, 0, true, false, 3, {7, 7, 7}})), 59);
  EXPECT_EQ(dense.Of(EncodeChromosome({31, 31, true, false, 3, {7, 7, 7}})),
            39);
  // Gaps of 0.25 of the length: round(10 (1 - 0.5)) = 5.
  EXPECT_EQ(dense.Of(EncodeChromosome({0, 0, true, false, 3, {0, 32, 16}})),
            54);
  EXPECT_EQ(dense.Of(EncodeChromosome({0, 0, true, false, 1, {9, 9, 9}})),
            20 + 20 + 3 + 5);
  spec.density = Wanted::kLow;
  const Fitness sparse(spec);
  EXPECT_EQ(sparse.Of(EncodeChromosome({31, 31, true, false, 2, {0, 63, 5}})),
            20 + 20 + 3 + 10);
  EXPECT_EQ(sparse.Of(EncodeChromosome({31, 31, true, false, 0, {}})),
            20 + 20 + 9 + 5);
}

TEST(Fitness, OneFeatureCanBeAskedForAlone) {
  GeneticSpec spec;
  const int base = Fitness(spec).Of(EncodeChromosome({.length = 31}));
  spec.lengths = Wanted::kHigh;
  EXPECT_EQ(Fitness(spec).Of(EncodeChromosome({.length = 31})), base + 10);
  EXPECT_EQ(Fitness(spec).Of(EncodeChromosome({.length = 0})), base);
}

std::vector<std::uint32_t> SurvivorsOf(const GeneticSpec& spec,
                                       std::vector<std::uint32_t> population) {
  const std::size_t size = population.size();
  population.resize(kMostMembers);
  Survivors survivors;
  Operators(spec).Select({population.data(), size}, &survivors);
  return {survivors.chromosomes.begin(),
          survivors.chromosomes.begin() +
              static_cast<std::ptrdiff_t>(survivors.count)};
}

TEST(Selection, CrowdsOutTheLessFitOfAPairThatIsClose) {
  GeneticSpec spec;
  spec.counts = Wanted::kHigh;
  const std::uint32_t three = EncodeChromosome({.count = 3});
  const std::uint32_t two = EncodeChromosome({.count = 2});   // 3 less fit
  const std::uint32_t none = EncodeChromosome({.count = 0});  // 9 less fit
  const std::uint32_t far = EncodeChromosome({31, 0, false, false, 2});
  EXPECT_THAT(SurvivorsOf(spec, {two, three, none}), ElementsAre(three, none));
  EXPECT_THAT(SurvivorsOf(spec, {two, three, far}), ElementsAre(three, far));
}

TEST(Selection, OfEqualsTheFirstStaysAndTwoSurvive) {
  GeneticSpec spec;
  EXPECT_THAT(SurvivorsOf(spec, {8, 8, 1, 8}), ElementsAre(8, 8));
  EXPECT_THAT(SurvivorsOf(spec, {5, 5}), ElementsAre(5, 5));
}

// Against the definition, member by member.
TEST(Selection, IsTheDefinition) {
  GeneticSpec spec;
  spec.density = Wanted::kHigh;
  const Fitness fitness(spec);
  std::uint32_t word = 3;
  for (int n = 0; n < 2000; ++n) {
    std::vector<std::uint32_t> population(2 + static_cast<unsigned>(n) % 63);
    for (std::uint32_t& member : population) {
      word = Mix32(word + 0x9E3779B9u);
      member = 0x12345678u ^ (word & word >> 7 & word >> 13);
    }
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < population.size(); ++i) {
      bool out = false;
      for (std::size_t j = 0; j < population.size(); ++j) {
        const int lead = fitness.Of(population[j]) - fitness.Of(population[i]);
        out |= j != i && std::popcount(population[i] ^ population[j]) <= 4 &&
               lead <= 5 && (lead > 0 || (lead == 0 && j < i));
      }
      if (!out) expected.push_back(population[i]);
    }
    const auto survivors = SurvivorsOf(spec, population);
    if (expected.size() >= 2) {
      ASSERT_EQ(survivors, expected);
    } else {
      ASSERT_EQ(survivors.size(), 2u);
    }
  }
}

Survivors Two(std::uint32_t a, std::uint32_t b) {
  Survivors survivors;
  survivors.chromosomes = {a, b};
  survivors.count = 2;
  return survivors;
}

// Of two parents without a bit in common it shows which bits came from which.
TEST(Crossover, TakesLowBitsOfFieldsAtItsRate) {
  GeneticSpec spec;
  spec.mutation_rate = 0;
  spec.population = 64;
  const Operators operators(spec);
  std::array<std::uint32_t, kMostMembers> population;
  std::array<int, kGenes> crossed = {};
  constexpr int kRuns = 500;
  for (int run = 0; run < kRuns; ++run) {
    // Nothing comes out as the branch's own, which would have its angle anew.
    operators.Breed(Two(0, 0xFFFFFFFFu), 2, BranchDraws(TrunkKey(run)),
                    GenesBred::kAll, kMostMembers, population.data());
    for (std::uint32_t child : population) {
      for (int gene = 0; gene < kGenes; ++gene) {
        const GeneField field = kGeneFields[static_cast<std::size_t>(gene)];
        const std::uint32_t code = CodeOf(child, static_cast<Gene>(gene));
        // Ones or zeros below the cut, the others above it.
        const std::uint32_t low =
            (code & 1) != 0 ? code : ~code & field.Largest();
        ASSERT_EQ(low & (low + 1), 0u) << "gene " << gene << " code " << code;
        if (field.width > 1)
          crossed[static_cast<std::size_t>(gene)] +=
              code != 0 && code != field.Largest();
      }
    }
  }
  for (int gene = 0; gene < kGenes; ++gene) {
    if (kGeneFields[static_cast<std::size_t>(gene)].width == 1) continue;
    EXPECT_NEAR(crossed[static_cast<std::size_t>(gene)] / (64.0 * kRuns), 0.4,
                0.015)
        << gene;
  }
}

TEST(Crossover, WithoutItChildrenAreTheirParents) {
  GeneticSpec spec;
  spec.mutation_rate = 0;
  spec.crossover_rate = 0;
  const Operators operators(spec);
  std::array<std::uint32_t, kMostMembers> population;
  operators.Breed(Two(0x12345678, 0x0F0F0F0F), 0, BranchDraws(9),
                  GenesBred::kAll, 8, population.data());
  for (int i = 0; i < 8; ++i) {
    EXPECT_TRUE(population[static_cast<std::size_t>(i)] == 0x12345678 ||
                population[static_cast<std::size_t>(i)] == 0x0F0F0F0F);
  }
}

TEST(Mutation, DrawsFieldsAnewAtItsRate) {
  GeneticSpec spec;
  spec.crossover_rate = 0;
  spec.mutation_rate = 0.25;
  spec.left_share = 1;
  const Operators operators(spec);
  std::array<std::uint32_t, kMostMembers> population;
  int lengths = 0, sides = 0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    operators.Breed(Two(0, 0), 2, BranchDraws(TrunkKey(run)), GenesBred::kAll,
                    8, population.data());
    for (std::size_t i = 0; i < 8; ++i) {
      lengths += CodeOf(population[i], Gene::kLength) != 0;
      sides += IsLeft(population[i]);
    }
  }
  // Length 0 is drawn next to never; the side is drawn left always.
  EXPECT_NEAR(lengths / (8.0 * kRuns), 0.25, 0.01);
  EXPECT_NEAR(sides / (8.0 * kRuns), 0.25, 0.01);
}

TEST(Breeding, AnExactCopyOfTheBranchHasItsAngleDrawnAnew) {
  GeneticSpec spec;
  spec.mutation_rate = 0;
  spec.crossover_rate = 0;
  const std::uint32_t own = DefaultTrunk(true);
  std::array<std::uint32_t, kMostMembers> population;
  Operators(spec).Breed(Two(own, own), own, BranchDraws(9), GenesBred::kAll, 8,
                        population.data());
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NE(population[i], own);
    EXPECT_EQ(WithCode(population[i], Gene::kAngle, 0), own);
  }
}

TEST(Breeding, LengthAndSideAreTheSameWithoutTheOtherGenes) {
  const Operators operators(GeneticSpec{});
  std::array<std::uint32_t, kMostMembers> all, some;
  for (int run = 0; run < 1000; ++run) {
    const BranchDraws draws(TrunkKey(run));
    const Survivors parents = Two(Mix32(1u + static_cast<unsigned>(run)),
                                  Mix32(5000u + static_cast<unsigned>(run)));
    operators.Breed(parents, parents.chromosomes[0], draws, GenesBred::kAll, 8,
                    all.data());
    operators.Breed(parents, parents.chromosomes[0], draws,
                    GenesBred::kLengthAndSide, 3, some.data());
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(CodeOf(all[i], Gene::kLength), CodeOf(some[i], Gene::kLength));
      ASSERT_EQ(IsLeft(all[i]), IsLeft(some[i]));
    }
  }
}

std::uint32_t Monopodial(std::array<std::uint32_t, 3> positions) {
  return EncodeChromosome({31, 0, true, false, 3, positions});
}
constexpr std::uint32_t kRight = 0;
const std::uint32_t kLeft = EncodeChromosome({.left = true});

TEST(Siblings, LaterOneOnTheSameSideChangesSides) {
  const std::array<std::uint32_t, 2> members = {kRight, kRight};
  const SiblingPlaces places = PlaceSiblings(Monopodial({30, 20, 0}), members);
  ASSERT_EQ(places.count, 2u);
  EXPECT_EQ(places.places[0].position, 20u);  // sorted
  EXPECT_FALSE(places.places[0].left);
  EXPECT_EQ(places.places[1].position, 30u);
  EXPECT_TRUE(places.places[1].left);
}

TEST(Siblings, ElseMovesUpElseIsDropped) {
  const std::array<std::uint32_t, 3> members = {kRight, kLeft, kRight};
  const SiblingPlaces moved = PlaceSiblings(Monopodial({20, 21, 22}), members);
  ASSERT_EQ(moved.count, 3u);
  EXPECT_EQ(moved.places[2].position, 33u);
  EXPECT_FALSE(moved.places[2].left);
  EXPECT_EQ(PlaceSiblings(Monopodial({60, 61, 62}), members).count, 2u);
}

TEST(Siblings, SympodialOnesSitAtTheTipAndAlternate) {
  const std::array<std::uint32_t, 3> members = {kLeft, kLeft, kLeft};
  const SiblingPlaces places =
      PlaceSiblings(EncodeChromosome({.count = 3}), members);
  ASSERT_EQ(places.count, 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(places.places[i].position, 63u);
    EXPECT_EQ(places.places[i].left, i % 2 == 0);
  }
}

}  // namespace
}  // namespace terrane::core
