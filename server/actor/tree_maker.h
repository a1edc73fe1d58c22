// The trees' half of the Actor: rows, leaves, tubes and forests, their
// estimates, their presets.
//
// Trees are made ready anew for every request: it takes microseconds. A run
// keeps the branches that wait to grow and one block, however large the tree.
// Threads: any, like the Actor's. Errors: violations, NOT_FOUND for a preset.
#ifndef TERRANE_SERVER_ACTOR_TREE_MAKER_H_
#define TERRANE_SERVER_ACTOR_TREE_MAKER_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/violations.h"
#include "core/tree/tree.h"
#include "server/actor/cost_meter.h"
#include "server/actor/limits.h"
#include "server/actor/message_run.h"
#include "terrane/v1/tree.pb.h"

namespace terrane::server {

// A tree that was asked for, and the header that announces it.
struct ChosenTree {
  // Null, with violations, when the choice is not valid, and when its preset is
  // missing.
  std::shared_ptr<const core::Tree> tree;
  v1::TreeHeader header;
  absl::Status missing;  // NOT_FOUND for a preset
};

class TreeMaker {
 public:
  explicit TreeMaker(const Limits& limits);

  // `path` is the choice's in the request.
  ChosenTree Choose(const v1::TreeChoice& choice, const std::string& path,
                    core::Violations* violations) const;

  OpenedRun<v1::StreamTreeResponse> OpenRows(
      const v1::StreamTreeRequest& request) const;
  OpenedRun<v1::StreamTreeLeavesResponse> OpenLeaves(
      const v1::StreamTreeLeavesRequest& request) const;
  OpenedRun<v1::StreamTreeMeshResponse> OpenMesh(
      const v1::StreamTreeMeshRequest& request) const;
  OpenedRun<v1::StreamForestResponse> OpenForest(
      const v1::StreamForestRequest& request) const;
  absl::StatusOr<v1::EstimateTreeResponse> Estimate(
      const v1::EstimateTreeRequest& request) const;
  absl::StatusOr<v1::GetTreePresetResponse> GetPreset(
      const v1::GetTreePresetRequest& request) const;

 private:
  const Limits limits_;
  const std::shared_ptr<CostMeter> meter_;
};

}  // namespace terrane::server

#endif  // TERRANE_SERVER_ACTOR_TREE_MAKER_H_
