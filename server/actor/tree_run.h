// The messages of one tree: its rows, its leaves, its tubes.
//
// Each run grows the tree anew and keeps one block of it. Indices to resume
// from that the tree does not reach are INVALID_ARGUMENT, found when the tree
// has ended.
#ifndef TERRANE_SERVER_ACTOR_TREE_RUN_H_
#define TERRANE_SERVER_ACTOR_TREE_RUN_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "core/mesh/segment_block.h"
#include "core/tree/tree_generator.h"
#include "core/tree/tree_mesh.h"
#include "server/actor/tree_maker.h"

namespace terrane::server {

// A generator whose speed is measured.
class MeteredGenerator {
 public:
  MeteredGenerator(std::shared_ptr<const core::Tree> tree,
                   std::int64_t from_row, core::BlockSizes sizes,
                   std::shared_ptr<CostMeter> meter)
      : generator_(std::move(tree), from_row, sizes),
        meter_(std::move(meter)),
        skips_(from_row > 0) {}

  bool Done() const { return generator_.Done(); }
  const core::SegmentBlock& block() const { return block_; }

  // Replaces the block by the next one.
  absl::Status Next(std::stop_token stop) {
    const auto start = std::chrono::steady_clock::now();
    const absl::Status status = generator_.Next(std::move(stop), &block_);
    if (status.ok() && !skips_) {
      meter_->Add(std::chrono::steady_clock::now() - start,
                  static_cast<std::int64_t>(block_.rows()));
    }
    skips_ = false;
    return status;
  }

 private:
  core::TreeGenerator generator_;
  const std::shared_ptr<CostMeter> meter_;
  core::SegmentBlock block_;
  // The next block takes the time of all rows before it.
  bool skips_;
};

std::unique_ptr<MessageRun<v1::StreamTreeResponse>> MakeTreeRun(
    ChosenTree chosen, std::int64_t from_row, std::shared_ptr<CostMeter> meter);

// The tree has leaves.
std::unique_ptr<MessageRun<v1::StreamTreeLeavesResponse>> MakeLeafRun(
    ChosenTree chosen, std::int64_t from_leaf,
    std::shared_ptr<CostMeter> meter);

// `tubes` is valid.
OpenedRun<v1::StreamTreeMeshResponse> MakeTubeRun(
    ChosenTree chosen, const core::TubeSpec& tubes, std::int64_t first_block,
    std::shared_ptr<CostMeter> meter);

// Sizes of the blocks of rows whose leaves make one message.
core::BlockSizes LeafBlockSizes(const core::LeafSpec& leaves);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TREE_RUN_H_
