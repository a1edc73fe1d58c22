// The generator's rows: the plain tree against its maps, the genetic tree's
// geometry against its chromosomes, radii, bending, blocks, stops and limits.
#include "core/tree/tree_generator.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/mesh/float3.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/core/whole_tree.h"

namespace terrane::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

TreeSpec Relative(int depth, int dimensions, std::int64_t seed = 1) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.depth = depth;
  spec.dimensions = dimensions;
  spec.seed = seed;
  return spec;
}

double LengthOf(const SegmentBlock& tree, std::size_t row) {
  return static_cast<double>(Length(tree.end[row] - tree.start[row]));
}

// Between the directions of two rows, in degrees.
double AngleBetween(const SegmentBlock& tree, std::size_t a, std::size_t b) {
  const auto dot = static_cast<double>(
      Dot(tree.end[a] - tree.start[a], tree.end[b] - tree.start[b]));
  return std::acos(std::clamp(dot / (LengthOf(tree, a) * LengthOf(tree, b)),
                              -1.0, 1.0)) *
         180 / kPi;
}

struct Point {
  double x, y;
};

// The corrected maps of the paper, on the trunk from (0, 0) to (0, length).
Point MapChild(bool left, Point p, double s, double degrees, double a) {
  const double c = std::cos(degrees * kPi / 180);
  const double n = std::sin(degrees * kPi / 180);
  if (left) return {s * (p.x * c - p.y * n), s * (p.x * n + p.y * c) + a};
  return {s * (p.x * c + p.y * n), s * (-p.x * n + p.y * c) + a};
}

// A branch is the trunk's image under the maps of its ancestors, its own last.
void ExpectImagesOfTheTrunk(const TreeSpec& spec) {
  const SegmentBlock tree = Grow(spec);
  const double offset = spec.plain.offset * spec.trunk_length;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    Point start = {0, 0}, end = {0, spec.trunk_length};
    for (std::uint32_t at = static_cast<std::uint32_t>(row);
         tree.parent[at] != kNoParent; at = tree.parent[at]) {
      const bool left = (tree.flags[at] & kLeftFlag) != 0;
      for (Point* p : {&start, &end}) {
        *p = MapChild(left, *p, spec.plain.contraction, spec.plain.angle_deg,
                      offset);
      }
    }
    ASSERT_NEAR(static_cast<double>(tree.start[row].x), start.x, 1e-3);
    ASSERT_NEAR(static_cast<double>(tree.start[row].z), start.y, 1e-3);
    ASSERT_NEAR(static_cast<double>(tree.end[row].x), end.x, 1e-3);
    ASSERT_NEAR(static_cast<double>(tree.end[row].z), end.y, 1e-3);
    ASSERT_EQ(tree.start[row].y, 0);
  }
}

TEST(PlainTree, IsTheAttractorOfItsMaps) {
  TreeSpec spec;
  spec.form = TreeForm::kPlain;
  spec.depth = 8;
  ExpectImagesOfTheTrunk(spec);  // 45 degrees: the printed map is singular
  spec.plain = {0.6, 25, 1};
  ExpectImagesOfTheTrunk(spec);
  spec.plain = {0.65, 40, 0.55};  // monopodial
  ExpectImagesOfTheTrunk(spec);
}

TEST(PlainTree, SiblingsAreIdentical) {
  TreeSpec spec;
  spec.form = TreeForm::kPlain;
  const SegmentBlock tree = Grow(spec);
  EXPECT_EQ(tree.rows(), 255u);
  for (std::size_t row = 1; row < tree.rows(); row += 2) {
    EXPECT_EQ(tree.radius_start[row], tree.radius_start[row + 1]);
    EXPECT_NEAR(LengthOf(tree, row) / LengthOf(tree, row + 1), 1, 1e-4);
    EXPECT_NEAR(AngleBetween(tree, row, tree.parent[row]), 45, 0.02);
  }
}

TEST(GeneticTree, StartsWithTheTrunk) {
  const SegmentBlock tree = Grow(TreeSpec{});
  EXPECT_EQ(tree.parent[0], kNoParent);
  EXPECT_EQ(tree.start[0], (Float3{0, 0, 0}));
  EXPECT_EQ(tree.end[0], (Float3{0, 0, 310}));
  EXPECT_EQ(tree.radius_start[0], 15.5f);
  EXPECT_EQ(tree.chromosome[0], DefaultTrunk(true));
  EXPECT_EQ(tree.flags[0], kMonopodialFlag);
  // Its children sit at 30, 42 and 56 of 63.
  EXPECT_EQ(tree.attach[1], 30.0f / 63);
  EXPECT_EQ(tree.attach[2], 42.0f / 63);
  EXPECT_EQ(tree.attach[3], 56.0f / 63);
}

// What the chromosome says is what the geometry is.
void ExpectGeometryOfChromosomes(const TreeSpec& spec) {
  const SegmentBlock tree = Grow(spec);
  ASSERT_GT(tree.rows(), 10u);
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    const std::size_t parent = tree.parent[row];
    const Genes genes = DecodeChromosome(tree.chromosome[row]);
    const Genes above = DecodeChromosome(tree.chromosome[parent]);
    ASSERT_EQ((tree.flags[row] & kLeftFlag) != 0, genes.left);
    ASSERT_EQ((tree.flags[row] & kMonopodialFlag) != 0, genes.monopodial);
    const double length = LengthOf(tree, row);
    if (spec.length_mode == LengthMode::kAbsolute) {
      ASSERT_LE(genes.length, LargestChildLength(above.length));
      ASSERT_NEAR(length, LengthOfCode(genes.length), 0.01);
    } else {
      ASSERT_NEAR(length / LengthOf(tree, parent),
                  0.35 + 0.35 * genes.length / 31, 2e-3);
    }
    if (length > 1) {
      ASSERT_NEAR(AngleBetween(tree, row, parent), AngleDegOfCode(genes.angle),
                  0.1);
    }
    ASSERT_TRUE(above.monopodial || tree.attach[row] == 1);
    const Float3 base =
        tree.start[parent] +
        tree.attach[row] * (tree.end[parent] - tree.start[parent]);
    ASSERT_LT(Length(base - tree.start[row]), 1e-3f);
  }
}

TEST(GeneticTree, HasTheGeometryOfItsChromosomes) {
  for (std::int64_t seed = 0; seed < 20; ++seed) {
    TreeSpec spec;
    spec.seed = seed;
    ExpectGeometryOfChromosomes(spec);
    spec.dimensions = 3;
    ExpectGeometryOfChromosomes(spec);
    ExpectGeometryOfChromosomes(Relative(6, 2, seed));
    ExpectGeometryOfChromosomes(Relative(6, 3, seed));
  }
}

TEST(GeneticTree, LiesInThePlaneIn2DAndHasTheSameBranchesIn3D) {
  const SegmentBlock flat = Grow(Relative(7, 2));
  const SegmentBlock solid = Grow(Relative(7, 3));
  EXPECT_TRUE(std::all_of(flat.end.begin(), flat.end.end(),
                          [](const Float3& p) { return p.y == 0; }));
  EXPECT_EQ(flat.parent, solid.parent);
  EXPECT_EQ(flat.chromosome, solid.chromosome);
  EXPECT_EQ(flat.radius_start, solid.radius_start);
  EXPECT_TRUE(flat.extension.empty());
  EXPECT_EQ(solid.extension.size(), solid.rows());
}

TEST(GeneticTree, AzimuthsStepByTheGoldenAngleWithinTheSpread) {
  const SegmentBlock tree = Grow(Relative(8, 3));
  std::vector<int> children(tree.rows());
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    const std::size_t parent = tree.parent[row];
    const double index = ++children[parent];
    const double sign = IsLeft(tree.chromosome[parent]) ? -1 : 1;
    const auto turned =
        static_cast<double>(tree.extension[row] - tree.extension[parent]);
    const double off = turned / 4294967296.0 - sign * index * 0.3819660113;
    ASSERT_LE(std::fabs(off - std::nearbyint(off)) * 360, 20.001);
  }
}

TEST(GeneticTree, EndsByItselfWithAbsoluteLengths) {
  for (std::int64_t seed = 0; seed < 50; ++seed) {
    TreeSpec spec;
    spec.seed = seed;
    spec.depth = 32;
    const SegmentBlock tree = Grow(spec);
    EXPECT_LE(tree.rows(), 3280u);
    EXPECT_LE(tree.marks.size(), 8u);
    EXPECT_EQ(tree.marks.back().end_row,
              static_cast<std::int64_t>(tree.rows()));
  }
}

// The printed loop does not count a branch of length 0, so it waits for it for
// ever. A trunk of length code 1 has nothing but such children.
TEST(GeneticTree, BranchesOfLengthZeroDoNotHoldTheLoop) {
  TreeSpec spec;
  spec.genetic.trunk = WithCode(DefaultTrunk(true), Gene::kLength, 1);
  const SegmentBlock tree = Grow(spec);
  EXPECT_EQ(tree.rows(), 1u);
  EXPECT_NE(tree.flags[0] & kTerminalFlag, 0);
}

TEST(GeneticTree, TwigsEndOnlyWhereAsked) {
  TreeSpec spec = Relative(7, 2);
  const auto terminals = [](const SegmentBlock& tree) {
    return std::count_if(
        tree.flags.begin(), tree.flags.end(),
        [](std::uint8_t flags) { return (flags & kTerminalFlag) != 0; });
  };
  EXPECT_EQ(terminals(Grow(spec)), 0);
  spec.genetic.twigs_end = true;
  const SegmentBlock tree = Grow(spec);
  EXPECT_GT(terminals(tree), 0);
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    EXPECT_EQ(tree.flags[tree.parent[row]] & kTerminalFlag, 0);
  }
}

TEST(GeneticTree, ALeaderGoesOnStraightAtTheTip) {
  TreeSpec spec = Relative(6, 3);
  spec.genetic.leader = true;
  const SegmentBlock tree = Grow(spec);
  int leaders = 0;
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    if ((tree.flags[row] & kLeaderFlag) == 0) continue;
    ++leaders;
    const std::size_t parent = tree.parent[row];
    EXPECT_TRUE(IsMonopodial(tree.chromosome[parent]));
    EXPECT_LT(AngleBetween(tree, row, parent), 0.1);
    EXPECT_EQ(tree.attach[row], 1);
    EXPECT_NEAR(static_cast<double>(tree.radius_start[row]),
                static_cast<double>(tree.radius_end[parent]), 1e-4);
  }
  EXPECT_GT(leaders, 20);
}

TEST(GeneticTree, CrownTaperShortensLateralsTowardsTheTip) {
  TreeSpec spec = Relative(1, 2);
  const SegmentBlock even = Grow(spec);
  spec.genetic.crown_taper = 0.5;
  const SegmentBlock tapered = Grow(spec);
  for (std::size_t row = 1; row < even.rows(); ++row) {
    EXPECT_NEAR(LengthOf(tapered, row) / LengthOf(even, row),
                1 - 0.5 * static_cast<double>(even.attach[row]), 1e-4);
  }
}

TEST(GeneticTree, LateralShareShortensLateralsButNoLeader) {
  TreeSpec spec = Relative(1, 2);
  spec.genetic.leader = true;
  const SegmentBlock even = Grow(spec);
  spec.genetic.lateral_share = 0.5;
  const SegmentBlock shared = Grow(spec);
  ASSERT_EQ(shared.rows(), even.rows());
  for (std::size_t row = 1; row < even.rows(); ++row) {
    const std::size_t parent = even.parent[row];
    const double of_parent = LengthOf(shared, parent) / LengthOf(even, parent);
    const bool halved = (even.flags[row] & kLeaderFlag) == 0 &&
                        (even.flags[parent] & kMonopodialFlag) != 0;
    EXPECT_NEAR(LengthOf(shared, row) / LengthOf(even, row),
                of_parent * (halved ? 0.5 : 1), 1e-3);
  }
}

TEST(GeneticTree, NothingShorterThanTheLeastLengthGrows) {
  TreeSpec spec = Relative(1, 2);
  spec.depth = 8;
  const SegmentBlock whole = Grow(spec);
  spec.genetic.least_length = 30;
  const SegmentBlock cut = Grow(spec);
  EXPECT_LT(cut.rows(), whole.rows());
  bool ends_early = false;
  for (std::size_t row = 0; row < cut.rows(); ++row) {
    EXPECT_GE(LengthOf(cut, row), 29.99);
    ends_early = ends_early || (cut.flags[row] & kTerminalFlag) != 0;
  }
  EXPECT_TRUE(ends_early);
}

// r^Delta of a branch is that of its axis at the tip and of its children.
void ExpectConservedPipes(const TreeSpec& spec) {
  const SegmentBlock tree = Grow(spec);
  const auto pipes = [&](float radius) {
    return std::pow(static_cast<double>(radius), spec.pipe_exponent);
  };
  std::vector<double> laterals(tree.rows());
  std::vector<int> children(tree.rows());
  for (std::size_t row = 1; row < tree.rows(); ++row) {
    const std::size_t parent = tree.parent[row];
    ++children[parent];
    const bool leads = (tree.flags[row] & kLeaderFlag) != 0;
    if (!leads) laterals[parent] += pipes(tree.radius_start[row]);
    ASSERT_LE(tree.radius_start[row], tree.radius_start[parent] * 1.0001f);
  }
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    if (children[row] == 0) continue;
    const double axis = (tree.flags[row] & kMonopodialFlag) != 0
                            ? pipes(tree.radius_end[row])
                            : 0;
    const double base = pipes(tree.radius_start[row]);
    ASSERT_NEAR((laterals[row] + axis) / base, 1, 1e-4) << "row " << row;
  }
}

TEST(Radii, ConservePipesAtEveryNode) {
  for (const double exponent : {1.8, 2.0, 2.3, 3.0}) {
    for (std::int64_t seed = 0; seed < 10; ++seed) {
      TreeSpec spec = Relative(8, 3, seed);
      spec.pipe_exponent = exponent;
      ExpectConservedPipes(spec);
      spec.genetic.leader = true;
      ExpectConservedPipes(spec);
    }
    TreeSpec plain;
    plain.form = TreeForm::kPlain;
    plain.pipe_exponent = exponent;
    ExpectConservedPipes(plain);
    plain.plain.offset = 0.5;
    ExpectConservedPipes(plain);
  }
}

TEST(Bending, PiecesFollowEachOtherAndEndAsFlagged) {
  TreeSpec spec = Relative(5, 3);
  spec.bending = {4, 1, 0};
  const SegmentBlock tree = Grow(spec);
  const SegmentBlock straight = Grow(Relative(5, 3));
  ASSERT_EQ(tree.rows(), 4 * straight.rows());
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    const std::size_t piece = row % 4;
    ASSERT_EQ((tree.flags[row] & kContinuedFlag) != 0, piece < 3);
    ASSERT_EQ(tree.chromosome[row], straight.chromosome[row / 4]);
    if (piece == 0) continue;
    ASSERT_EQ(tree.parent[row], row - 1);
    ASSERT_EQ(tree.start[row], tree.end[row - 1]);
    ASSERT_EQ(tree.radius_start[row], tree.radius_end[row - 1]);
    ASSERT_EQ(tree.attach[row], 1);
  }
}

TEST(Bending, GravityLowersAndLightRaisesTheTips) {
  const auto mean_tip = [](const BendingSpec& bending) {
    TreeSpec spec = Relative(7, 3);
    spec.bending = bending;
    const SegmentBlock tree = Grow(spec);
    double sum = 0;
    for (const Float3& end : tree.end) sum += static_cast<double>(end.z);
    return sum / static_cast<double>(tree.rows());
  };
  const double straight = mean_tip({6, 0, 0});
  EXPECT_LT(mean_tip({6, 1, 0}), straight - 5);
  EXPECT_GT(mean_tip({6, 0, 1}), straight + 5);
}

TEST(Bending, WhatIsThickBendsLess) {
  TreeSpec spec = Relative(7, 3);
  // How far the first and last piece of a branch part, in degrees.
  const auto bend = [](const SegmentBlock& tree, std::size_t first) {
    return AngleBetween(tree, first, first + 5);
  };
  for (spec.seed = 0; spec.seed < 10; ++spec.seed) {
    spec.bending = {6, 1, 0};
    const SegmentBlock supple = Grow(spec);
    spec.bending.stiffness = 1;
    const SegmentBlock stiff = Grow(spec);
    // The trunk's children, which set out alike in both trees.
    const auto end = static_cast<std::size_t>(stiff.marks[1].end_row);
    for (std::size_t first = 6; first < end; first += 6) {
      const double radius = static_cast<double>(stiff.radius_start[first] /
                                                stiff.radius_start[0]);
      EXPECT_NEAR(bend(stiff, first) / bend(supple, first), 1 - radius, 0.15);
    }
  }
}

TEST(CantorSet, StrictHasThirdsAtBothEnds) {
  TreeSpec spec;
  spec.form = TreeForm::kCantor;
  spec.trunk_length = 1;
  spec.depth = 6;
  const SegmentBlock set = Grow(spec);
  ASSERT_EQ(set.rows(), 127u);
  for (std::size_t row = 1; row < set.rows(); row += 2) {
    const std::size_t parent = set.parent[row];
    const float third = (set.end[parent].x - set.start[parent].x) / 3;
    EXPECT_NEAR(static_cast<double>(set.start[row].x - set.start[parent].x), 0,
                1e-6);
    EXPECT_NEAR(static_cast<double>(set.end[row].x - set.start[row].x - third),
                0, 1e-6);
    EXPECT_NEAR(static_cast<double>(set.end[row + 1].x - set.end[parent].x), 0,
                1e-6);
    EXPECT_EQ(set.chromosome[row], 0u);
  }
}

TEST(CantorSet, StatisticalHasTwoChildrenOfAtMostAHalf) {
  TreeSpec spec;
  spec.form = TreeForm::kCantor;
  spec.cantor.statistical = true;
  spec.trunk_length = 1;
  spec.depth = 8;
  std::vector<float> ratios;
  for (spec.seed = 0; spec.seed < 20; ++spec.seed) {
    const SegmentBlock set = Grow(spec);
    ASSERT_EQ(set.rows(), 511u);
    for (std::size_t row = 1; row < set.rows() / 8; ++row) {
      const std::size_t parent = set.parent[row];
      ratios.push_back((set.end[row].x - set.start[row].x) /
                       (set.end[parent].x - set.start[parent].x));
    }
  }
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  EXPECT_LE(*high, 0.5001f);
  EXPECT_GE(*low, 0.1666f);
  EXPECT_GT(*high - *low, 0.2f);
}

TEST(Blocks, FirstIsSmallAndAllAreUnderAMebibyte) {
  auto tree = Tree::Create(Relative(12, 3));
  ASSERT_TRUE(tree.ok());
  TreeGenerator generator(*tree);
  SegmentBlock block;
  std::int64_t rows = 0;
  for (int blocks = 0; !generator.Done(); ++blocks) {
    ASSERT_TRUE(generator.Next({}, &block).ok());
    EXPECT_EQ(block.first_row, rows);
    EXPECT_LE(block.rows(), blocks == 0 ? 256u : 16384u);
    rows += static_cast<std::int64_t>(block.rows());
  }
  EXPECT_GT(rows, 30'000);
  EXPECT_LT(16384 * SegmentBytes(3), 1 << 20);
}

TEST(Blocks, MaxSegmentsCutsTheTree) {
  TreeSpec spec = Relative(9, 3);
  const SegmentBlock whole = Grow(spec);
  spec.max_segments = 1000;
  spec.bending.pieces = 1;
  const SegmentBlock cut = Grow(spec);
  ASSERT_EQ(cut.rows(), 1000u);
  EXPECT_EQ(ColumnBytes(cut, 1000), ColumnBytes(whole, 1000));
  EXPECT_LT(cut.marks.back().end_row, 1000);
}

TEST(Blocks, AStopIsHeardBetweenFewBranches) {
  auto tree = Tree::Create(Relative(12, 3));
  ASSERT_TRUE(tree.ok());
  TreeGenerator generator(*tree);
  std::stop_source source;
  source.request_stop();
  SegmentBlock block;
  EXPECT_EQ(generator.Next(source.get_token(), &block).code(),
            absl::StatusCode::kCancelled);
  EXPECT_LE(block.rows(), 128u);
  // Another call goes on behind what there is.
  SegmentBlock rest;
  ASSERT_TRUE(generator.Next({}, &rest).ok());
  EXPECT_EQ(rest.first_row, static_cast<std::int64_t>(block.rows()));
  // Also while rows are only skipped.
  TreeGenerator resumed(*tree, 100'000'000);
  EXPECT_EQ(resumed.Next(source.get_token(), &block).code(),
            absl::StatusCode::kCancelled);
}

TEST(Blocks, ResumingBeyondTheEndIsAnError) {
  auto tree = Tree::Create(Relative(3, 2));
  ASSERT_TRUE(tree.ok());
  const auto rows = static_cast<std::int64_t>(Grow(*tree).rows());
  EXPECT_EQ(Grow(*tree, rows).rows(), 0u);
  TreeGenerator generator(*tree, rows + 1);
  SegmentBlock block;
  EXPECT_EQ(generator.Next({}, &block).message(),
            "from_row: must be in [0, " + std::to_string(rows) + "], got " +
                std::to_string(rows + 1));
}

}  // namespace
}  // namespace terrane::core
