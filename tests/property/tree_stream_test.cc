// The stream of a tree, over random recipes: depths are prefixes of each other,
// blocks, threads and resuming change nothing, and every prefix is a tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/core/whole_tree.h"

namespace terrane::core {
namespace {

constexpr int kRecipes = 200 / TERRANE_REPETITION_DIVISOR;
constexpr int kDeepest = 7;

// A recipe of any kind, of depth kDeepest.
TreeSpec RandomRecipe(int index) {
  std::mt19937 random(static_cast<unsigned>(index));
  const auto chance = [&](int of) {
    return random() % static_cast<unsigned>(of) == 0;
  };
  const auto share = [&] { return static_cast<double>(random() % 101) / 100; };
  const auto wanted = [&] { return static_cast<Wanted>(random() % 3); };
  TreeSpec spec;
  spec.depth = kDeepest;
  spec.seed = static_cast<std::int64_t>(random()) << 20;
  if (chance(8)) spec.form = TreeForm::kPlain;
  if (chance(8)) spec.form = TreeForm::kCantor;
  if (spec.form == TreeForm::kGenetic && chance(2)) spec.dimensions = 3;
  if (chance(2)) spec.length_mode = LengthMode::kRelative;
  if (spec.form != TreeForm::kCantor && chance(4)) {
    spec.bending = {static_cast<int>(random() % 4) + 2, share(), share(),
                    share()};
  }
  if (chance(3)) spec.pipe_exponent = 1.8 + share();
  spec.cantor.statistical = chance(2);
  GeneticSpec& genetic = spec.genetic;
  if (chance(3)) genetic.trunk = (random() & ~31u) | (16 + random() % 16);
  genetic.monopodial_share = share();
  genetic.left_share = share();
  genetic.density = wanted();
  if (chance(3)) genetic.counts = wanted();
  if (chance(3)) genetic.population = 2 + static_cast<int>(random() % 63);
  genetic.crossover_rate = share();
  genetic.mutation_rate = share() / 4;
  genetic.twigs_end = chance(3);
  genetic.leader = chance(4);
  if (spec.length_mode == LengthMode::kRelative) {
    if (chance(3)) genetic.crown_taper = 0.9 * share();
    if (chance(3)) genetic.lateral_share = 0.2 + 0.8 * share();
    if (chance(3)) genetic.least_length = 60 * share();
  }
  return spec;
}

std::shared_ptr<const Tree> Make(TreeSpec spec, int depth) {
  spec.depth = depth;
  auto tree = Tree::Create(spec);
  EXPECT_TRUE(tree.ok()) << tree.status();
  return *tree;
}

TEST(TreeStream, ADepthIsAPrefixOfTheNextByteForByte) {
  for (int index = 0; index < kRecipes; ++index) {
    SCOPED_TRACE(index);
    const TreeSpec spec = RandomRecipe(index);
    SegmentBlock shallow = Grow(Make(spec, 0));
    for (int depth = 1; depth <= kDeepest; ++depth) {
      const SegmentBlock deep = Grow(Make(spec, depth));
      ASSERT_EQ(ColumnBytes(shallow, shallow.rows()),
                ColumnBytes(deep, shallow.rows()));
      ASSERT_LE(shallow.marks.size(), deep.marks.size());
      ASSERT_TRUE(std::equal(shallow.marks.begin(), shallow.marks.end(),
                             deep.marks.begin()));
      shallow = deep;
    }
  }
}

TEST(TreeStream, BlocksAndResumingChangeNothing) {
  for (int index = 0; index < kRecipes; ++index) {
    SCOPED_TRACE(index);
    const auto tree = Make(RandomRecipe(index), 6);
    const SegmentBlock whole = Grow(tree);
    std::mt19937 random(static_cast<unsigned>(index));
    const BlockSizes sizes = {1 + random() % 50, 1 + random() % 300};
    const SegmentBlock cut = Grow(tree, 0, sizes);
    ASSERT_EQ(ColumnBytes(whole, whole.rows()), ColumnBytes(cut, cut.rows()));
    ASSERT_EQ(whole.marks, cut.marks);
    const std::size_t from = random() % (whole.rows() + 1);
    SegmentBlock resumed = Grow(Make(RandomRecipe(index), 6), 0, sizes);
    resumed = Grow(tree, static_cast<std::int64_t>(from), sizes);
    ASSERT_EQ(resumed.rows(), whole.rows() - from);
    ASSERT_TRUE(
        std::equal(resumed.end.begin(), resumed.end.end(),
                   whole.end.begin() + static_cast<std::ptrdiff_t>(from)));
    // The marks that are still to come, and the generation it resumes in.
    for (const GenerationMark& mark : whole.marks) {
      const bool is_ahead = mark.end_row > static_cast<std::int64_t>(from);
      ASSERT_EQ(std::count(resumed.marks.begin(), resumed.marks.end(), mark),
                is_ahead ? 1 : 0);
    }
    if (resumed.rows() > 0) {
      ASSERT_EQ(resumed.first_row, static_cast<std::int64_t>(from));
      ASSERT_EQ(resumed.first_generation, GenerationsOf(whole)[from]);
    }
  }
}

TEST(TreeStream, ThreadsChangeNothing) {
  const auto tree = Make(RandomRecipe(3), 7);
  const SegmentBlock expected = Grow(tree);
  std::vector<SegmentBlock> grown(8);
  {
    std::vector<std::jthread> threads;
    for (SegmentBlock& result : grown) {
      threads.emplace_back([&result, tree] { result = Grow(tree); });
    }
  }
  for (const SegmentBlock& result : grown) {
    EXPECT_EQ(ColumnBytes(result, result.rows()),
              ColumnBytes(expected, expected.rows()));
  }
}

// One trunk, parents before their children and one generation above them (or
// the same branch's piece before), each row on its parent.
void ExpectParsesAsATree(const SegmentBlock& block, int dimensions) {
  ASSERT_EQ(block.parent[0], kNoParent);
  const std::vector<int> generations = GenerationsOf(block);
  for (std::size_t row = 1; row < block.rows(); ++row) {
    const std::size_t parent = block.parent[row];
    ASSERT_LT(parent, row);
    const bool goes_on = (block.flags[row - 1] & kContinuedFlag) != 0;
    ASSERT_EQ(generations[row], generations[parent] + (goes_on ? 0 : 1));
    ASSERT_TRUE(!goes_on || parent == row - 1);
    ASSERT_GE(generations[row], generations[row - 1]);
    ASSERT_GE(block.attach[row], 0);
    ASSERT_LE(block.attach[row], 1);
    ASSERT_EQ(block.flags[parent] & kTerminalFlag,
              goes_on ? block.flags[row] & kTerminalFlag : 0);
    for (const Float3& p : {block.start[row], block.end[row]}) {
      ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
      ASSERT_TRUE(dimensions == 3 || p.y == 0);
    }
  }
}

// The checks look only at rows before a row, so the whole stands for each of
// its prefixes.
TEST(TreeStream, EveryPrefixParsesAsATree) {
  for (int index = 0; index < kRecipes; ++index) {
    SCOPED_TRACE(index);
    const TreeSpec spec = RandomRecipe(index);
    const SegmentBlock tree = Grow(Make(spec, kDeepest));
    ExpectParsesAsATree(tree, spec.dimensions);
    EXPECT_LE(static_cast<std::int64_t>(tree.rows()),
              Make(spec, kDeepest)->estimate().segments_most);
    EXPECT_EQ(tree.marks.back().end_row,
              static_cast<std::int64_t>(tree.rows()));
  }
}

// 10^6 segments: the queue never holds more than its largest generation.
TEST(TreeStream, AMillionSegmentsStreamFromABoundedQueue) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.dimensions = 3;
  spec.depth = 32;
  spec.max_segments = 1'000'000 / TERRANE_REPETITION_DIVISOR;
  auto tree = Tree::Create(spec);
  ASSERT_TRUE(tree.ok()) << tree.status();
  TreeGenerator generator(*tree);
  SegmentBlock block;
  std::int64_t rows = 0;
  std::int64_t most_bytes = 0;
  while (!generator.Done()) {
    ASSERT_TRUE(generator.Next({}, &block).ok());
    rows += static_cast<std::int64_t>(block.rows());
    most_bytes = std::max(most_bytes, generator.QueueBytes());
  }
  EXPECT_EQ(rows, spec.max_segments);
  EXPECT_LT(most_bytes, 300 * spec.max_segments);
  EXPECT_LE(most_bytes, (*tree)->estimate().queue_bytes_most);
  RecordProperty("queue_bytes", std::to_string(most_bytes));
}

}  // namespace
}  // namespace terrane::core
