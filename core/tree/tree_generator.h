// TreeGenerator: grows a tree breadth-first and gives its rows in blocks.
//
// A queue replaces recursion. Branches wait in it in the order of growth; the
// generator takes the first, breeds its children one generation ahead (so that
// its end radius and its `terminal` flag are final), writes its rows and queues
// the children. The printed loop forgets to count a branch of length 0 and then
// never ends; here such a branch is not grown at all.
//
// Memory: the branches that wait, at most the largest generation, with one
// population for each family: at most QueueBytesOfBranch (core/tree/estimate.h)
// each, some 0.1 KB, and a few chunks. Nothing of what has been given is kept.
// Threads: a generator belongs to one thread; the Tree it grows is shared.
// Errors: see Next. Determinism: see core/tree/tree.h.
#ifndef TERRANE_CORE_TREE_TREE_GENERATOR_H_
#define TERRANE_CORE_TREE_TREE_GENERATOR_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "absl/status/status.h"
#include "core/mesh/segment_block.h"
#include "core/tree/branch.h"
#include "core/tree/chunk_queue.h"
#include "core/tree/operators.h"
#include "core/tree/pieces.h"
#include "core/tree/tree.h"

namespace terrane::core {

// The largest block stays under 1 MiB in bytes.
struct BlockSizes {
  std::size_t first_rows = 256;  // soon on the way
  std::size_t rows = 16'384;
};

class TreeGenerator {
 public:
  // Rows before `from_row` are grown but not given: a stream that broke off is
  // resumed at its next row. `sizes` are at least 1.
  explicit TreeGenerator(std::shared_ptr<const Tree> tree,
                         std::int64_t from_row = 0, BlockSizes sizes = {});

  // Whether all rows have been given.
  bool Done() const { return done_; }

  // Bytes that the queue has now.
  std::int64_t QueueBytes() const {
    return static_cast<std::int64_t>(branches_.bytes() + populations_.bytes());
  }

  // Replaces `block` by the next rows: none when the tree is done. A block
  // never parts the pieces of a branch, unless from_row or max_segments does.
  // Errors: CANCELLED when `stop` was asked to, polled at least every
  // millisecond; the block then holds the rows up to there, and another call
  // goes on behind them. INVALID_ARGUMENT naming "from_row" when the tree has
  // fewer rows.
  absl::Status Next(std::stop_token stop, SegmentBlock* block);

 private:
  void Grow(SegmentBlock* block);
  // Whether the children of the branch in hand will be reached.
  bool WillGrow() const;
  // Breeds the children of a branch, or only what its own row takes of them.
  void PlanChildren(const Branch& branch, bool will_grow);
  // False when max_segments cuts the branch short.
  bool WriteRows(const Branch& branch, SegmentBlock* block);
  void QueueChildren(const Branch& branch, std::int64_t first_row);
  void EndGeneration(SegmentBlock* block);
  float RadiusOfPipes(float pipes) const;

  std::shared_ptr<const Tree> tree_;
  const TreeSpec& spec_;
  const std::int64_t from_row_;
  const std::int64_t end_row_;
  BlockSizes sizes_;
  bool gave_first_ = false;
  bool done_ = false;

  ChunkQueue<Branch> branches_{1};
  // Of the families of the branches that wait, in whole batches.
  ChunkQueue<std::uint32_t> populations_;
  int generation_ = 0;
  std::size_t left_in_generation_ = 1;
  std::int64_t row_ = 0;
  // max_segments: branches that no row is left for are not queued, so a
  // generation may be queued in part.
  bool is_partial_ = false;
  bool next_is_partial_ = false;

  // Of the family and the branch in hand.
  Survivors survivors_;
  std::array<std::uint32_t, kMostMembers> members_;
  ChildPlan plan_;
  Pieces pieces_;
};

}  // namespace terrane::core

#endif  // TERRANE_CORE_TREE_TREE_GENERATOR_H_
