#include "core/tree/estimate.h"

#include <algorithm>
#include <limits>

#include "core/mesh/segment_block.h"
#include "core/tree/branch.h"
#include "core/tree/chromosome.h"
#include "core/tree/genetic_kernels.h"

namespace terrane::core {
namespace {

// A ratio of close to a third, the strict one.
constexpr std::uint32_t kCantorTrunkLength = 15;

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

// Of numbers that are not negative.
std::int64_t Times(std::int64_t a, std::int64_t b) {
  return b != 0 && a > kMost / b ? kMost : a * b;
}
std::int64_t Plus(std::int64_t a, std::int64_t b) {
  return a > kMost - b ? kMost : a + b;
}

// ABSOLUTE: a generation whose largest length code is 0 has no rows.
int LastGeneration(const TreeSpec& spec) {
  if (spec.form != TreeForm::kGenetic ||
      spec.length_mode == LengthMode::kRelative) {
    return spec.depth;
  }
  int generation = 0;
  std::uint32_t code = CodeOf(TrunkChromosome(spec), Gene::kLength);
  while (generation < spec.depth && LargestChildLength(code) > 0) {
    code = LargestChildLength(code);
    ++generation;
  }
  return generation;
}

}  // namespace

std::uint32_t TrunkChromosome(const TreeSpec& spec) {
  if (spec.genetic.trunk.has_value()) return *spec.genetic.trunk;
  const std::uint32_t trunk = DefaultTrunk(spec.genetic.monopodial_share > 0);
  return spec.form == TreeForm::kCantor
             ? WithCode(trunk, Gene::kLength, kCantorTrunkLength)
             : trunk;
}

std::int64_t QueueBytesOfBranch(const TreeSpec& spec) {
  const std::size_t members =
      spec.form == TreeForm::kPlain
          ? 0
          : WholeBatches(static_cast<std::size_t>(spec.genetic.population));
  return static_cast<std::int64_t>(sizeof(Branch) +
                                   members * sizeof(std::uint32_t));
}

int MostChildren(const TreeSpec& spec) {
  if (spec.form != TreeForm::kGenetic) return 2;
  return kPositions + (spec.genetic.leader ? 1 : 0);
}

TreeEstimate EstimateTree(const TreeSpec& spec) {
  TreeEstimate estimate;
  estimate.last_generation = LastGeneration(spec);
  std::int64_t generation = 1;
  std::int64_t branches = 1;
  for (int g = 1; g <= estimate.last_generation; ++g) {
    generation = Times(generation, MostChildren(spec));
    branches = Plus(branches, generation);
  }
  std::int64_t rows = Times(branches, spec.bending.pieces);
  if (spec.max_segments > 0) {
    rows = std::min(rows, spec.max_segments);
    // No branch is queued that no row is left for, but for one's siblings.
    generation = std::min(generation, Plus(rows, MostChildren(spec)));
  }
  estimate.segments_most = rows;
  estimate.bytes_most = Times(rows, SegmentBytes(spec.dimensions));
  estimate.queue_bytes_most = Times(generation, QueueBytesOfBranch(spec));
  return estimate;
}

}  // namespace terrane::core
