#include "client/local_backend_trees.h"

#include "client/local_backend_run.h"
#include "client/tree_verifiers.h"

namespace terrane::client {

absl::Status LocalTrees::StreamTree(const v1::StreamTreeRequest& request,
                                    const OnTreeHeader& on_header,
                                    const OnTreeRows& on_rows,
                                    std::stop_token stop) {
  TreeRowsVerifier verifier(request);
  return HandOutRun(
      maker_->OpenRows(request), on_header, on_rows,
      [](const auto& message) -> const auto& { return message.segments(); },
      stop, &verifier);
}

absl::Status LocalTrees::StreamTreeLeaves(
    const v1::StreamTreeLeavesRequest& request, const OnTreeHeader& on_header,
    const OnTreeLeaves& on_leaves, std::stop_token stop) {
  TreeLeavesVerifier verifier(request);
  return HandOutRun(
      maker_->OpenLeaves(request), on_header, on_leaves,
      [](const auto& message) -> const auto& { return message.leaves(); }, stop,
      &verifier);
}

absl::Status LocalTrees::StreamTreeMesh(
    const v1::StreamTreeMeshRequest& request, const OnTreeHeader& on_header,
    const OnTubes& on_tubes, std::stop_token stop) {
  TubesVerifier verifier(request);
  return HandOutRun(
      maker_->OpenMesh(request), on_header, on_tubes,
      [](const auto& message) -> const auto& { return message.block(); }, stop,
      &verifier);
}

absl::Status LocalTrees::StreamForest(const v1::StreamForestRequest& request,
                                      const OnTreeHeader& on_header,
                                      const OnForestBlock& on_block,
                                      std::stop_token stop) {
  ForestVerifier verifier(request);
  return HandOutRun(
      maker_->OpenForest(request), on_header, on_block,
      [](const auto& message) -> const auto& { return message.block(); }, stop,
      &verifier);
}

absl::StatusOr<v1::EstimateTreeResponse> LocalTrees::EstimateTree(
    const v1::EstimateTreeRequest& request, std::stop_token) {
  return maker_->Estimate(request);
}

absl::StatusOr<v1::GetTreePresetResponse> LocalTrees::GetTreePreset(
    const v1::GetTreePresetRequest& request, std::stop_token) {
  return maker_->GetPreset(request);
}

}  // namespace terrane::client
