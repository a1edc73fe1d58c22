#include "server/actor/tree_run.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "core/base/violations.h"
#include "core/tree/leaves.h"
#include "server/actor/headed_run.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

// Of a message: 44 bytes each.
constexpr std::size_t kMostLeaves = 16'384;

absl::Status PastTheEnd(const char* field, std::int64_t asked,
                        std::int64_t total) {
  return core::ViolationError(field, "must be in [0, " + std::to_string(total) +
                                         "], got " + std::to_string(asked));
}

// What growing all of a tree takes, at most.
double SecondsOf(const core::Tree& tree, const CostMeter& meter) {
  return meter.Seconds(tree.estimate().segments_most);
}

class TreeRun : public HeadedRun<v1::StreamTreeResponse, v1::TreeHeader> {
 public:
  TreeRun(ChosenTree chosen, std::int64_t from_row,
          std::shared_ptr<CostMeter> meter)
      : HeadedRun(std::move(chosen.header), SecondsOf(*chosen.tree, *meter)),
        generator_(std::move(chosen.tree), from_row, {}, std::move(meter)),
        from_row_(from_row) {}

 private:
  bool AllMade() const override { return generator_.Done(); }

  absl::Status NextPart(std::stop_token stop,
                        v1::StreamTreeResponse* message) override {
    const absl::Status status = generator_.Next(std::move(stop));
    if (!status.ok()) return status;
    SetItems(static_cast<std::int64_t>(generator_.block().rows()));
    v1::SegmentRows* const rows = message->mutable_segments();
    WriteSegments(generator_.block(), rows);
    // Resumed at the end: a block of no rows, where they would be.
    if (rows->rows() == 0) rows->set_first_row(from_row_);
    return absl::OkStatus();
  }

  MeteredGenerator generator_;
  const std::int64_t from_row_;
};

class LeafRun : public HeadedRun<v1::StreamTreeLeavesResponse, v1::TreeHeader> {
 public:
  LeafRun(ChosenTree chosen, std::int64_t from_leaf,
          std::shared_ptr<CostMeter> meter)
      : HeadedRun(std::move(chosen.header), SecondsOf(*chosen.tree, *meter)),
        tree_(chosen.tree),
        generator_(std::move(chosen.tree), 0,
                   LeafBlockSizes(*tree_->spec().leaves), std::move(meter)),
        from_leaf_(from_leaf) {}

 private:
  bool AllMade() const override { return generator_.Done(); }

  // Blocks of rows without leaves, and leaves before from_leaf, are passed
  // over.
  absl::Status NextPart(std::stop_token stop,
                        v1::StreamTreeLeavesResponse* message) override {
    leaves_ = {};
    std::int64_t first = next_leaf_;
    while (leaves_.count() == 0 && !generator_.Done()) {
      absl::Status status = generator_.Next(stop);
      if (status.ok()) {
        status = core::PlaceLeaves(tree_->spec(), generator_.block(), stop,
                                   &leaves_);
      }
      if (!status.ok()) return status;
      first = next_leaf_;
      next_leaf_ += static_cast<std::int64_t>(leaves_.count());
      if (first < from_leaf_) {
        const std::int64_t skipped = std::min(from_leaf_, next_leaf_) - first;
        DropFirst(static_cast<std::size_t>(skipped));
        first += skipped;
      }
    }
    if (generator_.Done() && next_leaf_ < from_leaf_) {
      return PastTheEnd("from_leaf", from_leaf_, next_leaf_);
    }
    SetItems(static_cast<std::int64_t>(leaves_.count()));
    WriteLeaves(leaves_, first, message->mutable_leaves());
    return absl::OkStatus();
  }

  void DropFirst(std::size_t count) {
    const auto drop = [count](auto* column) {
      column->erase(column->begin(),
                    column->begin() + static_cast<std::ptrdiff_t>(count));
    };
    drop(&leaves_.row);
    drop(&leaves_.position);
    drop(&leaves_.direction);
    drop(&leaves_.normal);
    drop(&leaves_.size);
  }

  const std::shared_ptr<const core::Tree> tree_;
  MeteredGenerator generator_;
  const std::int64_t from_leaf_;
  core::LeafBlock leaves_;
  std::int64_t next_leaf_ = 0;
};

class TubeRun : public HeadedRun<v1::StreamTreeMeshResponse, v1::TreeHeader> {
 public:
  TubeRun(v1::TreeHeader header, std::shared_ptr<const core::Tree> tree,
          core::TreeMesher mesher, std::int64_t first_block,
          std::shared_ptr<CostMeter> meter)
      : HeadedRun(std::move(header), SecondsOf(*tree, *meter)),
        generator_(std::move(tree), 0, {}, std::move(meter)),
        mesher_(std::move(mesher)),
        first_block_(first_block) {}

 private:
  bool AllMade() const override {
    return generator_.Done() && next_row_ == generator_.block().rows();
  }

  absl::Status NextPart(std::stop_token stop,
                        v1::StreamTreeMeshResponse* message) override {
    for (; index_ < first_block_; ++index_) {
      if (AllMade()) return PastTheEnd("first_block", first_block_, index_);
      const absl::Status status = NextMesh(stop);
      if (!status.ok()) return status;
    }
    if (AllMade()) {
      mesh_ = {};
    } else {
      const absl::Status status = NextMesh(stop);
      if (!status.ok()) return status;
    }
    SetItems(static_cast<std::int64_t>(mesh_.positions.size()));
    WriteTubes(mesh_, index_, message->mutable_block());
    ++index_;
    return absl::OkStatus();
  }

  absl::Status NextMesh(std::stop_token stop) {
    if (next_row_ == generator_.block().rows()) {
      const absl::Status status = generator_.Next(stop);
      if (!status.ok()) return status;
      next_row_ = 0;
    }
    return mesher_.Next(generator_.block(), stop,
                        core::TreeMesher::kBlockVertices, &next_row_, &mesh_);
  }

  MeteredGenerator generator_;
  const core::TreeMesher mesher_;
  const std::int64_t first_block_;
  core::Mesh mesh_;
  std::size_t next_row_ = 0;
  std::int64_t index_ = 0;
};

}  // namespace

core::BlockSizes LeafBlockSizes(const core::LeafSpec& leaves) {
  const std::size_t rows = std::max<std::size_t>(
      1, kMostLeaves / static_cast<std::size_t>(leaves.count));
  return {std::min<std::size_t>(rows, 256), rows};
}

std::unique_ptr<MessageRun<v1::StreamTreeResponse>> MakeTreeRun(
    ChosenTree chosen, std::int64_t from_row,
    std::shared_ptr<CostMeter> meter) {
  return std::make_unique<TreeRun>(std::move(chosen), from_row,
                                   std::move(meter));
}

std::unique_ptr<MessageRun<v1::StreamTreeLeavesResponse>> MakeLeafRun(
    ChosenTree chosen, std::int64_t from_leaf,
    std::shared_ptr<CostMeter> meter) {
  return std::make_unique<LeafRun>(std::move(chosen), from_leaf,
                                   std::move(meter));
}

OpenedRun<v1::StreamTreeMeshResponse> MakeTubeRun(
    ChosenTree chosen, const core::TubeSpec& tubes, std::int64_t first_block,
    std::shared_ptr<CostMeter> meter) {
  auto mesher = core::TreeMesher::Create(tubes);
  if (!mesher.ok()) return mesher.status();
  std::shared_ptr<const core::Tree> tree = std::move(chosen.tree);
  if (tubes.last_generation < tree->spec().depth) {
    // What the mesh leaves out need not grow: depth says only where rows end.
    core::TreeSpec spec = tree->spec();
    spec.depth = tubes.last_generation;
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    auto shorter = core::Tree::Create(spec, {kMost, kMost});
    if (!shorter.ok()) return shorter.status();
    tree = *std::move(shorter);
  }
  return std::make_unique<TubeRun>(std::move(chosen.header), std::move(tree),
                                   *std::move(mesher), first_block,
                                   std::move(meter));
}

}  // namespace terrane::server
