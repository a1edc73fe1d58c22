// What the method promises of genetic trees, over 200 of them: children are
// like their parents but not copies, shares follow what is asked for, and the
// trees have the numbers of real ones. docs of the method: "How a result is
// judged".
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "core/tree/chromosome.h"
#include "core/tree/siblings.h"
#include "tests/core/whole_tree.h"
#include "tests/property/estimators.h"

namespace terrane::core {
namespace {

constexpr int kTrees = 200;

TreeSpec Relative(std::int64_t seed, int depth) {
  TreeSpec spec;
  spec.length_mode = LengthMode::kRelative;
  spec.seed = seed;
  spec.depth = depth;
  return spec;
}

// Mean over the fields of their differences, each as a share of its range.
double Distance(std::uint32_t a, std::uint32_t b) {
  double sum = 0;
  for (const GeneField& field : kGeneFields) {
    const double x = a >> field.shift & field.Largest();
    const double y = b >> field.shift & field.Largest();
    sum += std::fabs(x - y) / field.Largest();
  }
  return sum / kGenes;
}

// Of each child: its distance to its parent and to another branch of the
// parent's generation.
struct Likeness {
  std::vector<double> to_parent;
  std::vector<double> to_other;
  std::size_t copies = 0;

  void Add(std::uint32_t child, std::uint32_t parent, std::uint32_t other) {
    to_parent.push_back(Distance(child, parent));
    to_other.push_back(Distance(child, other));
    copies += child == parent;
  }
};

// The probability that a distance to a parent is the smaller one of two, ties
// half: the area under the curve of the rank test.
double Auc(const std::vector<double>& small, const std::vector<double>& large) {
  std::vector<double> sorted = large;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0;
  for (const double value : small) {
    const auto [first, last] =
        std::equal_range(sorted.begin(), sorted.end(), value);
    sum += static_cast<double>(sorted.end() - last) +
           0.5 * static_cast<double>(last - first);
  }
  return sum / static_cast<double>(small.size() * large.size());
}

// How often swapping each pair by chance gives at least the mean difference
// that was observed; a permutation test.
double PermutationP(const Likeness& likeness, int permutations) {
  std::vector<double> differences;
  double observed = 0;
  for (std::size_t i = 0; i < likeness.to_parent.size(); ++i) {
    differences.push_back(likeness.to_other[i] - likeness.to_parent[i]);
    observed += differences.back();
  }
  std::mt19937_64 random(1);
  int as_large = 0;
  for (int n = 0; n < permutations; ++n) {
    double sum = 0;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
      if (i % 64 == 0) bits = random();
      sum += (bits & 1) != 0 ? differences[i] : -differences[i];
      bits >>= 1;
    }
    as_large += sum >= observed;
  }
  return (as_large + 1.0) / (permutations + 1.0);
}

// Chromosomes as grown, or of the same skeleton with evenly drawn ones.
enum class Control { kGrown, kEven };

Likeness Measure(LengthMode mode, Control control) {
  Likeness likeness;
  std::mt19937 random(7);
  for (int seed = 0; seed < kTrees; ++seed) {
    TreeSpec spec = Relative(seed, 6);
    spec.length_mode = mode;
    SegmentBlock tree = Grow(spec);
    if (control == Control::kEven) {
      for (std::uint32_t& word : tree.chromosome) {
        word = static_cast<std::uint32_t>(random());
      }
    }
    const std::vector<int> generations = GenerationsOf(tree);
    std::map<int, std::vector<std::size_t>> rows_of;
    for (std::size_t row = 0; row < tree.rows(); ++row) {
      rows_of[generations[row]].push_back(row);
    }
    for (std::size_t row = 1; row < tree.rows(); ++row) {
      const std::size_t parent = tree.parent[row];
      const auto& peers = rows_of[generations[parent]];
      if (peers.size() < 2) continue;
      std::size_t other = parent;
      while (other == parent) other = peers[random() % peers.size()];
      likeness.Add(tree.chromosome[row], tree.chromosome[parent],
                   tree.chromosome[other]);
    }
  }
  return likeness;
}

class Similarity : public testing::TestWithParam<LengthMode> {};

TEST_P(Similarity, ChildrenAreLikeTheirParentsButNotCopies) {
  const Likeness grown = Measure(GetParam(), Control::kGrown);
  const double auc = Auc(grown.to_parent, grown.to_other);
  const double p = PermutationP(grown, 2000);
  const double copies = static_cast<double>(grown.copies) /
                        static_cast<double>(grown.to_parent.size());
  RecordProperty("auc", std::to_string(auc));
  RecordProperty("p", std::to_string(p));
  RecordProperty("copies", std::to_string(copies));
  EXPECT_GT(auc, 0.6);
  EXPECT_LT(p, 0.001);
  EXPECT_LT(copies, 0.01);
}

TEST_P(Similarity, TheControlTellsNothing) {
  const Likeness even = Measure(GetParam(), Control::kEven);
  EXPECT_NEAR(Auc(even.to_parent, even.to_other), 0.5, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Lengths, Similarity,
                         testing::Values(LengthMode::kAbsolute,
                                         LengthMode::kRelative));

// --- Shares -----------------------------------------------------------------

enum class Share { kMonopodial, kLeft };

double RealisedShare(Share share, double requested) {
  double with_flag = 0, rows = 0;
  for (int seed = 0; seed < kTrees; ++seed) {
    TreeSpec spec = Relative(seed, 6);
    const bool axis = share == Share::kMonopodial;
    (axis ? spec.genetic.monopodial_share : spec.genetic.left_share) =
        requested;
    const SegmentBlock tree = Grow(spec);
    const std::uint8_t flag = axis ? kMonopodialFlag : kLeftFlag;
    for (std::size_t row = 1; row < tree.rows(); ++row) {
      with_flag += (tree.flags[row] & flag) != 0;
    }
    rows += static_cast<double>(tree.rows() - 1);
  }
  return with_flag / rows;
}

// Siblings are made to change sides, so the left share follows less.
class Shares : public testing::TestWithParam<std::pair<Share, double>> {};

TEST_P(Shares, RiseWithTheRequestedOnes) {
  const std::vector<double> requested = {0.1, 0.3, 0.5, 0.7, 0.9};
  std::vector<double> realised;
  for (const double share : requested) {
    realised.push_back(RealisedShare(GetParam().first, share));
    if (realised.size() > 1) {
      EXPECT_GT(realised.back(), realised[realised.size() - 2] + 0.01)
          << "requested " << share;
    }
  }
  const double slope = LineSlope(requested, realised);
  RecordProperty("slope", std::to_string(slope));
  EXPECT_GT(slope, GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(AxisAndSide, Shares,
                         testing::Values(std::pair(Share::kMonopodial, 0.7),
                                         std::pair(Share::kLeft, 0.1)));

// A feature that is asked for is had: means over all branches.
TEST(Controls, MoveTheirFeatures) {
  struct Means {
    double length = 0, angle = 0, count = 0, rows = 0;
  };
  const auto means_of = [](auto change) {
    Means means;
    for (int seed = 0; seed < kTrees; ++seed) {
      TreeSpec spec = Relative(seed, 5);
      change(&spec.genetic);
      const SegmentBlock tree = Grow(spec);
      for (std::size_t row = 1; row < tree.rows(); ++row) {
        const Genes genes = DecodeChromosome(tree.chromosome[row]);
        means.length += genes.length;
        means.angle += genes.angle;
        means.count += genes.count;
      }
      means.rows += static_cast<double>(tree.rows() - 1);
    }
    means.length /= means.rows;
    means.angle /= means.rows;
    means.count /= means.rows;
    return means;
  };
  using W = Wanted;
  const auto lengths = [&](W wanted) {
    return means_of([=](GeneticSpec* s) { s->lengths = wanted; }).length;
  };
  const auto angles = [&](W wanted) {
    return means_of([=](GeneticSpec* s) { s->angles = wanted; }).angle;
  };
  const auto counts = [&](W wanted) {
    return means_of([=](GeneticSpec* s) { s->counts = wanted; }).count;
  };
  EXPECT_LT(lengths(W::kLow), lengths(W::kHigh));
  EXPECT_LT(angles(W::kLow), angles(W::kHigh));
  EXPECT_LT(counts(W::kLow), counts(W::kHigh));
  const auto rows = [&](W density) {
    return means_of([=](GeneticSpec* s) { s->density = density; }).rows;
  };
  EXPECT_LT(rows(W::kLow), rows(W::kHigh));
}

// --- The numbers of real trees ----------------------------------------------

// Strahler's order of every branch: the largest of its children's, one more
// where two have it.
double BifurcationRatio(const SegmentBlock& tree) {
  std::vector<int> order(tree.rows(), 0), with_it(tree.rows(), 0);
  for (std::size_t row = tree.rows(); row-- > 0;) {
    if (order[row] == 0) order[row] = 1;
    if (with_it[row] > 1) ++order[row];
    if (row == 0) break;
    const std::size_t parent = tree.parent[row];
    if (order[row] > order[parent]) {
      order[parent] = order[row];
      with_it[parent] = 1;
    } else if (order[row] == order[parent]) {
      ++with_it[parent];
    }
  }
  // A stream is a chain of one order: it is counted at its upper end's parent.
  std::map<int, double> streams;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    if (row == 0 || order[tree.parent[row]] != order[row]) {
      streams[order[row]] += 1;
    }
  }
  std::vector<double> orders, logs;
  for (const auto& [o, count] : streams) {
    orders.push_back(o);
    logs.push_back(std::log(count));
  }
  return std::exp(-LineSlope(orders, logs));
}

TEST(RealTrees, BifurcationRatioIsThatOfTrees) {
  double sum = 0;
  for (int seed = 0; seed < kTrees; ++seed) {
    const double ratio = BifurcationRatio(Grow(Relative(seed, 9)));
    EXPECT_GT(ratio, 1.5) << seed;
    EXPECT_LT(ratio, 6) << seed;
    sum += ratio;
  }
  RecordProperty("mean_ratio", std::to_string(sum / kTrees));
  EXPECT_GT(sum / kTrees, 2.5);
  EXPECT_LT(sum / kTrees, 5);
}

// Boxes of 1/side of the tree's width that its branches touch.
double Boxes(const SegmentBlock& tree, int side) {
  float low_x = 0, high_x = 0, high_z = 0;
  for (const Float3& p : tree.end) {
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    high_z = std::max(high_z, p.z);
  }
  const float size =
      std::max(high_x - low_x, high_z) / static_cast<float>(side);
  std::set<std::pair<int, int>> boxes;
  for (std::size_t row = 0; row < tree.rows(); ++row) {
    const Float3 a = tree.start[row], b = tree.end[row];
    const float length = std::hypot(b.x - a.x, b.z - a.z);
    const int steps = static_cast<int>(length / size * 8) + 1;
    for (int k = 0; k <= steps; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(steps);
      boxes.emplace(
          static_cast<int>(std::floor((a.x + t * (b.x - a.x)) / size)),
          static_cast<int>(std::floor((a.z + t * (b.z - a.z)) / size)));
    }
  }
  return static_cast<double>(boxes.size());
}

double BoxDimension(const SegmentBlock& tree) {
  std::vector<double> scales, counts;
  for (const int side : {8, 16, 32, 64}) {
    scales.push_back(std::log(side));
    counts.push_back(std::log(Boxes(tree, side)));
  }
  return LineSlope(scales, counts);
}

TEST(RealTrees, BoxCountingDimensionIsBetweenALineAndAPlane) {
  double sum = 0;
  for (int seed = 0; seed < kTrees; ++seed) {
    const double dimension = BoxDimension(Grow(Relative(seed, 8)));
    EXPECT_GT(dimension, 1.05) << seed;
    EXPECT_LT(dimension, 1.9) << seed;
    sum += dimension;
  }
  RecordProperty("mean_dimension", std::to_string(sum / kTrees));
  EXPECT_GT(sum / kTrees, 1.2);
  TreeSpec line = Relative(0, 0);
  EXPECT_NEAR(BoxDimension(Grow(line)), 1, 0.05);
}

// --- Limits, over all trees -------------------------------------------------

TEST(Limits, HoldInEveryTree) {
  std::size_t siblings = 0, unlike = 0;
  for (int seed = 0; seed < kTrees; ++seed) {
    const SegmentBlock tree = Grow(Relative(seed, 7));
    std::map<std::pair<std::uint32_t, bool>, float> last;  // parent and side
    for (std::size_t row = 1; row < tree.rows(); ++row) {
      const std::uint32_t parent = tree.parent[row];
      const double angle =
          AngleDegOfCode(CodeOf(tree.chromosome[row], Gene::kAngle));
      ASSERT_GE(angle, 30);
      ASSERT_LE(angle, 45);
      if (parent == tree.parent[row - 1]) {
        ++siblings;
        unlike += CodeOf(tree.chromosome[row], Gene::kLength) !=
                      CodeOf(tree.chromosome[row - 1], Gene::kLength) ||
                  CodeOf(tree.chromosome[row], Gene::kAngle) !=
                      CodeOf(tree.chromosome[row - 1], Gene::kAngle);
      }
      const bool left = (tree.flags[row] & kLeftFlag) != 0;
      if ((tree.flags[parent] & kMonopodialFlag) == 0) {
        // At the tip neighbours alternate.
        ASSERT_TRUE(tree.parent[row - 1] != parent ||
                    left != ((tree.flags[row - 1] & kLeftFlag) != 0));
        continue;
      }
      const auto before = last.find({parent, left});
      if (before != last.end()) {
        ASSERT_GE(tree.attach[row] - before->second, 0.2f);
      }
      last[{parent, left}] = tree.attach[row];
    }
  }
  // Genetic siblings are not identical.
  EXPECT_GT(static_cast<double>(unlike) / static_cast<double>(siblings), 0.8);
}

}  // namespace
}  // namespace terrane::core
