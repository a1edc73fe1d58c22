// TreeBackend: whatever answers TreeService; see Backend (client/backend.h) for
// threads and errors.
#ifndef TERRANE_CLIENT_TREE_BACKEND_H_
#define TERRANE_CLIENT_TREE_BACKEND_H_

#include <functional>
#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "terrane/v1/tree.pb.h"

namespace terrane::client {

// Takes the header, once, before any block.
using OnTreeHeader = std::function<absl::Status(const v1::TreeHeader&)>;
// Take the blocks in their order, each once and verified
// (client/tree_verifiers.h). An error ends the stream and is its answer.
using OnTreeRows = std::function<absl::Status(const v1::SegmentRows&)>;
using OnTreeLeaves = std::function<absl::Status(const v1::LeafRows&)>;
using OnTubes = std::function<absl::Status(const v1::TubeBlock&)>;
using OnForestBlock = std::function<absl::Status(const v1::ForestBlock&)>;

class TreeBackend {
 public:
  virtual ~TreeBackend() = default;

  virtual absl::Status StreamTree(const v1::StreamTreeRequest& request,
                                  const OnTreeHeader& on_header,
                                  const OnTreeRows& on_rows,
                                  std::stop_token stop) = 0;
  virtual absl::Status StreamTreeLeaves(
      const v1::StreamTreeLeavesRequest& request, const OnTreeHeader& on_header,
      const OnTreeLeaves& on_leaves, std::stop_token stop) = 0;
  virtual absl::Status StreamTreeMesh(const v1::StreamTreeMeshRequest& request,
                                      const OnTreeHeader& on_header,
                                      const OnTubes& on_tubes,
                                      std::stop_token stop) = 0;
  virtual absl::Status StreamForest(const v1::StreamForestRequest& request,
                                    const OnTreeHeader& on_header,
                                    const OnForestBlock& on_block,
                                    std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::EstimateTreeResponse> EstimateTree(
      const v1::EstimateTreeRequest& request, std::stop_token stop) = 0;
  virtual absl::StatusOr<v1::GetTreePresetResponse> GetTreePreset(
      const v1::GetTreePresetRequest& request, std::stop_token stop) = 0;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_TREE_BACKEND_H_
