// TreeSpec: everything that determines a tree, as plain data.
//
// A spec is only data: ValidateTreeSpec (core/tree/validate.h) says what is
// wrong with it, Tree::Create refuses one that is not valid. Lengths are in the
// unit of `trunk_length`, angles in degrees. z is up; a tree of 2 dimensions
// lies in y = 0 with right along +x (the paper's y is our z).
//
// Source: Wu & Zhou, "Research on 2D fractal recursive algorithm syncretized
// genetic operation", Journal of Image and Graphics 13(8), 2008.
#ifndef TERRANE_CORE_TREE_TREE_SPEC_H_
#define TERRANE_CORE_TREE_TREE_SPEC_H_

#include <cstdint>
#include <optional>

namespace terrane::core {

// Revision of the tree algorithm: the same spec and revision give the same
// bytes everywhere. New bytes need a new revision.
inline constexpr int kTreeRevision = 1;

enum class TreeForm { kGenetic, kPlain, kCantor };

// kAbsolute: a branch is as long as its own length code says, at most 0.7 times
// its parent's code (the paper's; it ends by itself after 8 generations).
// kRelative: the code says what share of its parent's length a branch has.
enum class LengthMode { kAbsolute, kRelative };

// The direction in which selection favours a feature.
enum class Wanted { kAny, kLow, kHigh };

// What the genetic tree is grown by.
struct GeneticSpec {
  // The trunk's chromosome (core/tree/chromosome.h): length code 31, angle 0,
  // three children at 30, 42 and 56 of 63, right, and monopodial unless
  // monopodial_share is 0. A Cantor set's has length code 15, a ratio of close
  // to 1/3.
  std::optional<std::uint32_t> trunk;

  // Requested shares of branches that are monopodial and that are left, [0, 1].
  double monopodial_share = 0.5;
  double left_share = 0.5;

  // kHigh, dense: short branches at narrow angles, many of them and close
  // together; kLow, sparse: the other way round. Each feature can be asked for
  // on its own instead; what is not set follows `density`.
  Wanted density = Wanted::kAny;
  std::optional<Wanted> lengths;
  std::optional<Wanted> angles;
  std::optional<Wanted> counts;
  std::optional<Wanted> gaps;

  // Chromosomes of a population, [2, 64], and how often a field is crossed over
  // or replaced, [0, 1].
  int population = 8;
  double crossover_rate = 0.4;
  double mutation_rate = 0.05;

  // A child count of 0 ends the twig instead of counting as 1.
  bool twigs_end = false;

  // Angle codes 0 and 31 as deviations from the parent's direction, (0, 180).
  double angle_min_deg = 30;
  double angle_max_deg = 45;

  // Length codes 0 and 31 as ratios in RELATIVE, (0, 1).
  double ratio_min = 0.35;
  double ratio_max = 0.7;

  // RELATIVE: a lateral at t along its parent is shorter by this times t, [0,
  // 1): 0 leaves lengths alone, 0.9 makes a cone.
  double crown_taper = 0;

  // RELATIVE: laterals of a monopodial branch are shorter by this factor, (0,
  // 1]: little, and the axis rules the tree, as in conifers.
  double lateral_share = 1;

  // RELATIVE: a child shorter than this, in the tree's unit, is not grown, [0,
  // 10^6]. So a long axis can go on while its twigs have ended.
  double least_length = 0;

  // A monopodial branch goes on straight at its tip with a leader, beside its
  // laterals. (The paper's monopodial branch is its own axis and ends.)
  bool leader = false;

  // Largest chance deviation of an azimuth from the golden angle, [0, 180].
  double azimuth_spread_deg = 20;
};

// The paper's baseline: each branch has two children, the images of itself
// under the maps w1 and w2 with contraction s, angle theta and offset a.
struct PlainSpec {
  double contraction = 0.7;  // s, (0, 1)
  double angle_deg = 45;     // theta, [0, 180)
  // a as a share of the parent's length, (0, 1]: 1 is sympodial, less is
  // monopodial.
  double offset = 1;
};

// The paper's section 5: segments of the line, each with two children at its
// ends. Strict: every ratio is 1/3. Statistical: ratios of 1/6 to 1/2 by the
// length code, bred by the same operators with the rates of GeneticSpec.
struct CantorSpec {
  bool statistical = false;
};

// Branches as polylines. Off with one piece.
struct BendingSpec {
  int pieces = 1;      // of a branch, [1, 16]
  double gravity = 0;  // bends the level downwards, [0, 2]
  double light = 0;    // bends upwards, [0, 2]
  // How much less a thick branch bends, [0, 1]: both are multiplied by 1 minus
  // this times its radius^(Delta / 2) as a share of the trunk's.
  double stiffness = 0;
};

// Leaves as instances at the tips: branches of the last generations and
// branches that end (core/tree/leaves.h).
struct LeafSpec {
  int count = 3;                // of a tip, [1, 64]
  double size_share = 0.5;      // of the tip's length, (0, 10]
  double angle_deg = 50;        // from the tip's direction, [0, 180]
  double size_variation = 0.2;  // half the range of sizes, as a share, [0, 1)
  // Instead of size_share, in the tree's unit, the same for all tips; 0: by
  // size_share. [0, 10^6].
  double size = 0;
  int generations = 1;  // that have leaves, the last ones, [1, 33]
  // On every piece of a branch, `count` each, not on its last piece alone.
  bool every_piece = false;
};

struct TreeSpec {
  TreeForm form = TreeForm::kGenetic;
  int dimensions =
      2;  // 2 or 3; a plain tree has 2 and a Cantor set counts as 2
  std::int64_t seed = 0;
  // The last generation; the trunk is generation 0. [0, 32].
  int depth = 7;
  // Ends the tree after that many rows; 0: no end but its own.
  std::int64_t max_segments = 0;

  LengthMode length_mode = LengthMode::kAbsolute;
  double trunk_length = 310;  // the paper's 31 * 10; [0.001, 10^6]
  // At the base; a twentieth of the trunk's length. [0.001, 10^6].
  std::optional<double> trunk_radius;
  // Delta of r^Delta, which every node conserves; real trees have 1.8 to 2.3.
  // [1, 4].
  double pipe_exponent = 2;

  GeneticSpec genetic;
  PlainSpec plain;
  CantorSpec cantor;
  BendingSpec bending;
  std::optional<LeafSpec> leaves;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_TREE_SPEC_H_
