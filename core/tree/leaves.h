// Leaves: instances at the tips of a tree, for a leaf mesh or a flower to be
// put there.
//
// Tips are the branches of the last generations and those that end; of one that
// bends its last piece, or every piece. A tip has leaves along its length, from
// base to end, turned about it by the golden
// angle (in 2-D to the two sides in turn); their sizes vary by chance, as a
// function of (seed, row, leaf). Pure function of spec and rows, safe from any
// thread; no function of the C library.
#ifndef TERRANE_CORE_TREE_LEAVES_H_
#define TERRANE_CORE_TREE_LEAVES_H_

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "absl/status/status.h"
#include "core/mesh/mesh.h"
#include "core/mesh/segment_block.h"
#include "core/tree/tree_spec.h"

namespace terrane::core {

// Placements as columns.
struct LeafBlock {
  std::vector<std::uint32_t> row;  // that the leaf sits on
  std::vector<Float3> position;    // of its base
  std::vector<Float3> direction;   // from base to tip, a unit vector
  std::vector<Float3> normal;      // of its upper face, a unit vector
  std::vector<float> size;         // length, in the spec's unit

  std::size_t count() const { return row.size(); }
};

// Replaces `leaves` by those of a block's rows. `spec.leaves` must be set.
// Errors: CANCELLED when `stop` was asked to, polled at every tip.
absl::Status PlaceLeaves(const TreeSpec& spec, const SegmentBlock& block,
                         std::stop_token stop, LeafBlock* leaves);

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_LEAVES_H_
