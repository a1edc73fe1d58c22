#include "server/actor/forest_run.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "core/base/field_checks.h"
#include "core/tree/leaves.h"
#include "server/actor/headed_run.h"
#include "server/actor/tree_run.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

constexpr core::Range kPlaces{-1e15, 1e15};
constexpr core::Range kScales{0, 1e6, true, false};
constexpr core::Range kTurns{-360, 360};

void ValidatePlacement(const v1::TreePlacement& placement,
                       const core::Path& path, core::FieldChecks* checks) {
  checks->Number(path.Field("x"), placement.x(), kPlaces);
  checks->Number(path.Field("y"), placement.y(), kPlaces);
  checks->Number(path.Field("z"), placement.z(), kPlaces);
  if (placement.scale() != 0) {
    checks->Number(path.Field("scale"), placement.scale(), kScales);
  }
  checks->Number(path.Field("yaw_deg"), placement.yaw_deg(), kTurns);
}

std::int64_t TreesOf(const v1::StreamForestRequest& request) {
  return request.has_seeds() ? request.seeds().count()
                             : request.placements().placements_size();
}

// Whether the number of trees is well.
bool ValidateTrees(const v1::StreamForestRequest& request, const Limits& limits,
                   const core::Path& root, core::FieldChecks* checks) {
  if (request.has_seeds()) {
    const core::Path seeds = root.Field("seeds");
    return checks->Integer(seeds.Field("count"), request.seeds().count(), 1,
                           limits.max_forest_trees);
  }
  if (!request.has_placements()) {
    checks->Violate(root.Field("trees"),
                    "must hold seeds or placements, got neither");
    return false;
  }
  const auto& placements = request.placements().placements();
  const core::Path list = root.Field("placements");
  const bool good = checks->Count(
      list.Field("placements"), static_cast<std::size_t>(placements.size()), 1,
      static_cast<std::size_t>(limits.max_forest_trees));
  for (int k = 0; good && k < placements.size(); ++k) {
    ValidatePlacement(placements[k],
                      list.Element("placements", static_cast<std::size_t>(k)),
                      checks);
  }
  return good;
}

// Blocks of rows, each with its leaves behind it when they are asked for.
class ForestRun : public HeadedRun<v1::StreamForestResponse, v1::TreeHeader> {
 public:
  ForestRun(ChosenTree chosen, const v1::StreamForestRequest& request,
            const core::TreeLimits& limits, std::shared_ptr<CostMeter> meter)
      : HeadedRun(std::move(chosen.header),
                  meter->Seconds((TreesOf(request) - request.first_tree()) *
                                 chosen.tree->estimate().segments_most)),
        spec_(chosen.tree->spec()),
        request_(request),
        limits_(limits),
        meter_(std::move(meter)),
        next_tree_(request.first_tree()) {}

 private:
  bool AllMade() const override {
    return !generator_.has_value() && next_tree_ == TreesOf(request_);
  }

  absl::Status NextPart(std::stop_token stop,
                        v1::StreamForestResponse* message) override {
    if (!generator_.has_value()) {
      const absl::Status started = StartTree();
      if (!started.ok()) return started;
    }
    v1::ForestBlock* const block = message->mutable_block();
    block->set_tree(next_tree_);
    if (leaves_.count() > 0) {
      WriteLeaves(leaves_, first_leaf_, block->mutable_leaves());
      SetItems(static_cast<std::int64_t>(leaves_.count()));
      first_leaf_ += static_cast<std::int64_t>(leaves_.count());
      leaves_ = {};
    } else {
      absl::Status status = generator_->Next(stop);
      if (status.ok() && request_.leaves()) {
        status = core::PlaceLeaves(spec_, generator_->block(), stop, &leaves_);
      }
      if (!status.ok()) return status;
      WriteSegments(generator_->block(), block->mutable_segments());
      SetItems(static_cast<std::int64_t>(generator_->block().rows()));
    }
    block->set_ends_tree(generator_->Done() && leaves_.count() == 0);
    if (block->ends_tree()) {
      generator_.reset();
      ++next_tree_;
    }
    return absl::OkStatus();
  }

  absl::Status StartTree() {
    spec_.seed = SeedOf(next_tree_);
    auto tree = core::Tree::Create(spec_, limits_);
    if (!tree.ok()) return tree.status();
    const core::BlockSizes sizes =
        request_.leaves()
            ? LeafBlockSizes(*spec_.leaves)
            : core::BlockSizes{.first_rows = kRows, .rows = kRows};
    generator_.emplace(*std::move(tree), 0, sizes, meter_);
    first_leaf_ = 0;
    return absl::OkStatus();
  }

  // A range of seeds goes on past the largest with the smallest.
  std::int64_t SeedOf(std::int64_t tree) const {
    if (!request_.has_seeds()) {
      return request_.placements().placements(static_cast<int>(tree)).seed();
    }
    return static_cast<std::int64_t>(
        static_cast<std::uint64_t>(request_.seeds().first_seed()) +
        static_cast<std::uint64_t>(tree));
  }

  static constexpr std::size_t kRows = core::BlockSizes().rows;

  core::TreeSpec spec_;
  const v1::StreamForestRequest request_;
  const core::TreeLimits limits_;
  const std::shared_ptr<CostMeter> meter_;
  std::int64_t next_tree_;
  // Of the tree in hand.
  std::optional<MeteredGenerator> generator_;
  core::LeafBlock leaves_;
  std::int64_t first_leaf_ = 0;
};

}  // namespace

void ValidateForest(const v1::StreamForestRequest& request,
                    const core::Tree* tree, const Limits& limits,
                    core::Violations* violations) {
  const std::string prefix;
  const core::Path root(&prefix);
  core::FieldChecks checks(violations);
  const bool trees_good = ValidateTrees(request, limits, root, &checks);
  const std::int64_t trees = TreesOf(request);
  checks.Integer(root.Field("first_tree"), request.first_tree(), 0,
                 trees_good ? trees : limits.max_forest_trees);
  if (tree == nullptr || !trees_good) return;
  // At most 10^6 times 2^32: no overflow.
  const std::int64_t rows = trees * tree->estimate().segments_most;
  if (rows > limits.max_forest_segments) {
    checks.Violate(root.Field("trees"),
                   "must have at most " +
                       std::to_string(limits.max_forest_segments) +
                       " segments, got up to " + std::to_string(rows) +
                       "; ask for fewer trees or set max_segments");
  }
}

std::unique_ptr<MessageRun<v1::StreamForestResponse>> MakeForestRun(
    ChosenTree chosen, const v1::StreamForestRequest& request,
    const core::TreeLimits& limits, std::shared_ptr<CostMeter> meter) {
  return std::make_unique<ForestRun>(std::move(chosen), request, limits,
                                     std::move(meter));
}

}  // namespace terrane::server
