// LocalTrees: TreeService in this process (client/local_backend.h).
#ifndef TERRANE_CLIENT_LOCAL_BACKEND_TREES_H_
#define TERRANE_CLIENT_LOCAL_BACKEND_TREES_H_

#include "client/tree_backend.h"
#include "server/actor/tree_maker.h"

namespace terrane::client {

class LocalTrees : public TreeBackend {
 public:
  // `maker` outlives this.
  explicit LocalTrees(const server::TreeMaker* maker) : maker_(maker) {}

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
  const server::TreeMaker* const maker_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_LOCAL_BACKEND_TREES_H_
