#include "server/actor/tree_maker.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "core/base/field_checks.h"
#include "core/tree/leaves.h"
#include "core/tree/tree_generator.h"
#include "core/tree/tree_mesh.h"
#include "server/actor/chosen_recipe.h"
#include "server/actor/forest_run.h"
#include "server/actor/presets.h"
#include "server/actor/tree_run.h"
#include "server/convert/content_hash.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

// Of a row, until something was measured: a slow machine's.
constexpr double kFirstNsPerRow = 800;

void CheckLeaves(const ChosenTree& chosen, const std::string& field,
                 core::Violations* violations) {
  if (chosen.tree == nullptr || chosen.tree->spec().leaves.has_value()) return;
  violations->Add(field, "must be a recipe with leaves, got one without");
}

}  // namespace

TreeMaker::TreeMaker(const Limits& limits)
    : limits_(limits), meter_(std::make_shared<CostMeter>(kFirstNsPerRow)) {}

ChosenTree TreeMaker::Choose(const v1::TreeChoice& choice,
                             const std::string& path,
                             core::Violations* violations) const {
  ChosenTree chosen;
  const std::size_t before = violations->total();
  auto named =
      ChooseRecipe<v1::TreeRecipe>(choice, FindTreePreset, path, violations);
  chosen.missing = std::move(named.missing);
  if (!named.recipe.has_value()) return chosen;
  if (choice.has_depth()) named.recipe->set_depth(choice.depth());
  const core::TreeSpec spec =
      ReadTreeRecipe(*named.recipe, limits_.tree, named.prefix, violations);
  if (violations->total() > before) return chosen;
  auto tree = core::Tree::Create(spec, limits_.tree);
  if (!tree.ok()) {
    chosen.missing = tree.status();
    return chosen;
  }
  chosen.tree = *std::move(tree);
  *chosen.header.mutable_recipe() = WriteTreeRecipe(chosen.tree->spec());
  chosen.header.set_recipe_hash(RecipeHash(chosen.header.recipe()));
  chosen.header.set_revision(core::kTreeRevision);
  chosen.header.set_segments_most(chosen.tree->estimate().segments_most);
  return chosen;
}

OpenedRun<v1::StreamTreeResponse> TreeMaker::OpenRows(
    const v1::StreamTreeRequest& request) const {
  core::Violations violations;
  ChosenTree chosen = Choose(request.tree(), "tree", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("from_row"), request.from_row(), 0,
               limits_.tree.max_segments);
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  return MakeTreeRun(std::move(chosen), request.from_row(), meter_);
}

OpenedRun<v1::StreamTreeLeavesResponse> TreeMaker::OpenLeaves(
    const v1::StreamTreeLeavesRequest& request) const {
  core::Violations violations;
  ChosenTree chosen = Choose(request.tree(), "tree", &violations);
  CheckLeaves(chosen, "tree", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("from_leaf"), request.from_leaf(), 0,
               std::numeric_limits<std::int64_t>::max());
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  return MakeLeafRun(std::move(chosen), request.from_leaf(), meter_);
}

OpenedRun<v1::StreamTreeMeshResponse> TreeMaker::OpenMesh(
    const v1::StreamTreeMeshRequest& request) const {
  core::Violations violations;
  ChosenTree chosen = Choose(request.tree(), "tree", &violations);
  const core::TubeSpec tubes =
      ReadTubeOptions(request.tubes(), "tubes.", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("first_block"), request.first_block(), 0,
               std::numeric_limits<std::int64_t>::max());
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  return MakeTubeRun(std::move(chosen), tubes, request.first_block(), meter_);
}

OpenedRun<v1::StreamForestResponse> TreeMaker::OpenForest(
    const v1::StreamForestRequest& request) const {
  core::Violations violations;
  ChosenTree chosen = Choose(request.tree(), "tree", &violations);
  if (request.leaves()) CheckLeaves(chosen, "leaves", &violations);
  ValidateForest(request, chosen.tree.get(), limits_, &violations);
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  return MakeForestRun(std::move(chosen), request, limits_.tree, meter_);
}

absl::StatusOr<v1::EstimateTreeResponse> TreeMaker::Estimate(
    const v1::EstimateTreeRequest& request) const {
  core::Violations violations;
  const ChosenTree chosen = Choose(request.tree(), "tree", &violations);
  const absl::Status fault = FaultOf(violations, chosen.missing);
  if (!fault.ok()) return fault;
  const core::TreeSpec& spec = chosen.tree->spec();
  const core::TreeEstimate& estimate = chosen.tree->estimate();
  v1::EstimateTreeResponse response;
  response.set_segments_most(estimate.segments_most);
  response.set_data_bytes_most(estimate.bytes_most);
  response.set_cpu_seconds_most(meter_->Seconds(estimate.segments_most));
  // The queue; two messages in hand and the block that they come from.
  const std::int64_t block_rows =
      std::min(estimate.segments_most,
               static_cast<std::int64_t>(core::BlockSizes().rows));
  response.set_memory_bytes_most(estimate.queue_bytes_most +
                                 3 * block_rows *
                                     core::SegmentBytes(spec.dimensions));
  response.set_last_generation(estimate.last_generation);
  // A row has leaves once at most; rows are at most 2^32.
  if (spec.leaves.has_value()) {
    response.set_leaves_most(estimate.segments_most * spec.leaves->count);
  }
  return response;
}

absl::StatusOr<v1::GetTreePresetResponse> TreeMaker::GetPreset(
    const v1::GetTreePresetRequest& request) const {
  const auto preset = FindTreePreset(request.name());
  if (!preset.ok()) return preset.status();
  v1::GetTreePresetResponse response;
  *response.mutable_preset() = **preset;
  return response;
}

}  // namespace terrane::server
