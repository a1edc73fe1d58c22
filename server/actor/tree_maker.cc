#include "server/actor/tree_maker.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/field_checks.h"
#include "core/tree/leaves.h"
#include "core/tree/tree_generator.h"
#include "core/tree/tree_mesh.h"
#include "server/actor/forest_run.h"
#include "server/actor/presets.h"
#include "server/actor/tree_run.h"
#include "server/convert/content_hash.h"
#include "server/convert/tree_convert.h"

namespace terrane::server {
namespace {

// Of a row, until something was measured: a slow machine's.
constexpr double kFirstNsPerRow = 800;

// The recipe that a choice names; nothing, with a violation, when it names
// none. NOT_FOUND for an unknown preset.
absl::StatusOr<std::optional<v1::TreeRecipe>> ChosenRecipe(
    const v1::TreeChoice& choice, const std::string& path,
    core::Violations* violations) {
  v1::TreeRecipe recipe;
  switch (choice.choice_case()) {
    case v1::TreeChoice::kRecipe:
      recipe = choice.recipe();
      break;
    case v1::TreeChoice::kPreset: {
      const auto preset = FindTreePreset(choice.preset());
      if (!preset.ok()) return preset.status();
      recipe = (*preset)->recipe();
      break;
    }
    case v1::TreeChoice::CHOICE_NOT_SET:
      violations->Add(path, "must hold a recipe or a preset, got neither");
      return std::optional<v1::TreeRecipe>();
  }
  if (choice.has_seed()) recipe.set_seed(choice.seed());
  if (choice.has_depth()) recipe.set_depth(choice.depth());
  return std::optional<v1::TreeRecipe>(std::move(recipe));
}

void CheckLeaves(const ChosenTree& chosen, const std::string& field,
                 core::Violations* violations) {
  if (chosen.tree == nullptr || chosen.tree->spec().leaves.has_value()) return;
  violations->Add(field, "must be a recipe with leaves, got one without");
}

}  // namespace

TreeMaker::TreeMaker(const Limits& limits)
    : limits_(limits), meter_(std::make_shared<CostMeter>(kFirstNsPerRow)) {}

absl::StatusOr<ChosenTree> TreeMaker::Choose(
    const v1::TreeChoice& choice, const std::string& path,
    core::Violations* violations) const {
  const auto recipe = ChosenRecipe(choice, path, violations);
  if (!recipe.ok()) return recipe.status();
  ChosenTree chosen;
  if (!recipe->has_value()) return chosen;
  const std::string prefix =
      path + (choice.has_preset() ? ".preset." : ".recipe.");
  core::Violations found;
  const core::TreeSpec spec =
      ReadTreeRecipe(**recipe, limits_.tree, prefix, &found);
  if (!found.empty()) {
    for (const core::Violation& one : found.kept()) {
      violations->Add(one.field, one.description);
    }
    return chosen;
  }
  auto tree = core::Tree::Create(spec, limits_.tree);
  if (!tree.ok()) return tree.status();
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
  auto chosen = Choose(request.tree(), "tree", &violations);
  if (!chosen.ok()) return chosen.status();
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("from_row"), request.from_row(), 0,
               limits_.tree.max_segments);
  if (!violations.empty()) return violations.ToStatus();
  return MakeTreeRun(*std::move(chosen), request.from_row(), meter_);
}

OpenedRun<v1::StreamTreeLeavesResponse> TreeMaker::OpenLeaves(
    const v1::StreamTreeLeavesRequest& request) const {
  core::Violations violations;
  auto chosen = Choose(request.tree(), "tree", &violations);
  if (!chosen.ok()) return chosen.status();
  CheckLeaves(*chosen, "tree", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("from_leaf"), request.from_leaf(), 0,
               std::numeric_limits<std::int64_t>::max());
  if (!violations.empty()) return violations.ToStatus();
  return MakeLeafRun(*std::move(chosen), request.from_leaf(), meter_);
}

OpenedRun<v1::StreamTreeMeshResponse> TreeMaker::OpenMesh(
    const v1::StreamTreeMeshRequest& request) const {
  core::Violations violations;
  auto chosen = Choose(request.tree(), "tree", &violations);
  if (!chosen.ok()) return chosen.status();
  const core::TubeSpec tubes =
      ReadTubeOptions(request.tubes(), "tubes.", &violations);
  const std::string root;
  core::FieldChecks(&violations)
      .Integer(core::Path(&root).Field("first_block"), request.first_block(), 0,
               std::numeric_limits<std::int64_t>::max());
  if (!violations.empty()) return violations.ToStatus();
  return MakeTubeRun(*std::move(chosen), tubes, request.first_block(), meter_);
}

OpenedRun<v1::StreamForestResponse> TreeMaker::OpenForest(
    const v1::StreamForestRequest& request) const {
  core::Violations violations;
  auto chosen = Choose(request.tree(), "tree", &violations);
  if (!chosen.ok()) return chosen.status();
  if (request.leaves()) CheckLeaves(*chosen, "leaves", &violations);
  ValidateForest(request, chosen->tree.get(), limits_, &violations);
  if (!violations.empty()) return violations.ToStatus();
  return MakeForestRun(*std::move(chosen), request, limits_.tree, meter_);
}

absl::StatusOr<v1::EstimateTreeResponse> TreeMaker::Estimate(
    const v1::EstimateTreeRequest& request) const {
  core::Violations violations;
  const auto chosen = Choose(request.tree(), "tree", &violations);
  if (!chosen.ok()) return chosen.status();
  if (!violations.empty()) return violations.ToStatus();
  const core::TreeSpec& spec = chosen->tree->spec();
  const core::TreeEstimate& estimate = chosen->tree->estimate();
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
