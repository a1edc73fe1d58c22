// Workload: what the requests of a load test ask for, kind by kind: the planned
// numbers of a RequestMix as messages of the API.
//
// Threads: any. Errors: those of the calls that fetch the presets.
#ifndef TERRANE_CLIENT_BENCH_WORKLOAD_H_
#define TERRANE_CLIENT_BENCH_WORKLOAD_H_

#include <array>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/backend.h"
#include "client/bench/request_mix.h"
#include "terrane/v1/flower.pb.h"
#include "terrane/v1/surface.pb.h"
#include "terrane/v1/terrain.pb.h"
#include "terrane/v1/tree.pb.h"

namespace terrane::client {

struct WorkloadOptions {
  // One for each kind, in their order.
  std::array<std::string, kRequestKinds> presets = {
      "fbm/cloud", "fbm/fig04b", "surface/fig07", "tree/genetic",
      "flower/daisy"};
  std::optional<int> level;  // default: the preset's view
  int tile_size = 256;
  int tiles = 1;  // of one stream
  int profile_samples = 4096;
  int surface_samples = 129;      // along each axis
  std::optional<int> tree_depth;  // default: the preset's own
};

class Workload {
 public:
  // Fetches the presets of the kinds that have a weight.
  static absl::StatusOr<Workload> Create(const WorkloadOptions& options,
                                         const MixWeights& weights,
                                         Backend* backend,
                                         std::stop_token stop);

  v1::StreamTilesRequest Tiles(const PlannedRequest& plan) const;
  v1::GetProfileRequest Profile(const PlannedRequest& plan) const;
  v1::StreamSurfaceRequest Surface(const PlannedRequest& plan) const;
  v1::StreamTreeRequest Tree(const PlannedRequest& plan) const;
  v1::StreamFlowerRequest Flower(const PlannedRequest& plan) const;

 private:
  // Samples of a terrain or profile at its level.
  struct Extent {
    int level = 0;
    // Not set: endless.
    std::optional<std::int64_t> columns;
    std::optional<std::int64_t> rows;
  };

  explicit Workload(const WorkloadOptions& options) : options_(options) {}
  absl::StatusOr<Extent> FetchExtent(RequestKind kind, int dimensions,
                                     Backend* backend,
                                     std::stop_token stop) const;
  const std::string& preset(RequestKind kind) const {
    return options_.presets[static_cast<std::size_t>(kind)];
  }

  WorkloadOptions options_;
  Extent terrain_;
  Extent profile_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_BENCH_WORKLOAD_H_
