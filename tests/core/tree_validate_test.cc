// Every rule of a TreeSpec, one case each: the field, its range and the value.
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/tree/tree.h"
#include "core/tree/tree_mesh.h"
#include "core/tree/validate.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace terrane::core {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Violation> Validate(const TreeSpec& spec,
                                const TreeLimits& limits = {}) {
  Violations violations;
  ValidateTreeSpec(spec, limits, "", &violations);
  return violations.kept();
}

struct TreeRule {
  std::string name;
  std::function<void(TreeSpec*)> breaks;
  std::string field;
  std::string description;
};

std::string TreeRuleName(const ::testing::TestParamInfo<TreeRule>& rule) {
  return rule.param.name;
}

class TreeRuleTest : public ::testing::TestWithParam<TreeRule> {};

TEST_P(TreeRuleTest, NamesTheFieldTheRangeAndTheValue) {
  TreeSpec spec;
  GetParam().breaks(&spec);
  EXPECT_THAT(Validate(spec),
              ElementsAre(AllOf(Field(&Violation::field, GetParam().field),
                                Field(&Violation::description,
                                      HasSubstr(GetParam().description)))));
  EXPECT_EQ(Tree::Create(spec).status().code(),
            absl::StatusCode::kInvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(
    All, TreeRuleTest,
    ::testing::Values(
        TreeRule{"Dimensions", [](TreeSpec* s) { s->dimensions = 4; },
                 "dimensions", "must be in [2, 3], got 4"},
        TreeRule{"DepthLow", [](TreeSpec* s) { s->depth = -1; }, "depth",
                 "must be in [0, 32], got -1"},
        TreeRule{"DepthHigh", [](TreeSpec* s) { s->depth = 33; }, "depth",
                 "must be in [0, 32], got 33"},
        TreeRule{"MaxSegments", [](TreeSpec* s) { s->max_segments = -5; },
                 "max_segments", "must be in [0, 4294967294], got -5"},
        TreeRule{"TrunkOfLengthZero", [](TreeSpec* s) { s->trunk_length = 0; },
                 "trunk_length", "must be in [0.001, 1e+06], got 0"},
        TreeRule{"TrunkNan", [](TreeSpec* s) { s->trunk_length = kNan; },
                 "trunk_length", "got nan"},
        TreeRule{"Radius", [](TreeSpec* s) { s->trunk_radius = -1; },
                 "trunk_radius", "got -1"},
        TreeRule{"Exponent", [](TreeSpec* s) { s->pipe_exponent = 0.5; },
                 "pipe_exponent", "must be in [1, 4], got 0.5"},
        TreeRule{"TrunkChromosome",
                 [](TreeSpec* s) { s->genetic.trunk = 0xFFFFFFE0u; },
                 "genetic.trunk", "length code in [1, 31] (bits 0-4), got 0"},
        TreeRule{"MonopodialShare",
                 [](TreeSpec* s) { s->genetic.monopodial_share = 1.1; },
                 "genetic.monopodial_share", "must be in [0, 1], got 1.1"},
        TreeRule{"LeftShare", [](TreeSpec* s) { s->genetic.left_share = -0.1; },
                 "genetic.left_share", "must be in [0, 1], got -0.1"},
        TreeRule{"LeftShareNan",
                 [](TreeSpec* s) { s->genetic.left_share = kNan; },
                 "genetic.left_share", "must be in [0, 1], got nan"},
        TreeRule{"PopulationLow",
                 [](TreeSpec* s) { s->genetic.population = 1; },
                 "genetic.population", "must be in [2, 64], got 1"},
        TreeRule{"PopulationHigh",
                 [](TreeSpec* s) { s->genetic.population = 65; },
                 "genetic.population", "must be in [2, 64], got 65"},
        TreeRule{"Crossover",
                 [](TreeSpec* s) { s->genetic.crossover_rate = 2; },
                 "genetic.crossover_rate", "must be in [0, 1], got 2"},
        TreeRule{"Mutation", [](TreeSpec* s) { s->genetic.mutation_rate = -1; },
                 "genetic.mutation_rate", "must be in [0, 1], got -1"},
        TreeRule{"AngleNan",
                 [](TreeSpec* s) { s->genetic.angle_min_deg = kNan; },
                 "genetic.angle_min_deg", "must be in (0, 180), got nan"},
        TreeRule{"AnglesSwapped",
                 [](TreeSpec* s) { s->genetic.angle_max_deg = 20; },
                 "genetic.angle_max_deg",
                 "must be at least angle_min_deg, 30, got 20"},
        TreeRule{"Ratio", [](TreeSpec* s) { s->genetic.ratio_max = 1; },
                 "genetic.ratio_max", "must be in (0, 1), got 1"},
        TreeRule{"Taper", [](TreeSpec* s) { s->genetic.crown_taper = 0.5; },
                 "genetic.crown_taper",
                 "must be 0 with length_mode ABSOLUTE, got 0.5"},
        TreeRule{"LateralShare",
                 [](TreeSpec* s) { s->genetic.lateral_share = 0; },
                 "genetic.lateral_share", "must be in (0, 1], got 0"},
        TreeRule{"LateralShareAbsolute",
                 [](TreeSpec* s) { s->genetic.lateral_share = 0.5; },
                 "genetic.lateral_share",
                 "must be 1 with length_mode ABSOLUTE, got 0.5"},
        TreeRule{"LeastLength",
                 [](TreeSpec* s) { s->genetic.least_length = kNan; },
                 "genetic.least_length", "must be in [0, 1e+06], got nan"},
        TreeRule{"Spread",
                 [](TreeSpec* s) { s->genetic.azimuth_spread_deg = 181; },
                 "genetic.azimuth_spread_deg", "must be in [0, 180], got 181"},
        TreeRule{"Contraction", [](TreeSpec* s) { s->plain.contraction = 1; },
                 "plain.contraction", "must be in (0, 1), got 1"},
        TreeRule{"PlainAngle", [](TreeSpec* s) { s->plain.angle_deg = kNan; },
                 "plain.angle_deg", "must be in [0, 180), got nan"},
        TreeRule{"Offset", [](TreeSpec* s) { s->plain.offset = 0; },
                 "plain.offset", "must be in (0, 1], got 0"},
        TreeRule{"PlainIsFlat",
                 [](TreeSpec* s) {
                   s->form = TreeForm::kPlain;
                   s->dimensions = 3;
                 },
                 "dimensions", "must be 2 for a plain tree, got 3"},
        TreeRule{"CantorIsStraight",
                 [](TreeSpec* s) {
                   s->form = TreeForm::kCantor;
                   s->bending.pieces = 2;
                 },
                 "bending.pieces", "must be 1 for a Cantor set, got 2"},
        TreeRule{"CantorHasNoLeaves",
                 [](TreeSpec* s) {
                   s->form = TreeForm::kCantor;
                   s->leaves.emplace();
                 },
                 "leaves", "must not be set for a Cantor set"},
        TreeRule{"Pieces", [](TreeSpec* s) { s->bending.pieces = 17; },
                 "bending.pieces", "must be in [1, 16], got 17"},
        TreeRule{"Gravity", [](TreeSpec* s) { s->bending.gravity = 3; },
                 "bending.gravity", "must be in [0, 2], got 3"},
        TreeRule{"Stiffness", [](TreeSpec* s) { s->bending.stiffness = 1.5; },
                 "bending.stiffness", "must be in [0, 1], got 1.5"},
        TreeRule{"LeafSize",
                 [](TreeSpec* s) { s->leaves = LeafSpec{.size = -1}; },
                 "leaves.size", "must be in [0, 1e+06], got -1"},
        TreeRule{"LeafGenerations",
                 [](TreeSpec* s) { s->leaves = LeafSpec{.generations = 0}; },
                 "leaves.generations", "must be in [1, 33], got 0"},
        TreeRule{"Leaves",
                 [](TreeSpec* s) { s->leaves = LeafSpec{.count = 0}; },
                 "leaves.count", "must be in [1, 64], got 0"}),
    TreeRuleName);

TEST(ValidateTree, DefaultsAreValid) {
  EXPECT_THAT(Validate(TreeSpec{}), IsEmpty());
}

TEST(ValidateTree, CollectsEveryViolation) {
  TreeSpec spec;
  spec.depth = 99;
  spec.genetic.left_share = 7;
  spec.plain.offset = -1;
  EXPECT_THAT(Validate(spec), SizeIs(3));
}

TEST(ValidateTree, RefusesWhatCouldBeTooLargeBeforeAnyWork) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.depth = 32;
  EXPECT_THAT(
      Validate(spec),
      ElementsAre(Field(&Violation::description,
                        "must give at most 10000000 segments, got up to "
                        "2779530283277761; lower it or set max_segments")));
  spec.max_segments = 1'000'000;
  EXPECT_THAT(Validate(spec), IsEmpty());
  EXPECT_THAT(Validate(spec, {.max_bytes = 1000}),
              ElementsAre(Field(&Violation::description,
                                HasSubstr("at most 1000 bytes, got up to "
                                          "45000000"))));
}

TEST(EstimateTree, IsExactForPlainTreesAndABoundForOthers) {
  TreeSpec spec;
  // The length code admits 8 generations and 3,280 segments.
  spec.depth = 32;
  EXPECT_EQ(EstimateTree(spec).segments_most, 3280);
  EXPECT_EQ(EstimateTree(spec).last_generation, 7);
  spec.form = TreeForm::kPlain;
  spec.depth = 10;
  EXPECT_EQ(EstimateTree(spec).segments_most, 2047);
  EXPECT_EQ(EstimateTree(spec).bytes_most, 2047 * 45);
  spec.form = TreeForm::kGenetic;
  spec.length_mode = LengthMode::kRelative;
  spec.genetic.leader = true;
  spec.bending.pieces = 16;
  spec.depth = 32;  // beyond 2^63
  EXPECT_EQ(EstimateTree(spec).segments_most,
            std::numeric_limits<std::int64_t>::max());
}

TEST(ValidateTubes, NamesTheFieldTheRangeAndTheValue) {
  const TubeSpec bad = {.sides = 2,
                        .least_sides = 65,
                        .last_generation = -1,
                        .texture_length = kNan,
                        .texture_repeats = 0};
  Violations violations;
  ValidateTubeSpec(bad, "mesh.", &violations);
  EXPECT_THAT(
      violations.kept(),
      ElementsAre(
          Violation{"mesh.sides", "must be in [3, 64], got 2"},
          Violation{"mesh.least_sides", "must be in [3, 64], got 65"},
          Violation{"mesh.last_generation", "must be in [0, 32], got -1"},
          Violation{"mesh.texture_length",
                    "must be in [1e-06, 1e+06], got nan"},
          Violation{"mesh.texture_repeats", "must be in [1, 64], got 0"}));
}

}  // namespace
}  // namespace terrane::core
