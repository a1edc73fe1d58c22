// RemoteTrees: TreeService of a server across the network.
#ifndef TERRANE_CLIENT_REMOTE_TREES_H_
#define TERRANE_CLIENT_REMOTE_TREES_H_

#include <memory>

#include "client/remote_caller.h"
#include "client/tree_backend.h"
#include "terrane/v1/tree.grpc.pb.h"

namespace terrane::client {

class RemoteTrees : public TreeBackend {
 public:
  // `caller` outlives this.
  explicit RemoteTrees(RemoteCaller* caller);

  absl::Status StreamTree(const v1::StreamTreeRequest& request,
                          const OnTreeHeader& on_header,
                          const OnTreeRows& on_rows,
                          std::stop_token stop) override;
  absl::Status StreamTreeLeaves(const v1::StreamTreeLeavesRequest& request,
                                const OnTreeHeader& on_header,
                                const OnTreeLeaves& on_leaves,
                                std::stop_token stop) override;
  absl::Status StreamTreeMesh(const v1::StreamTreeMeshRequest& request,
                              const OnTreeHeader& on_header,
                              const OnTubes& on_tubes,
                              std::stop_token stop) override;
  absl::Status StreamForest(const v1::StreamForestRequest& request,
                            const OnTreeHeader& on_header,
                            const OnForestBlock& on_block,
                            std::stop_token stop) override;
  absl::StatusOr<v1::EstimateTreeResponse> EstimateTree(
      const v1::EstimateTreeRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetTreePresetResponse> GetTreePreset(
      const v1::GetTreePresetRequest& request, std::stop_token stop) override;

 private:
  RemoteCaller* const caller_;
  const std::unique_ptr<v1::TreeService::Stub> stub_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_REMOTE_TREES_H_
