// LocalBackend: the API in this process, without a network: the server's own
// Actor, its tiles made by several threads and delivered in order.
//
// The files local_backend* are the one place of client/ that includes server/:
// the Actor (server/actor) holds no gRPC. Memory: at most two tiles a thread
// wait for delivery, however long the stream.
#ifndef TERRANE_CLIENT_LOCAL_BACKEND_H_
#define TERRANE_CLIENT_LOCAL_BACKEND_H_

#include <memory>

#include "client/backend.h"
#include "client/local_backend_flowers.h"
#include "client/local_backend_renders.h"
#include "client/local_backend_trees.h"
#include "server/actor/actor.h"

namespace terrane::client {

class LocalBackend : public Backend {
 public:
  // `threads` make tiles; 0: as many as can run at a time
  // (server/actor/cpu_quota.h).
  explicit LocalBackend(int threads);

  absl::Status StreamTiles(const v1::StreamTilesRequest& request,
                           const OnHeader& on_header, const OnTile& on_tile,
                           std::stop_token stop) override;
  absl::StatusOr<v1::PreparedTerrain> PrepareTerrain(
      const v1::PrepareTerrainRequest& request,
      const OnPrepareProgress& on_progress, std::stop_token stop) override;
  absl::StatusOr<v1::GetProfileResponse> GetProfile(
      const v1::GetProfileRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetHeightsResponse> GetHeights(
      const v1::GetHeightsRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::EstimateTilesResponse> EstimateTiles(
      const v1::EstimateTilesRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetPresetResponse> GetPreset(
      const v1::GetPresetRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetServerInfoResponse> GetServerInfo(
      std::stop_token stop) override;
  absl::Status StreamSurface(const v1::StreamSurfaceRequest& request,
                             const OnSurfaceHeader& on_header,
                             const OnSurfaceTile& on_tile,
                             std::stop_token stop) override;
  absl::StatusOr<v1::EstimateSurfaceResponse> EstimateSurface(
      const v1::EstimateSurfaceRequest& request, std::stop_token stop) override;
  absl::StatusOr<v1::GetSurfacePresetResponse> GetSurfacePreset(
      const v1::GetSurfacePresetRequest& request,
      std::stop_token stop) override;
  absl::StatusOr<std::string> UploadRaster(
      std::shared_ptr<const core::Raster> raster,
      std::stop_token stop) override;
  absl::StatusOr<v1::GetRasterResponse> GetRaster(
      const v1::GetRasterRequest& request, std::stop_token stop) override;
  absl::StatusOr<std::string> UploadSpotTable(
      std::shared_ptr<const SpotTable> table, std::stop_token stop) override;
  TreeBackend& trees() override { return trees_; }
  FlowerBackend& flowers() override { return flowers_; }
  RenderBackend& renders() override { return renders_; }

 private:
  int threads_;
  std::unique_ptr<server::Actor> actor_;
  LocalTrees trees_;
  LocalFlowers flowers_;
  LocalRenders renders_;
};

}  // namespace terrane::client

#endif  // TERRANE_CLIENT_LOCAL_BACKEND_H_
