#include "client/remote_trees.h"

#include "client/tree_verifiers.h"

namespace terrane::client {
namespace {

const v1::SegmentRows& RowsOf(const v1::StreamTreeResponse& message) {
  return message.segments();
}
const v1::LeafRows& LeavesOf(const v1::StreamTreeLeavesResponse& message) {
  return message.leaves();
}
const v1::TubeBlock& TubesOf(const v1::StreamTreeMeshResponse& message) {
  return message.block();
}
const v1::ForestBlock& ForestBlockOf(const v1::StreamForestResponse& message) {
  return message.block();
}

}  // namespace

RemoteTrees::RemoteTrees(RemoteCaller* caller)
    : caller_(caller), stub_(v1::TreeService::NewStub(caller->channel())) {}

absl::Status RemoteTrees::StreamTree(const v1::StreamTreeRequest& request,
                                     const OnTreeHeader& on_header,
                                     const OnTreeRows& on_rows,
                                     std::stop_token stop) {
  TreeRowsVerifier verifier(request);
  v1::StreamTreeRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_from_row(verifier.next_index());
    return stub_->StreamTree(context, rest);
  };
  return caller_->Stream<v1::StreamTreeResponse>(open, on_header, on_rows,
                                                 RowsOf, stop, &verifier);
}

absl::Status RemoteTrees::StreamTreeLeaves(
    const v1::StreamTreeLeavesRequest& request, const OnTreeHeader& on_header,
    const OnTreeLeaves& on_leaves, std::stop_token stop) {
  TreeLeavesVerifier verifier(request);
  v1::StreamTreeLeavesRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_from_leaf(verifier.next_index());
    return stub_->StreamTreeLeaves(context, rest);
  };
  return caller_->Stream<v1::StreamTreeLeavesResponse>(
      open, on_header, on_leaves, LeavesOf, stop, &verifier);
}

absl::Status RemoteTrees::StreamTreeMesh(
    const v1::StreamTreeMeshRequest& request, const OnTreeHeader& on_header,
    const OnTubes& on_tubes, std::stop_token stop) {
  TubesVerifier verifier(request);
  v1::StreamTreeMeshRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_block(verifier.next_index());
    return stub_->StreamTreeMesh(context, rest);
  };
  return caller_->Stream<v1::StreamTreeMeshResponse>(open, on_header, on_tubes,
                                                     TubesOf, stop, &verifier);
}

absl::Status RemoteTrees::StreamForest(const v1::StreamForestRequest& request,
                                       const OnTreeHeader& on_header,
                                       const OnForestBlock& on_block,
                                       std::stop_token stop) {
  ForestVerifier verifier(request);
  v1::StreamForestRequest rest = request;
  const auto open = [&](grpc::ClientContext* context) {
    rest.set_first_tree(verifier.next_index());
    return stub_->StreamForest(context, rest);
  };
  const auto on_new = [&](const v1::ForestBlock& block) {
    return verifier.IsRepeat() ? absl::OkStatus() : on_block(block);
  };
  return caller_->Stream<v1::StreamForestResponse>(
      open, on_header, on_new, ForestBlockOf, stop, &verifier);
}

absl::StatusOr<v1::EstimateTreeResponse> RemoteTrees::EstimateTree(
    const v1::EstimateTreeRequest& request, std::stop_token stop) {
  return caller_->Unary<v1::EstimateTreeResponse>(
      stub_.get(), &v1::TreeService::Stub::EstimateTree, request, stop);
}

absl::StatusOr<v1::GetTreePresetResponse> RemoteTrees::GetTreePreset(
    const v1::GetTreePresetRequest& request, std::stop_token stop) {
  return caller_->Unary<v1::GetTreePresetResponse>(
      stub_.get(), &v1::TreeService::Stub::GetTreePreset, request, stop);
}

}  // namespace terrane::client
