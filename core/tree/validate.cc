#include "core/tree/validate.h"

#include <string>

#include "core/base/field_checks.h"
#include "core/tree/chromosome.h"
#include "core/tree/estimate.h"

namespace terrane::core {
namespace {

constexpr Range kShares{0, 1};
constexpr Range kOpenShares{0, 1, true, true};
constexpr Range kSizes{1e-3, 1e6};
constexpr Range kSizesOrNone{0, 1e6};
constexpr Range kHalfTurn{0, 180};
constexpr Range kBends{0, 2};
// Chromosome numbers are u32, counts of rows are parents' indices.
constexpr std::int64_t kMostRows = (std::int64_t{1} << 32) - 2;

void ValidateTrunk(const Path& genetic, const GeneticSpec& spec,
                   FieldChecks* checks) {
  if (spec.trunk.has_value() && CodeOf(*spec.trunk, Gene::kLength) == 0) {
    checks->Violate(genetic.Field("trunk"),
                    "must have a length code in [1, 31] (bits 0-4), got 0");
  }
}

// Both ends of a range of codes.
void ValidateEnds(const Path& genetic, const char* min_name, double min,
                  const char* max_name, double max, const Range& range,
                  FieldChecks* checks) {
  const bool good = checks->Number(genetic.Field(min_name), min, range) &
                    checks->Number(genetic.Field(max_name), max, range);
  if (good && max < min) {
    checks->Violate(genetic.Field(max_name),
                    std::string("must be at least ") + min_name + ", " +
                        NumberText(min) + ", got " + NumberText(max));
  }
}

// What shapes lengths with RELATIVE and must be left alone with ABSOLUTE.
void ValidateRelative(const Path& path, const TreeSpec& tree,
                      FieldChecks* checks) {
  const auto check = [&](const char* name, double value, const Range& range,
                         double neutral) {
    const bool good = checks->Number(path.Field(name), value, range);
    if (good && value != neutral && tree.length_mode == LengthMode::kAbsolute) {
      checks->Violate(path.Field(name), "must be " + NumberText(neutral) +
                                            " with length_mode ABSOLUTE, got " +
                                            NumberText(value));
    }
  };
  check("crown_taper", tree.genetic.crown_taper, {0, 1, false, true}, 0);
  check("lateral_share", tree.genetic.lateral_share, {0, 1, true, false}, 1);
  check("least_length", tree.genetic.least_length, kSizesOrNone, 0);
}

void ValidateGenetic(const Path& path, const TreeSpec& tree,
                     FieldChecks* checks) {
  const GeneticSpec& spec = tree.genetic;
  ValidateTrunk(path, spec, checks);
  checks->Number(path.Field("monopodial_share"), spec.monopodial_share,
                 kShares);
  checks->Number(path.Field("left_share"), spec.left_share, kShares);
  checks->Integer(path.Field("population"), spec.population, 2, kMaxPopulation);
  checks->Number(path.Field("crossover_rate"), spec.crossover_rate, kShares);
  checks->Number(path.Field("mutation_rate"), spec.mutation_rate, kShares);
  ValidateEnds(path, "angle_min_deg", spec.angle_min_deg, "angle_max_deg",
               spec.angle_max_deg, {0, 180, true, true}, checks);
  ValidateEnds(path, "ratio_min", spec.ratio_min, "ratio_max", spec.ratio_max,
               kOpenShares, checks);
  ValidateRelative(path, tree, checks);
  checks->Number(path.Field("azimuth_spread_deg"), spec.azimuth_spread_deg,
                 kHalfTurn);
}

void ValidatePlain(const Path& path, const PlainSpec& spec,
                   FieldChecks* checks) {
  checks->Number(path.Field("contraction"), spec.contraction, kOpenShares);
  checks->Number(path.Field("angle_deg"), spec.angle_deg,
                 {0, 180, false, true});
  checks->Number(path.Field("offset"), spec.offset, {0, 1, true, false});
}

void ValidateBending(const Path& path, const BendingSpec& spec,
                     FieldChecks* checks) {
  checks->Integer(path.Field("pieces"), spec.pieces, 1, kMaxPieces);
  checks->Number(path.Field("gravity"), spec.gravity, kBends);
  checks->Number(path.Field("light"), spec.light, kBends);
  checks->Number(path.Field("stiffness"), spec.stiffness, {0, 1});
}

void ValidateLeaves(const Path& path, const LeafSpec& spec,
                    FieldChecks* checks) {
  checks->Integer(path.Field("count"), spec.count, 1, 64);
  checks->Number(path.Field("size_share"), spec.size_share,
                 {0, 10, true, false});
  checks->Number(path.Field("size"), spec.size, kSizesOrNone);
  checks->Number(path.Field("angle_deg"), spec.angle_deg, kHalfTurn);
  checks->Number(path.Field("size_variation"), spec.size_variation,
                 {0, 1, false, true});
  checks->Integer(path.Field("generations"), spec.generations, 1,
                  kMaxTreeDepth + 1);
}

// What one form cannot have.
void ValidateForm(const Path& root, const TreeSpec& spec, FieldChecks* checks) {
  if (spec.form == TreeForm::kGenetic) return;
  const std::string name =
      spec.form == TreeForm::kPlain ? "a plain tree" : "a Cantor set";
  if (spec.dimensions == 3) {
    checks->Violate(root.Field("dimensions"),
                    "must be 2 for " + name + ", got 3");
  }
  if (spec.form == TreeForm::kCantor && spec.bending.pieces > 1) {
    const Path bending = root.Field("bending");
    checks->Violate(bending.Field("pieces"),
                    "must be 1 for " + name + ", got " +
                        std::to_string(spec.bending.pieces));
  }
  if (spec.form == TreeForm::kCantor && spec.leaves.has_value()) {
    checks->Violate(root.Field("leaves"), "must not be set for " + name);
  }
}

void ValidateSize(const Path& root, const TreeSpec& spec,
                  const TreeLimits& limits, FieldChecks* checks) {
  const TreeEstimate estimate = EstimateTree(spec);
  const std::int64_t most = std::min(limits.max_segments, kMostRows);
  const std::string advice = "; lower it or set max_segments";
  if (estimate.segments_most > most) {
    checks->Violate(root.Field("depth"),
                    "must give at most " + std::to_string(most) +
                        " segments, got up to " +
                        std::to_string(estimate.segments_most) + advice);
  } else if (estimate.bytes_most > limits.max_bytes) {
    checks->Violate(root.Field("depth"),
                    "must give at most " + std::to_string(limits.max_bytes) +
                        " bytes, got up to " +
                        std::to_string(estimate.bytes_most) + advice);
  }
}

}  // namespace

void ValidateTreeSpec(const TreeSpec& spec, const TreeLimits& limits,
                      const std::string& prefix, Violations* violations) {
  const Path root(&prefix);
  FieldChecks checks(violations);
  const std::size_t before = violations->total();
  checks.Integer(root.Field("dimensions"), spec.dimensions, 2, 3);
  checks.Integer(root.Field("depth"), spec.depth, 0, kMaxTreeDepth);
  checks.Integer(root.Field("max_segments"), spec.max_segments, 0, kMostRows);
  checks.Number(root.Field("trunk_length"), spec.trunk_length, kSizes);
  checks.Number(root.Field("trunk_radius"), spec.trunk_radius, kSizes);
  checks.Number(root.Field("pipe_exponent"), spec.pipe_exponent, {1, 4});
  ValidateGenetic(root.Field("genetic"), spec, &checks);
  ValidatePlain(root.Field("plain"), spec.plain, &checks);
  ValidateBending(root.Field("bending"), spec.bending, &checks);
  if (spec.leaves.has_value()) {
    ValidateLeaves(root.Field("leaves"), *spec.leaves, &checks);
  }
  ValidateForm(root, spec, &checks);
  if (violations->total() == before) ValidateSize(root, spec, limits, &checks);
}

}  // namespace terrane::core
